#include "elastogear/recovery/recover.h"

#include "elastogear/base/error.h"
#include "elastogear/recovery/stress.h"
#include "recovery/contact_error.h"
#include "recovery/crept_response.h"
#include "recovery/error_estimate.h"
#include "recovery/mesh_error.h"
#include "recovery/mode_acceleration.h"

namespace elastogear::recovery {
namespace {

const std::vector<int>& members_of(const model::Stress& stress, const std::string& set,
                                   const std::string& file) {
  const auto found = stress.sets.find(set);
  std::string known;
  for (const auto& [name, members] : stress.sets) known += (known.empty() ? "" : ", ") + name;
  require(found != stress.sets.end(), file, ": no stress modes at the set '", set,
          "'; there are: ", known.empty() ? "none" : known, ". Name it in -stress_nodes of reduce");
  return found->second;
}

// The stress of the whole static response less that of the modes, which mode acceleration has added to `set`.
// Eq. (4.6).
Eigen::MatrixXd residual_stress(RecoveredBody& body, const model::Stress& stress,
                                const std::vector<int>& members, const io::StressSet& set) {
  const Eigen::MatrixXd& q = body.run.history.q;
  if (body.response) return set.stress - modal_stress(stress, members, q);
  const Eigen::MatrixXd whole = static_stress(*body.reference, set.node);
  const Eigen::MatrixXd of_modes = modal_stress(stress, members, q - body.reference->q);
  return whole.size() > 0 ? Eigen::MatrixXd(whole - of_modes) : Eigen::MatrixXd(-of_modes);
}

// Stress of a body that relaxes, beside it what its modes leave out, and the part of that which has come by
// creep. Eqs. (4.11) and (4.12).
RecoveredStress relaxed_residual(const RecoveredBody& body, const model::ElasticBody& elastic,
                                 const std::vector<int>& members, const io::StressSet& set) {
  const StaticResponseOfRun& response = *body.response;
  const Eigen::MatrixXd& q = body.run.history.q;
  RecoveredStress recovered{set.stress, set.stress - modal_stress(elastic.stress, members, q) +
                                            relaxed_stress(elastic, members, body.run.history.w)};
  if (response.crept)
    recovered.crept = recovered.residual -
                      stored_stress(response, response.position, response.force, set.node) +
                      modal_stress(elastic.stress, members, q - response.q);
  return recovered;
}

// Sets `error` where it can be told: the full basis leaves nothing out, and of bodies that relax without
// residual flexibility the static response is not known.
void estimate_error(RecoveredBody& body, const model::ElasticBody& elastic, io::StressSet& set) {
  if (elastic.basis == model::Basis::full) {
    set.error.setZero(set.von_mises.rows(), set.von_mises.cols());
    set.peak_error.setZero(set.von_mises.cols());
    return;
  }
  const StaticResponseOfRun* const known = body.known();
  if (!known) return;
  const std::vector<int>& members = elastic.stress.sets.at(set.set);
  const Eigen::MatrixXd q_s = body.run.history.q - known->q;
  auto error =
      body.relaxes()
          ? reduction_error(elastic, members, {inertial_part(elastic, known->q, body.run.history.w), q_s},
                            relaxed_residual(body, elastic, members, set))
          : reduction_error(
                elastic, members, {known->q, q_s},
                {set.stress, residual_stress(body, elastic.stress, members, set), body.response != nullptr});
  set.error = std::move(error.at_node);
  set.peak_error = std::move(error.of_peak);
}

}  // namespace

RecoveredBody prepare_recovery(BodyOfRun run, Acceleration acceleration, bool with_error,
                               const FiniteElements& finite_elements) {
  RecoveredBody body{std::move(run)};
  body.response = static_response_of_run(body.run, acceleration, finite_elements);
  if (!body.response && with_error && !body.relaxes())
    body.reference = error_reference(body.run, finite_elements);
  body.finite_elements = finite_elements;
  return body;
}

io::StressSet recover_stress(RecoveredBody& body, const model::ElasticBody& elastic, const std::string& set,
                             bool with_error) {
  const model::Stress& stress = elastic.stress;
  const std::vector<int>& members = members_of(stress, set, body.run.file);
  std::vector<int> nodes;
  for (int member : members) nodes.push_back(stress.node[member]);
  Eigen::MatrixXd sigma_more = body.response ? static_stress(*body.response, nodes) : Eigen::MatrixXd();
  if (!elastic.relaxing.empty()) {  // Eqs. (4.10) to (4.12)
    const Eigen::MatrixXd relaxed = relaxed_stress(elastic, members, body.run.history.w);
    sigma_more = sigma_more.size() > 0 ? Eigen::MatrixXd(sigma_more - relaxed) : Eigen::MatrixXd(-relaxed);
    if (body.response && body.response->crept)
      sigma_more += crept_modal_stress(elastic, members, *body.response->crept);
  }
  StressHistory h = stress_history(stress, members, body.q(), sigma_more);
  io::StressSet recovered{body.run.name,
                          set,
                          std::move(h.node),
                          std::move(h.stress),
                          std::move(h.von_mises),
                          std::move(h.rankine),
                          stress.X(Eigen::all, members)};
  if (with_error) {
    estimate_error(body, elastic, recovered);
    recovered.mesh_error = mesh_error(body, elastic, recovered);
    if (body.known()) recovered.contact_error = contact_error(*body.known(), nodes);
  }
  return recovered;
}

FieldState state_of_run(const BodyOfRun& body, Eigen::Index step) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(body.history.R_WB.col(step).data());
  FieldState state{body.history.r_WB.col(step), R, body.history.q.col(step)};
  if (body.history.w.size() > 0)
    state.w = body.history.w.col(step).reshaped(state.q.size(), body.history.w.rows() / state.q.size());
  return state;
}

FieldState recovered_state(const RecoveredBody& body, Eigen::Index step, bool with_error) {
  FieldState state = state_of_run(body.run, step);
  StaticResponseOfRun* const known = body.known();
  if (!known) return state;
  const Eigen::VectorXd u_static = static_displacement(*known, step), q_d = known->q.col(step);
  if (with_error && !body.relaxes()) {
    const Eigen::VectorXd share = dynamic_share(known->body, {q_d, state.q - q_d});
    state.reference = {state.q, q_d, u_static, share[0]};
  }
  if (!body.response) return state;
  state.q = q_d;
  state.u_static = u_static;
  return state;
}

}  // namespace elastogear::recovery
