#include "recovery/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

constexpr double kInertia = 0.05;  // share of the static residual stress by which its own inertia changes it
constexpr double kStates = 1e-2;   // by which states of relaxation are interpolated worst, Eq. (4.12b)
constexpr double kForces = 1e-3;   // to which contact forces are reproduced when the time step changes

// n x n_q, Pa: von Mises stress of each mode.
Eigen::MatrixXd mode_stress(const model::Stress& stress, const std::vector<int>& members) {
  Eigen::MatrixXd result;
  std::visit(
      [&](const auto& Psi) {
        result.resize(static_cast<Eigen::Index>(members.size()), Psi.cols());
        for (std::size_t i = 0; i < members.size(); ++i)
          result.row(static_cast<Eigen::Index>(i)) =
              von_mises(Eigen::MatrixXd(Psi.middleRows(6 * members[i], 6)));
      },
      stress.Psi);
  return result;
}

// n x n_t (docs/theory.md, Eq. (4.7)): root sum of squares over the upper half of the modes.
Eigen::MatrixXd upper_modes_part(const model::ElasticBody& body, const std::vector<int>& members,
                                 const Eigen::MatrixXd& q_d) {
  const Eigen::Index n = q_d.rows() - q_d.rows() / 2;
  const Eigen::MatrixXd psi = mode_stress(body.stress, members).rightCols(n).cwiseAbs2();
  return (psi * q_d.bottomRows(n).cwiseAbs2()).cwiseSqrt();
}

}  // namespace

Eigen::VectorXd dynamic_share(const model::ElasticBody& body, const SplitCoordinates& coordinates) {
  const Eigen::Index n = coordinates.q_d.rows() - coordinates.q_d.rows() / 2;
  const Eigen::VectorXd lambda = Eigen::VectorXd(body.K_r.diagonal()).tail(n);
  const auto energy = [&](const Eigen::MatrixXd& q) -> Eigen::VectorXd {
    return q.bottomRows(n).cwiseAbs2().transpose() * lambda;
  };
  const Eigen::VectorXd d = energy(coordinates.q_d), s = energy(coordinates.q_s);
  Eigen::VectorXd share(d.size());
  for (Eigen::Index t = 0; t < d.size(); ++t) share[t] = d[t] < s[t] ? std::sqrt(d[t] / s[t]) : 1;
  return share;
}

Eigen::MatrixXd upper_half(const Eigen::MatrixXd& q_d) {
  Eigen::MatrixXd upper = q_d;
  upper.topRows(q_d.rows() / 2).setZero();
  return upper;
}

Eigen::VectorXd field_error(const FieldStress& stress, double share) {
  return (stress.whole - stress.found).cwiseAbs() + kForces * stress.found + stress.upper +
         kInertia * share * stress.residual;
}

StressError reduction_error(const model::ElasticBody& body, const std::vector<int>& members,
                            const SplitCoordinates& coordinates, const RecoveredStress& recovered) {
  StressError error;
  const Eigen::MatrixXd found = von_mises(recovered.stress);
  error.at_node = kForces * found + upper_modes_part(body, members, coordinates.q_d);
  error.of_peak.setZero(found.cols());
  if (found.rows() == 0) return error;
  if (recovered.residual.size() > 0)
    error.at_node += kInertia * von_mises(recovered.residual) * dynamic_share(body, coordinates).asDiagonal();
  if (recovered.crept.size() > 0) error.at_node += kStates * von_mises(recovered.crept);
  Eigen::MatrixXd exact = found;
  if (recovered.residual.size() > 0 && !recovered.has_residual)
    exact = von_mises(Eigen::MatrixXd(recovered.stress + recovered.residual));
  for (Eigen::Index t = 0; t < found.cols(); ++t) {
    Eigen::Index node = 0;
    const double peak = exact.col(t).maxCoeff(&node);
    error.of_peak[t] = std::abs(peak - found.col(t).maxCoeff()) + error.at_node(node, t);
  }
  error.at_node += (exact - found).cwiseAbs();
  return error;
}

Eigen::VectorXd mesh_error_field(const Eigen::VectorXd& difference, const Eigen::VectorXd& von_mises,
                                 SurfacePatches patches) {
  std::vector<int> free;
  for (int i = 0; i < difference.size(); ++i)
    if (difference[i] > 0) free.push_back(i);
  Eigen::VectorXd error = difference(free), of_mean = error;
  for (std::size_t i = 0; i < patches.node.size(); ++i) {
    std::vector<int>& patch = patches.node[i];
    std::erase_if(patch, [&](int node) { return difference[node] == 0; });
    const PatchError e = patch_error(difference(patch), von_mises(patch), patches.order[i]);
    error[static_cast<Eigen::Index>(i)] = e.error;
    of_mean[static_cast<Eigen::Index>(i)] = e.of_mean;
  }
  const double of_stress = von_mises(free).squaredNorm(),
               share = of_stress > 0 ? std::sqrt(error.dot(of_mean) / of_stress) : 0;
  Eigen::VectorXd result = share * von_mises;
  result(free) = error;
  return result;
}

}  // namespace elastogear::recovery
