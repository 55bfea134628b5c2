#include "dynamics/integrator/gmres.h"

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <vector>

#include "elastogear/dynamics/dense_lu.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kFirst = 16;          // vectors for which there is room at first
constexpr double kCancelled = 0.5;  // share of a vector that is left when its roundoff asks for a second pass

// The triangular factor of the Hessenberg matrix, and |b| e_1 turned with it: its last entry is the norm of
// the residual.
struct Hessenberg {
  MatrixXd R;
  VectorXd g;
  std::vector<Eigen::JacobiRotation<double>> turns;

  // Takes up column j: its entries along the basis, and the length of what is left.
  void add(Index j, VectorXd column) {
    for (Index i = 0; i < j; ++i)
      column.applyOnTheLeft(i, i + 1, turns[static_cast<std::size_t>(i)].adjoint());
    turns.emplace_back();
    turns.back().makeGivens(column[j], column[j + 1]);
    column.applyOnTheLeft(j, j + 1, turns.back().adjoint());
    g.applyOnTheLeft(j, j + 1, turns.back().adjoint());
    R.col(j).head(j + 1) = column.head(j + 1);
  }
};

// Takes the parts along the columns of Q, which are orthonormal, out of x. Returns them.
VectorXd take_out(const Eigen::Ref<const MatrixXd>& Q, VectorXd& x) {
  VectorXd along = dynamics::project(Q, x);
  dynamics::add_product(Q, along, x, -1);
  return along;
}

}  // namespace

std::optional<VectorXd> gmres(const std::function<VectorXd(const VectorXd&)>& multiply, const VectorXd& b,
                              const GmresLimits& limits) {
  const double norm = b.norm();
  if (norm <= limits.residual) return VectorXd();
  MatrixXd basis(b.size(), std::min(kFirst, limits.steps + 1));
  Hessenberg H{MatrixXd::Zero(limits.steps, limits.steps), norm * VectorXd::Unit(limits.steps + 1, 0), {}};
  basis.col(0) = b / norm;
  for (Index j = 0; j < limits.steps; ++j) {
    VectorXd next = multiply(basis.col(j)), column = VectorXd::Unit(j + 2, j);
    const double before = next.norm();
    column.head(j + 1) -= take_out(basis.leftCols(j + 1), next);
    if (next.norm() < kCancelled * before) column.head(j + 1) -= take_out(basis.leftCols(j + 1), next);
    const double left = column[j + 1] = next.norm();
    if (!std::isfinite(left)) return {};
    H.add(j, std::move(column));
    if (std::abs(H.g[j + 1]) <= limits.residual)
      return H.R.topLeftCorner(j + 1, j + 1).triangularView<Eigen::Upper>().solve(H.g.head(j + 1)).eval();
    if (j + 1 == basis.cols()) basis.conservativeResize(Eigen::NoChange, limits.steps + 1);
    basis.col(j + 1) = next / -left;  // (I - A) v less its parts along the basis
  }
  return {};
}

}  // namespace elastogear::dynamics
