#include "elastogear/recovery/static_response.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "recovery/crept_response.h"
#include "recovery/mode_acceleration.h"

namespace elastogear::recovery {
namespace {

constexpr std::size_t kLargestReference =
    500'000;  // displacements of a body that is factorised for an estimate

// Positions in the flexibility of these surface nodes; empty when the body file lacks the static response to
// forces on one of them.
std::vector<int> find_responses(const model::Flexibility& flexibility, const std::vector<int>& nodes) {
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
  if (!body.assembled_K)
    return "solves with the stiffness of the mesh, this body was reduced from matrices of another program "
           "(-stiffness), or before body files said so";
  if (body.floating && !body.assembled_M)
    return "balances loads on a free body by the mass of its mesh, this one has point masses besides";
  return "";
}

// Static response of a body over the run; nothing for the full basis, and for a body that is rigid in the
// run.
std::unique_ptr<StaticResponseOfRun> make_response(const BodyOfRun& body,
                                                   const FiniteElements& finite_elements) {
  if (body.rigid) return nullptr;
  model::ElasticBody elastic = read_elastic_body(body);
  if (elastic.basis == model::Basis::full) return nullptr;
  const model::ForceHistory forces = io::read_contact_forces(body.result, body.name, elastic.surface);
  auto known_response = std::make_unique<StaticResponseOfRun>();
  known_response->position = find_responses(elastic.flexibility, forces.node);
  known_response->q = dynamic_part(elastic, body.history.q, forces);
  for (int node : forces.node) known_response->node.push_back(elastic.surface.node[node]);
  known_response->force = forces.force;
  known_response->file = body.file;
  known_response->finite_elements = finite_elements;
  known_response->crept = crept_response(body, elastic, forces);
  elastic.surface.Phi = {};
  known_response->body = std::move(elastic);
  return known_response;
}

// Returns whether the body file holds the static responses to all forces; false when there are no forces.
bool is_stored(const StaticResponseOfRun& known_response) { return !known_response.position.empty(); }

}  // namespace

const UnreducedResponse& unreduced_response(StaticResponseOfRun& known_response) {
  if (known_response.unreduced) return *known_response.unreduced;
  const std::string obstacle = obstacle_to_factor(known_response.body);
  require(obstacle.empty(), known_response.file, ": mode acceleration ", obstacle,
          "; use -mode_acceleration false");
  known_response.source = io::read_body_source(known_response.file);
  known_response.unreduced =
      known_response.finite_elements.unreduced_response(*known_response.source, known_response.body.floating);
  return *known_response.unreduced;
}

std::unique_ptr<StaticResponseOfRun> static_response_of_run(const BodyOfRun& body, Acceleration acceleration,
                                                            const FiniteElements& finite_elements) {
  const bool relaxes = body.history.w.rows() > 0;
  if (acceleration == Acceleration::never) return nullptr;
  std::unique_ptr<StaticResponseOfRun> known_response = make_response(body, finite_elements);
  if (!known_response || (acceleration == Acceleration::automatic && !is_stored(*known_response)))
    return nullptr;
  require(
      !relaxes || is_stored(*known_response), body.file,
      ": mode acceleration of a viscoelastic body takes the static responses in its file, which has none; "
      "use -mode_acceleration auto, or reduce it with the basis modal_residual");
  const std::string obstacle = is_stored(*known_response) ? "" : obstacle_to_factor(known_response->body);
  require(obstacle.empty(), body.file, ": mode acceleration ", obstacle);
  return known_response;
}

std::unique_ptr<StaticResponseOfRun> error_reference(const BodyOfRun& body,
                                                     const FiniteElements& finite_elements) {
  std::unique_ptr<StaticResponseOfRun> known_response = make_response(body, finite_elements);
  if (!known_response || known_response->node.empty() || is_stored(*known_response)) return known_response;
  if (!obstacle_to_factor(known_response->body).empty()) return nullptr;
  known_response->source = io::read_body_source(known_response->file);
  return known_response->source->free_dof.size() <= kLargestReference ? std::move(known_response) : nullptr;
}

Eigen::MatrixXd static_displacements(StaticResponseOfRun& known_response, const std::vector<int>& steps) {
  if (known_response.node.empty()) return Eigen::MatrixXd(0, static_cast<Eigen::Index>(steps.size()));
  return unreduced_response(known_response)
      .displacement(known_response.node, known_response.force(Eigen::all, steps));
}

}  // namespace elastogear::recovery
