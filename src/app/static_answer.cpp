#include "app/static_answer.h"

#include <algorithm>

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

// Where the body file answers to forces on these surface nodes; empty when it does not to one of them.
std::vector<int> find_answers(const model::Flexibility& flexibility, const std::vector<int>& nodes) {
  std::vector<int> position;
  for (int node : nodes) {
    const int at = model::find_loaded(flexibility, node);
    if (at < 0) return {};
    position.push_back(at);
  }
  return position;
}

reduction::StaticResponse& response(StaticAnswer& answer) {
  if (answer.response) return *answer.response;
  answer.source = io::read_body_source(answer.file);
  answer.response = std::make_unique<reduction::StaticResponse>(*answer.source);
  return *answer.response;
}

// 6 n x n_t, from the body file; one loaded node at a time.
Eigen::MatrixXd stored_stress(const StaticAnswer& answer, const std::vector<int>& nodes) {
  const model::Flexibility& flexibility = answer.body.flexibility;
  const std::vector<int>& known = answer.body.stress.node;
  Eigen::MatrixXd stress =
      Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(nodes.size()), answer.force.cols());
  Eigen::MatrixXd G(stress.rows(), 3);
  for (std::size_t b = 0; b < answer.position.size(); ++b) {
    const Eigen::MatrixXf columns =
        io::read_stress_answers(answer.file, flexibility.surface.orbit[answer.position[b]]);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto e = std::lower_bound(known.begin(), known.end(), nodes[i]) - known.begin();
      G.middleRows<6>(static_cast<Eigen::Index>(6 * i)) =
          model::stress_answer(flexibility, static_cast<int>(e), answer.position[b], columns);
    }
    stress += G * answer.force.middleRows(static_cast<Eigen::Index>(3 * b), 3);
  }
  return stress;
}

}  // namespace

void require_same_coordinates(const model::ElasticBody& body, const io::BodyHistory& history,
                              const std::string& file) {
  require(body.n_q() == history.q.rows(), file, ": ", body.n_q(), " elastic coordinates, the run has ",
          history.q.rows(), ": name the body file of the run by option -<body>_file");
}

std::unique_ptr<StaticAnswer> static_answer(const BodyOfRun& body, Acceleration acceleration) {
  if (acceleration == Acceleration::never) return nullptr;
  model::ElasticBody elastic = io::read_body(body.file);
  require_same_coordinates(elastic, body.history, body.file);
  if (elastic.basis == model::Basis::full) return nullptr;
  const recovery::ForceHistory forces =
      recovery::contact_forces(contacts_of(body), elastic.surface, body.history.R_WB);
  auto answer = std::make_unique<StaticAnswer>();
  answer->position = find_answers(elastic.flexibility, forces.node);
  if (acceleration == Acceleration::automatic && answer->position.empty()) return nullptr;
  require(!elastic.floating, body.file,
          ": mode acceleration needs a held body, this one was reduced free (restrain: none)");
  require(!answer->position.empty() || !elastic.provenance.contains("option_stiffness"), body.file,
          ": mode acceleration solves with the stiffness of the mesh, this body was reduced from matrices of "
          "another program (-stiffness)");
  answer->q = recovery::dynamic_part(elastic, body.history.q, forces);
  for (int node : forces.node) answer->node.push_back(elastic.surface.node[node]);
  answer->force = forces.force;
  answer->file = body.file;
  elastic.surface.Phi = {};
  answer->body = std::move(elastic);
  return answer;
}

Eigen::MatrixXd stress_history(StaticAnswer& answer, const std::vector<int>& nodes) {
  if (answer.node.empty()) return {};
  if (!answer.position.empty()) return stored_stress(answer, nodes);
  return response(answer).stress(answer.node, nodes) * answer.force;
}

Eigen::VectorXd displacement(StaticAnswer& answer, Eigen::Index step) {
  if (answer.node.empty()) return {};
  return response(answer).displacement(answer.node, answer.force.col(step).reshaped(3, answer.node.size()));
}

}  // namespace elastogear::app
