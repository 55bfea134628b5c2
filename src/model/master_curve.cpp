#include "elastogear/model/master_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/nnls.h"

namespace elastogear::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kShare = 1e-9;  // of the instantaneous modulus: terms below it are none

// Times of the curve, s.
VectorXd times(const MasterCurve& curve) {
  if (curve.over_time()) return curve.time;
  return (2 * std::numbers::pi * curve.frequency).cwiseInverse();
}

// Moduli by unit terms: of the long-term modulus in column 0, of times tau in the others. Rows of a
// vibration: storage, then loss.
MatrixXd unit_moduli(const MasterCurve& curve, const std::vector<double>& tau) {
  const VectorXd t = times(curve);
  const Index n = t.size(), rows = curve.over_time() ? n : 2 * n;
  MatrixXd A = MatrixXd::Zero(rows, static_cast<Index>(tau.size()) + 1);
  A.col(0).head(n).setOnes();
  for (Index i = 0; i + 1 < A.cols(); ++i)
    for (Index k = 0; k < n; ++k) {
      const double x = t[k] / tau[static_cast<std::size_t>(i)];
      if (curve.over_time()) {
        A(k, i + 1) = std::exp(-x);
      } else {  // omega tau = 1 / x
        A(k, i + 1) = 1 / (1 + x * x);
        A(n + k, i + 1) = x / (1 + x * x);
      }
    }
  return A;
}

VectorXd measured(const MasterCurve& curve) {
  if (curve.over_time()) return curve.relaxation;
  VectorXd all(2 * curve.storage.size());
  all << curve.storage, curve.loss;
  return all;
}

// Magnitude of the modulus in each row.
VectorXd magnitude(const MasterCurve& curve) {
  if (curve.over_time()) return curve.relaxation;
  const VectorXd size = (curve.storage.array().square() + curve.loss.array().square()).sqrt();
  return size.replicate(2, 1);
}

}  // namespace

void validate(const MasterCurve& curve, const std::string& source) {
  const auto positive = [&](const VectorXd& x, Index n, const char* what, bool or_zero) {
    require(x.size() == n, source, ": has ", x.size(), " values of ", what, ", others have ", n);
    for (double value : x)
      require(std::isfinite(value) && (value > 0 || (or_zero && value == 0)), source, ": ", what, " ", value,
              " must be positive");
  };
  const Index n = curve.over_time() ? curve.time.size() : curve.frequency.size();
  require(n >= 2, source, ": has ", n, " points, a curve needs at least 2");
  if (curve.over_time()) {
    positive(curve.time, n, "time", false);
    positive(curve.relaxation, n, "modulus", false);
    return;
  }
  positive(curve.frequency, n, "frequency", false);
  positive(curve.storage, n, "storage", false);
  positive(curve.loss, n, "loss", true);
}

std::vector<double> decade_times(const MasterCurve& curve) {
  const VectorXd t = times(curve);
  const double first = std::log10(t.minCoeff()), last = std::log10(t.maxCoeff());
  const int n = std::max(1, static_cast<int>(std::lround(last - first)));
  std::vector<double> tau;
  for (int i = 0; i < n; ++i) tau.push_back(std::pow(10, first + (i + 0.5) * (last - first) / n));
  return tau;
}

PronyFit fit_prony(const MasterCurve& curve, const std::vector<double>& tau) {
  const VectorXd weight = magnitude(curve).cwiseInverse();
  const MatrixXd A = weight.asDiagonal() * unit_moduli(curve, tau);
  const VectorXd b = weight.cwiseProduct(measured(curve)), E = nonnegative_least_squares(A, b);
  PronyFit fit;
  fit.E_0 = E.sum();
  for (Index i = 1; i < E.size(); ++i) {
    if (!(E[i] > kShare * fit.E_0)) continue;
    fit.g.push_back(E[i] / fit.E_0);
    fit.tau.push_back(tau[static_cast<std::size_t>(i - 1)]);
  }
  VectorXd deviation = A * E - b;
  const Index n = times(curve).size();
  if (!curve.over_time())
    deviation =
        (deviation.head(n).array().square() + deviation.tail(n).array().square()).sqrt().matrix().eval();
  fit.rms = deviation.norm() / std::sqrt(static_cast<double>(n));
  fit.largest = deviation.cwiseAbs().maxCoeff();
  return fit;
}

}  // namespace elastogear::model
