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

// psi - f of one node over the run, 3 x n_t.
MatrixXd crept_force(body::CreepLaw& law, body::Moduli moduli, body::CreepState state, const VectorXd& time,
                     const MatrixXd& f) {
  MatrixXd crept(3, f.cols());
  for (Index t = 0; t < f.cols(); ++t) {
    law.set_point(moduli, {t == 0 ? 0 : time[t] - time[t - 1], 1});
    state = law.state(state, f.col(t));
    crept.col(t) = state.col(0) - f.col(t);
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
  body::CreepLaw law(body::creep_law(elastic));
  if (!elastic.flexibility.has_long_term() || !law.creeps()) return {};
  const model::RelaxedState start = io::read_relaxed_state(body.result, body.name, io::kRelaxedStart);
  const model::ForceHistory all = with_nodes(forces, start.node);
  const body::Moduli moduli = moduli_of_run(elastic, body.history);
  const VectorXd time = io::read_times(body.result);
  const auto& Phi = std::get<model::DenseRows>(elastic.surface.Phi);
  CreptResponse crept{{}, MatrixXd(all.force.rows(), all.force.cols()), {}, {}};
  MatrixXd h = MatrixXd::Zero(elastic.n_q(), all.force.cols());
  for (std::size_t i = 0; i < all.node.size(); ++i) {
    const auto row = static_cast<Index>(3 * i);
    crept.position.push_back(model::find_loaded(elastic.flexibility, all.node[i]));
    const MatrixXd chi = crept_force(law, moduli, start_of(start, all.node[i], law.n_columns()), time,
                                     all.force.middleRows<3>(row)) /
                         law.long_term();
    crept.force.middleRows<3>(row) = chi;
    h += Phi.middleRows<3>(3 * all.node[i]).transpose() * chi;
  }
  crept.q = elastic.K_r.diagonal().cwiseInverse().asDiagonal() * h;
  crept.q_long = body::long_term_stiffness(elastic).llt().solve(h);
  return crept;
}

MatrixXd crept_modal_stress(const model::ElasticBody& elastic, const std::vector<int>& members,
                            const CreptResponse& crept) {
  const Index n_q = elastic.n_q();
  MatrixXd w(n_q * static_cast<Index>(elastic.relaxing.size()), crept.q_long.cols());
  for (std::size_t p = 0; p < elastic.relaxing.size(); ++p)
    w.middleRows(static_cast<Index>(p) * n_q, n_q) = elastic.relaxing[p].g.sum() * crept.q_long;
  return relaxed_stress(elastic, members, w) -
         modal_stress(elastic.stress, members, MatrixXd(crept.q_long - crept.q));
}

}  // namespace elastogear::recovery
