#include "elastogear/recovery/recover.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/recovery/stress.h"
#include "recovery/crept_response.h"
#include "recovery/error_estimate.h"
#include "recovery/mesh_error.h"
#include "recovery/mode_acceleration.h"
#include "recovery/static_stress.h"

namespace elastogear::recovery {
namespace {

const std::vector<int>& members_of(const model::Stress& stress, const std::string& set,
                                   const std::string& file) {
  std::vector<std::string> known;
  for (const auto& [name, members] : stress.sets) known.push_back(name);
  require_stress_set(known, set, file);
  return stress.sets.at(set);
}

// Output times and nodes of a set that are recovered together, so that their stresses stay in the cache.
constexpr Eigen::Index kTimesTogether = 128, kNodesTogether = 256;

// A set of a body whose stresses are recovered.
struct SetOfBody {
  const RecoveredBody& body;
  const model::ElasticBody& elastic;
  const std::vector<int>& members;
  std::optional<StaticStress> known = {};  // by which errors are estimated, and which mode acceleration adds
  bool estimates = false;                  // errors by the reduction
  Eigen::MatrixXd upper =
      {};  // then upper_modes_stress at the members, without columns of a body without modes
};

// Coordinates of a body at some output times, one column each.
struct Motion {
  Range times;
  Eigen::Ref<const Eigen::MatrixXd> q, w;
  SplitCoordinates split = {};    // of its static response, where that is known; q_d as in the stress
  Eigen::MatrixXd inertial = {};  // what of q is dynamic
  std::optional<CreptResponse> crept = {};
};

std::optional<CreptResponse> at_times(const std::optional<CreptResponse>& crept, Range times) {
  if (!crept) return {};
  CreptResponse some;
  for (const CreptForces& state : crept->states)
    some.states.push_back({{},
                           state.q.middleCols(times.begin, times.count),
                           state.q_relaxed.middleCols(times.begin, times.count)});
  return some;
}

Motion motion_at(const SetOfBody& set, Range times) {
  const RecoveredBody& body = set.body;
  const io::BodyHistory& history = body.run.history;
  const auto at = [&](const Eigen::MatrixXd& all) { return all.middleCols(times.begin, times.count); };
  // A motion refers to the history. Of a body that does not relax nobody reads w.
  Motion motion{times, at(history.q), at(body.relaxes() ? history.w : history.q)};
  const StaticResponseOfRun* const known = body.known();
  if (!known) return motion;
  motion.split.q_d = at(known->q);
  motion.split.q_s = motion.q - motion.split.q_d;
  motion.inertial = body.relaxes() ? inertial_part(set.elastic, motion.split.q_d, motion.w)
                                   : without_marker_loads(set.elastic, motion.split.q_d);
  motion.crept = at_times(known->crept, times);
  return motion;
}

// The static response at some nodes, 6 n x n_t, with what of the modes' part has come by creep; empty where
// it is not known.
Eigen::MatrixXd static_stress(const SetOfBody& set, const Motion& motion, const std::vector<int>& members,
                              Range nodes) {
  if (!set.known) return {};
  Eigen::MatrixXd stress = set.known->whole(nodes);
  if (motion.crept) stress += crept_modal_stress(set.elastic, members, *motion.crept);
  return stress;
}

// Adds to recovered stresses the residual static stress, Eq. (4.6), and the part of it that has come by
// creep, Eqs. (4.11) and (4.12), from which errors are estimated.
RecoveredStress with_residual(const SetOfBody& set, const Motion& motion, const std::vector<int>& members,
                              Range nodes, Eigen::MatrixXd stress, const Eigen::MatrixXd& whole) {
  RecoveredStress recovered{std::move(stress),
                            whole - modal_stress(set.elastic.stress, members, motion.split.q_s),
                            set.body.response != nullptr};
  if (motion.crept) recovered.crept = whole - set.known->instantaneous(nodes);
  return recovered;
}

// Sets stresses and errors at some nodes, and extends `peaks` by them.
void recover_part(const SetOfBody& set, const Motion& motion, Range nodes, io::StressSet& result,
                  Peaks& peaks) {
  const std::vector<int> members(set.members.begin() + nodes.begin,
                                 set.members.begin() + nodes.begin + nodes.count);
  const auto part = [&](Eigen::MatrixXd& all) {
    const Eigen::Index each = all.rows() / static_cast<Eigen::Index>(set.members.size());
    return all.block(each * nodes.begin, motion.times.begin, each * nodes.count, motion.times.count);
  };
  const Eigen::MatrixXd whole = static_stress(set, motion, members, nodes);
  const bool adds = set.body.response != nullptr;
  Eigen::MatrixXd stress = adds ? modal_stress(set.elastic.stress, members, motion.split.q_d) + whole
                                : modal_stress(set.elastic.stress, members, motion.q);
  if (set.body.relaxes()) stress -= relaxed_stress(set.elastic, members, motion.w);  // Eq. (4.10)
  part(result.stress) = stress;
  part(result.von_mises) = von_mises(stress);
  part(result.rankine) = rankine(stress);
  if (result.time_error.size() > 0)  // Eq. (4.15)
    part(result.time_error) = von_mises(
        modal_stress(set.elastic.stress, members,
                     set.body.run.history.q_error.middleCols(motion.times.begin, motion.times.count)));
  if (!set.estimates) return;
  const StressError error = reduction_error(
      set.elastic, set.upper.middleRows(nodes.begin, nodes.count), {motion.inertial, motion.split.q_s},
      with_residual(set, motion, members, nodes, std::move(stress), whole));
  part(result.error) = error.at_node;
  join(peaks, error.peaks);
  if (result.contact_error.size() > 0)
    part(result.contact_error) = von_mises(set.known->change_by_spread(nodes));
}

void recover_times(SetOfBody& set, Range times, io::StressSet& result) {
  const Motion motion = motion_at(set, times);
  if (set.known) set.known->set_times(times, result.contact_error.size() > 0);
  Peaks peaks = no_peaks(times.count);
  const auto n = static_cast<Eigen::Index>(set.members.size());
  for (Eigen::Index begin = 0; begin < n; begin += kNodesTogether)
    recover_part(set, motion, {begin, std::min(kNodesTogether, n - begin)}, result, peaks);
  if (set.estimates) result.peak_error.segment(times.begin, times.count) = peaks.whole_error();
}

// Prepares estimates where errors can be told: the full basis leaves nothing out, and of viscoelastic bodies
// without residual flexibility the static response is not known.
void prepare_errors(SetOfBody& set, io::StressSet& result) {
  const Eigen::Index n = result.von_mises.rows(), n_t = result.von_mises.cols();
  if (set.elastic.basis == model::Basis::full) {
    result.error.setZero(n, n_t);
    result.peak_error.setZero(n_t);
  } else if (set.known) {
    set.estimates = true;
    set.upper = upper_modes_stress(set.elastic, set.members);
    result.error.resize(n, n_t);
    result.peak_error.setZero(n_t);
  }
  if (set.known && set.known->is_stored()) result.contact_error.resize(n, n_t);
  if (set.body.run.history.q_error.size() > 0) result.time_error.resize(n, n_t);
}

// Adds the whole body's static response u_static to a state whose dynamic part is q_d.
void add_static(const RecoveredBody& body, const Eigen::VectorXd& q_d, const Eigen::VectorXd& u_static,
                bool with_error, FieldState& state) {
  if (with_error && !body.relaxes()) {
    const model::ElasticBody& elastic = body.known()->body;
    const Eigen::VectorXd inertial = without_marker_loads(elastic, q_d),
                          share = dynamic_share(elastic, {inertial, state.q - q_d});
    state.reference = {state.q, q_d, upper_half(inertial, elastic.n_modes()), u_static, share[0]};
  }
  if (!body.response) return;
  state.q = q_d;
  state.u_static = u_static;
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

void require_stress_set(const std::vector<std::string>& known, const std::string& set,
                        const std::string& file) {
  require(std::find(known.begin(), known.end(), set) != known.end(), file, ": no stress modes at the set '",
          set, "'; there are: ", known.empty() ? "none" : elastogear::join(known),
          ". Name it in -stress_nodes of reduce");
}

io::StressSet recover_stress(RecoveredBody& body, const model::ElasticBody& elastic, const std::string& set,
                             bool with_error) {
  const model::Stress& stress = elastic.stress;
  SetOfBody of{body, elastic, members_of(stress, set, body.run.file)};
  const auto n = static_cast<Eigen::Index>(of.members.size()), n_t = body.run.history.q.cols();
  io::StressSet recovered{body.run.name,
                          set,
                          {},
                          Eigen::MatrixXd(6 * n, n_t),
                          Eigen::MatrixXd(n, n_t),
                          Eigen::MatrixXd(n, n_t),
                          stress.X(Eigen::all, of.members)};
  for (int member : of.members) recovered.node.push_back(stress.node[static_cast<std::size_t>(member)]);
  if (body.response || (with_error && body.reference)) of.known.emplace(*body.known(), recovered.node);
  if (with_error) prepare_errors(of, recovered);
  for (Eigen::Index begin = 0; begin < n_t; begin += kTimesTogether)
    recover_times(of, {begin, std::min(kTimesTogether, n_t - begin)}, recovered);
  if (with_error) recovered.mesh_error = mesh_error(body, elastic, recovered);
  return recovered;
}

FieldState state_of_run(const BodyOfRun& body, Eigen::Index step) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(body.history.R_WB.col(step).data());
  FieldState state{body.history.r_WB.col(step), R, body.history.q.col(step)};
  if (body.history.w.size() > 0)
    state.w = body.history.w.col(step).reshaped(state.q.size(), body.history.w.rows() / state.q.size());
  return state;
}

std::vector<FieldState> recovered_states(const RecoveredBody& body, const std::vector<int>& steps,
                                         bool with_error) {
  StaticResponseOfRun* const known = body.known();
  const Eigen::MatrixXd u_static = known ? static_displacements(*known, steps) : Eigen::MatrixXd();
  std::vector<FieldState> states;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    FieldState& state = states.emplace_back(state_of_run(body.run, steps[i]));
    if (known)
      add_static(body, known->q.col(steps[i]), u_static.col(static_cast<Eigen::Index>(i)), with_error, state);
  }
  return states;
}

}  // namespace elastogear::recovery
