#include "app/static_answer.h"

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

std::vector<recovery::PairContacts> contacts_of(const BodyOfRun& body) {
  const model::ResultHeader header = io::read_result_header(body.result);
  std::vector<recovery::PairContacts> pairs;
  for (const auto& pair : header.pairs)
    for (int side : {0, 1})
      if (header.bodies[pair.body[side]].name == body.name)
        pairs.push_back({side, io::read_contacts(body.result, pair.name)});
  return pairs;
}

}  // namespace

void require_same_coordinates(const model::ElasticBody& body, const io::BodyHistory& history,
                              const std::string& file) {
  require(body.n_q() == history.q.rows(), file, ": ", body.n_q(), " elastic coordinates, the run has ",
          history.q.rows(), ": name the body file of the run by option -<body>_file");
}

std::unique_ptr<StaticAnswer> static_answer(const BodyOfRun& body) {
  const model::ElasticBody elastic = io::read_body(body.file);
  require_same_coordinates(elastic, body.history, body.file);
  if (elastic.basis == model::Basis::full) return nullptr;
  require(!elastic.floating, body.file,
          ": mode acceleration needs a held body, this one was reduced free (restrain: none)");
  require(!elastic.provenance.contains("option_stiffness"), body.file,
          ": mode acceleration solves with the stiffness of the mesh, this body was reduced from matrices of "
          "another program (-stiffness)");
  const recovery::ForceHistory forces =
      recovery::contact_forces(contacts_of(body), elastic.surface, body.history.R_WB);
  auto answer = std::make_unique<StaticAnswer>();
  answer->q = recovery::dynamic_part(elastic, body.history.q, forces);
  for (int node : forces.node) answer->node.push_back(elastic.surface.node[node]);
  answer->force = forces.force;
  if (answer->node.empty()) return answer;
  answer->source = io::read_body_source(body.file);
  answer->response = std::make_unique<reduction::StaticResponse>(answer->source);
  return answer;
}

Eigen::MatrixXd stress_history(StaticAnswer& answer, const std::vector<int>& nodes) {
  if (!answer.response) return {};
  return answer.response->stress(answer.node, nodes) * answer.force;
}

Eigen::VectorXd displacement(StaticAnswer& answer, Eigen::Index step) {
  if (!answer.response) return {};
  return answer.response->displacement(answer.node, answer.force.col(step).reshaped(3, answer.node.size()));
}

}  // namespace elastogear::app
