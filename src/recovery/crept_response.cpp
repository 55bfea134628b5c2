#include "recovery/crept_response.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "elastogear/body/creep.h"
#include "elastogear/io/relaxed_state.h"
#include "elastogear/io/result_file.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The moduli with which the body ran, which w = sum_i g_i z_i tells.
body::Moduli moduli_of_run(const model::ElasticBody& elastic, const io::BodyHistory& history) {
  constexpr double kRoundoff = 1e-9;
  if (history.w.isZero(0)) return body::Moduli::instantaneous;
  MatrixXd relaxed(history.w.rows(), history.w.cols());
  const Index n_q = elastic.n_q();
  for (std::size_t p = 0; p < elastic.relaxing.size(); ++p)
    relaxed.middleRows(static_cast<Index>(p) * n_q, n_q) = elastic.relaxing[p].g.sum() * history.q;
  return (history.w - relaxed).norm() <= kRoundoff * relaxed.norm() ? body::Moduli::long_term
                                                                    : body::Moduli::relaxing;
}

// The state of a node at the start of the run.
body::CreepState start_of(const model::RelaxedState& state, int node, Index n_columns) {
  const auto at = std::lower_bound(state.node.begin(), state.node.end(), node);
  if (at == state.node.end() || *at != node) return {};
  return state.force.middleCols(n_columns * (at - state.node.begin()), n_columns);
}

// psi_j - f of one node over the run, 3 x n_t of each law.
std::vector<MatrixXd> crept_forces(body::CreepLaws& laws, body::Moduli moduli, body::CreepState state,
                                   const VectorXd& time, const MatrixXd& f) {
  std::vector<MatrixXd> crept(static_cast<std::size_t>(laws.size()), MatrixXd(3, f.cols()));
  const Index n_each = laws.n_columns() / laws.size();
  for (Index t = 0; t < f.cols(); ++t) {
    laws.set_point(moduli, {t == 0 ? 0 : time[t] - time[t - 1], 1});
    state = laws.state(state, f.col(t));
    for (std::size_t j = 0; j < crept.size(); ++j)
      crept[j].col(t) = state.col(static_cast<Index>(j) * n_each) - f.col(t);
  }
  return crept;
}

// The forces with those at nodes that have been loaded before the run.
model::ForceHistory with_nodes(const model::ForceHistory& forces, const std::vector<int>& more) {
  model::ForceHistory all{forces.node, {}};
  all.node.insert(all.node.end(), more.begin(), more.end());
  std::sort(all.node.begin(), all.node.end());
  all.node.erase(std::unique(all.node.begin(), all.node.end()), all.node.end());
  all.force.setZero(3 * static_cast<Index>(all.node.size()), forces.force.cols());
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    const auto at = std::lower_bound(all.node.begin(), all.node.end(), forces.node[i]) - all.node.begin();
    all.force.middleRows<3>(3 * at) = forces.force.middleRows<3>(3 * static_cast<Index>(i));
  }
  return all;
}

}  // namespace

std::optional<CreptResponse> crept_response(const BodyOfRun& body, const model::ElasticBody& elastic,
                                            const model::ForceHistory& forces) {
  const std::vector<model::RelaxedResponse>& relaxed = elastic.flexibility.relaxed;
  if (relaxed.empty()) return {};
  body::CreepLaws laws(body::creep_laws(elastic));
  const MatrixXd C = body::creep_coefficients(elastic.flexibility);
  const model::RelaxedState start = io::read_relaxed_state(body.result, body.name, io::kRelaxedStart);
  const model::ForceHistory all = with_nodes(forces, start.node);
  const body::Moduli moduli = moduli_of_run(elastic, body.history);
  const VectorXd time = io::read_times(body.result);
  const model::DenseRows& Phi = *model::dense_rows(elastic.surface.Phi);
  const MatrixXd zero = MatrixXd::Zero(all.force.rows(), all.force.cols());
  CreptResponse crept{{}, std::vector<CreptForces>(relaxed.size(), {zero, {}, {}})};
  std::vector<MatrixXd> h(relaxed.size(), MatrixXd::Zero(elastic.n_q(), all.force.cols()));
  for (std::size_t i = 0; i < all.node.size(); ++i) {
    const auto row = static_cast<Index>(3 * i);
    crept.position.push_back(model::find_loaded(elastic.flexibility, all.node[i]));
    const std::vector<MatrixXd> grown = crept_forces(
        laws, moduli, start_of(start, all.node[i], laws.n_columns()), time, all.force.middleRows<3>(row));
    for (std::size_t k = 0; k < relaxed.size(); ++k) {
      MatrixXd chi = MatrixXd::Zero(3, time.size());
      for (std::size_t j = 0; j < grown.size(); ++j)
        chi += C(static_cast<Index>(k) + 1, static_cast<Index>(j) + 1) * grown[j];
      crept.states[k].force.middleRows<3>(row) = chi;
      h[k] += Phi.middleRows<3>(3 * all.node[i]).transpose() * chi;
    }
  }
  for (std::size_t k = 0; k < relaxed.size(); ++k) {
    crept.states[k].q = elastic.K_r.diagonal().cwiseInverse().asDiagonal() * h[k];
    crept.states[k].q_relaxed = body::relaxed_stiffness(elastic, relaxed[k].share).llt().solve(h[k]);
  }
  return crept;
}

MatrixXd crept_modal_stress(const model::ElasticBody& elastic, const std::vector<int>& members,
                            const CreptResponse& crept) {
  const Index n_q = elastic.n_q(), n_t = crept.states.front().q.cols();
  MatrixXd w = MatrixXd::Zero(n_q * static_cast<Index>(elastic.relaxing.size()), n_t),
           grown = MatrixXd::Zero(n_q, n_t);
  for (std::size_t k = 0; k < crept.states.size(); ++k) {
    const CreptForces& state = crept.states[k];
    grown += state.q_relaxed - state.q;
    for (std::size_t p = 0; p < elastic.relaxing.size(); ++p)
      w.middleRows(static_cast<Index>(p) * n_q, n_q) +=
          elastic.flexibility.relaxed[k].share[static_cast<Index>(p)] * state.q_relaxed;
  }
  return relaxed_stress(elastic, members, w) - modal_stress(elastic.stress, members, grown);
}

}  // namespace elastogear::recovery
