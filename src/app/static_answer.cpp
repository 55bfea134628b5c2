#include "app/static_answer.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

constexpr std::size_t kLargestReference =
    500'000;  // displacements of a body that is factorised for an estimate
constexpr const char* kPointMass = "option_point_mass_";  // beginning of keys in the provenance

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

// Why no factor of the stiffness matrix can serve; empty: it can.
std::string obstacle_to_factor(const model::ElasticBody& body) {
  if (body.provenance.contains("option_stiffness"))
    return "solves with the stiffness of the mesh, this body was reduced from matrices of another program "
           "(-stiffness)";
  const auto point_mass = body.provenance.lower_bound(kPointMass);
  if (body.floating && point_mass != body.provenance.end() && point_mass->first.starts_with(kPointMass))
    return "balances loads on a free body by the mass of its mesh, this one has point masses besides";
  return "";
}

reduction::StaticResponse& response(StaticAnswer& answer) {
  if (answer.response) return *answer.response;
  const std::string obstacle = obstacle_to_factor(answer.body);
  require(obstacle.empty(), answer.file, ": mode acceleration ", obstacle, "; use -mode_acceleration false");
  answer.source = io::read_body_source(answer.file);
  answer.response = std::make_unique<reduction::StaticResponse>(*answer.source, answer.body.floating);
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

// Nothing for the full basis, and for a body that is rigid in the run.
std::unique_ptr<StaticAnswer> make_answer(const BodyOfRun& body) {
  if (body.history.q.rows() == 0) return nullptr;
  model::ElasticBody elastic = io::read_body(body.file);
  require_body_of_run(elastic, body);
  if (elastic.basis == model::Basis::full) return nullptr;
  const recovery::ForceHistory forces =
      recovery::contact_forces(contacts_of(body), elastic.surface, body.history.R_WB);
  auto answer = std::make_unique<StaticAnswer>();
  answer->position = find_answers(elastic.flexibility, forces.node);
  answer->q = recovery::dynamic_part(elastic, body.history.q, forces);
  for (int node : forces.node) answer->node.push_back(elastic.surface.node[node]);
  answer->force = forces.force;
  answer->file = body.file;
  elastic.surface.Phi = {};
  answer->body = std::move(elastic);
  return answer;
}

// Whether the body file holds the responses to all forces; without forces it holds none of them.
bool is_stored(const StaticAnswer& answer) { return !answer.position.empty(); }

}  // namespace

void require_body_of_run(const model::ElasticBody& elastic, const BodyOfRun& body) {
  const Eigen::Index n_q = body.history.q.rows();
  const std::string remedy =
      "name the body file of the run by option -" + body.name + "_file, or run simulate with this one";
  require(elastic.n_q() == n_q, body.file, ": ", elastic.n_q(), " elastic coordinates, body '", body.name,
          "' of ", body.result, " has ", n_q, n_q == 0 ? " (it is rigid there)" : "", ": ", remedy);
  require(body.identity.empty() || model::fingerprint(elastic) == body.identity, body.file,
          ": is not the body '", body.name, "' of ", body.result,
          ": mesh, material, restraint, surface, markers or basis differ, and its elastic coordinates mean "
          "something else: ",
          remedy);
}

std::unique_ptr<StaticAnswer> static_answer(const BodyOfRun& body, Acceleration acceleration) {
  if (acceleration == Acceleration::never) return nullptr;
  std::unique_ptr<StaticAnswer> answer = make_answer(body);
  if (!answer || (acceleration == Acceleration::automatic && !is_stored(*answer))) return nullptr;
  const std::string obstacle = is_stored(*answer) ? "" : obstacle_to_factor(answer->body);
  require(obstacle.empty(), body.file, ": mode acceleration ", obstacle);
  return answer;
}

std::unique_ptr<StaticAnswer> error_reference(const BodyOfRun& body) {
  std::unique_ptr<StaticAnswer> answer = make_answer(body);
  if (!answer || answer->node.empty() || is_stored(*answer)) return answer;
  if (!obstacle_to_factor(answer->body).empty()) return nullptr;
  answer->source = io::read_body_source(answer->file);
  return answer->source->free_dof.size() <= kLargestReference ? std::move(answer) : nullptr;
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
