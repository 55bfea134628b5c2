#include "recovery/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/dense_product.h"
#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

constexpr double kInertia = 0.05;  // share of the static residual stress by which its own inertia changes it
constexpr double kStates = 1e-2;   // by which states of relaxation are interpolated worst, Eq. (4.12b)
constexpr double kForces = 1e-3;   // to which contact forces are reproduced when the time step changes

// Marks the coordinates that belong to the upper half of the modes, by frequency.
auto upper_rows(Eigen::Index n_modes) { return Eigen::seqN(n_modes / 2, n_modes - n_modes / 2); }

}  // namespace

Eigen::VectorXd dynamic_share(const model::ElasticBody& body, const SplitCoordinates& coordinates) {
  // Bodies without modes have no states but equilibria.
  if (body.n_modes() == 0) return Eigen::VectorXd::Zero(coordinates.q_d.cols());
  const auto half = upper_rows(body.n_modes());
  const Eigen::VectorXd lambda = Eigen::VectorXd(body.K_r.diagonal())(half);
  const auto energy = [&](const Eigen::MatrixXd& q) -> Eigen::VectorXd {
    return q(half, Eigen::all).cwiseAbs2().transpose() * lambda;
  };
  const Eigen::VectorXd d = energy(coordinates.q_d), s = energy(coordinates.q_s);
  Eigen::VectorXd share(d.size());
  for (Eigen::Index t = 0; t < d.size(); ++t) share[t] = d[t] < s[t] ? std::sqrt(d[t] / s[t]) : 1;
  return share;
}

Eigen::MatrixXd upper_half(const Eigen::MatrixXd& q_d, Eigen::Index n_modes) {
  Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(q_d.rows(), q_d.cols());
  const auto half = upper_rows(n_modes);
  upper(half, Eigen::all) = q_d(half, Eigen::all);
  return upper;
}

Eigen::VectorXd field_error(const FieldStress& stress, double share) {
  return (stress.whole - stress.found).cwiseAbs() + kForces * stress.found + stress.upper +
         kInertia * share * stress.residual;
}

Peaks no_peaks(Eigen::Index n_t) {
  const Eigen::VectorXd none = Eigen::VectorXd::Constant(n_t, -1);  // below that of any node
  return {none, none, Eigen::VectorXd::Zero(n_t)};
}

void join(Peaks& peaks, const Peaks& others) {
  peaks.found = peaks.found.cwiseMax(others.found);
  peaks.error = (others.exact.array() > peaks.exact.array()).select(others.error, peaks.error);
  peaks.exact = peaks.exact.cwiseMax(others.exact);
}

Eigen::MatrixXd upper_modes_stress(const model::ElasticBody& body, const std::vector<int>& members) {
  Eigen::MatrixXd result;
  const auto half = upper_rows(body.n_modes());
  model::with_rows(body.stress.Psi, [&](const auto& Psi) {
    result.resize(static_cast<Eigen::Index>(members.size()), half.size());
    for (std::size_t i = 0; i < members.size(); ++i)
      result.row(static_cast<Eigen::Index>(i)) =
          von_mises(Eigen::MatrixXd(Eigen::MatrixXd(Psi.middleRows(6 * members[i], 6))(Eigen::all, half)));
  });
  return result.cwiseAbs2();
}

StressError reduction_error(const model::ElasticBody& body, const Eigen::Ref<const Eigen::MatrixXd>& upper,
                            const SplitCoordinates& coordinates, const RecoveredStress& recovered) {
  StressError error{{}, no_peaks(recovered.stress.cols())};
  const Eigen::MatrixXd found = von_mises(recovered.stress);
  Eigen::MatrixXd& e = error.at_node;
  e.resize(found.rows(), found.cols());
  multiply(Op::plain, Op::plain, 1., upper,
           coordinates.q_d(upper_rows(body.n_modes()), Eigen::all).cwiseAbs2(), 0., e);
  e = e.cwiseSqrt() + kForces * found;
  if (found.rows() == 0) return error;
  if (recovered.residual.size() > 0)
    e += kInertia * von_mises(recovered.residual) * dynamic_share(body, coordinates).asDiagonal();
  if (recovered.crept.size() > 0) e += kStates * von_mises(recovered.crept);
  Eigen::MatrixXd exact = found;
  if (recovered.residual.size() > 0 && !recovered.has_residual)
    exact = von_mises(Eigen::MatrixXd(recovered.stress + recovered.residual));
  for (Eigen::Index t = 0; t < found.cols(); ++t) {
    Eigen::Index node = 0;
    error.peaks.exact[t] = exact.col(t).maxCoeff(&node);
    error.peaks.found[t] = found.col(t).maxCoeff();
    error.peaks.error[t] = e(node, t);
  }
  e += (exact - found).cwiseAbs();
  return error;
}

Eigen::VectorXd mesh_error_field(const Eigen::VectorXd& difference, const Eigen::VectorXd& von_mises,
                                 SurfacePatches patches, const LoadedNodes& loaded) {
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
               share = of_stress > 0 ? std::sqrt(of_mean.squaredNorm() / of_stress) : 0;
  Eigen::VectorXd result = share * von_mises;
  for (std::size_t i = 0; i < loaded.node.size(); ++i)
    result[loaded.node[i]] =
        loaded_error(loaded.within[static_cast<Eigen::Index>(i)], von_mises[loaded.node[i]], share);
  result(free) = error;
  return result;
}

}  // namespace elastogear::recovery
