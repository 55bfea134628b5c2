#include "elastogear/base/nnls.h"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace elastogear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRoundoff = 1e-12;  // of the largest coefficient, or product of a column with b

// Least squares with the columns whose coefficients are not held at zero; the others are zero.
VectorXd least_squares(const MatrixXd& A, const VectorXd& b, const std::vector<bool>& held) {
  constexpr double kDependent = 1e-10;
  MatrixXd open = A;
  for (Index i = 0; i < A.cols(); ++i)
    if (held[static_cast<std::size_t>(i)]) open.col(i).setZero();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(open.rows(), open.cols());
  qr.setThreshold(kDependent);
  qr.compute(open);
  VectorXd x = qr.solve(b);
  for (Index i = 0; i < A.cols(); ++i)
    if (held[static_cast<std::size_t>(i)]) x[i] = 0;
  return x;
}

}  // namespace

VectorXd nonnegative_least_squares(const MatrixXd& A, const VectorXd& b) {
  const Index n = A.cols();
  VectorXd x = VectorXd::Zero(n);
  if (n == 0) return x;
  const double least = kRoundoff * (A.transpose() * b).cwiseAbs().maxCoeff();
  std::vector<bool> held(static_cast<std::size_t>(n), true);
  for (Index round = 0; round < 10 * n; ++round) {
    VectorXd slope = A.transpose() * (b - A * x);
    for (Index i = 0; i < n; ++i)
      if (!held[static_cast<std::size_t>(i)]) slope[i] = 0;
    Index enters = 0;
    if (!(slope.maxCoeff(&enters) > least)) break;
    held[static_cast<std::size_t>(enters)] = false;
    while (true) {
      const VectorXd wanted = least_squares(A, b, held);
      double share = 1;
      for (Index i = 0; i < n; ++i)
        if (!held[static_cast<std::size_t>(i)] && wanted[i] <= 0)
          share = std::min(share, x[i] / (x[i] - wanted[i]));
      x += share * (wanted - x);
      if (share == 1) break;
      const double zero = kRoundoff * x.maxCoeff();
      for (Index i = 0; i < n; ++i)
        if (!held[static_cast<std::size_t>(i)] && x[i] <= zero) {
          held[static_cast<std::size_t>(i)] = true;
          x[i] = 0;
        }
    }
  }
  return x;
}

}  // namespace elastogear
