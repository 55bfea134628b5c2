#include "elastogear/contact/deformation_bound.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "elastogear/model/row_products.h"

namespace elastogear::contact {
namespace {

constexpr double kRoundoff = 1e-9;  // relative, far above that of sums of n_q terms

bool is_positive_diagonal(const Eigen::SparseMatrix<double>& K) {
  return K.rows() > 0 && K.nonZeros() == K.rows() && (K.diagonal().array() > 0).all();
}

// Largest eigenvalue of C = Phi_i K^-1 Phi_i' over all nodes i; their traces, which are not below it, leave
// out most.
double largest_compliance(const model::DenseRows& Phi, const Eigen::VectorXd& stiffness) {
  constexpr double kRoundoffOfTrace = 1e-12;
  const Eigen::VectorXd compliance = stiffness.cwiseInverse();
  double largest = 0;
  for (Eigen::Index i = 0; i < Phi.rows(); i += 3) {
    const Eigen::Matrix3d C = model::weighted_squares(Phi.row(i).data(), compliance.data(), Phi.cols());
    if (C.trace() < (1 - kRoundoffOfTrace) * largest) continue;
    largest = std::max(
        largest,
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
  }
  return largest;
}

}  // namespace

DeformationBound deformation_bound(const model::BasisRows& Phi, const Eigen::SparseMatrix<double>& K_r) {
  DeformationBound bound{&Phi, {}, 0};
  const auto* dense = std::get_if<model::DenseRows>(&Phi);
  if (dense == nullptr || !is_positive_diagonal(K_r)) return bound;
  bound.stiffness = K_r.diagonal();
  bound.compliance = largest_compliance(*dense, bound.stiffness);
  return bound;
}

double largest_displacement(const DeformationBound& bound, const Eigen::VectorXd& q) {
  if (q.size() == 0 || model::row_count(*bound.Phi) == 0) return 0;
  if (bound.stiffness.size() == 0)
    return std::sqrt(
        model::multiply(*bound.Phi, q).reshaped(3, Eigen::AutoSize).colwise().squaredNorm().maxCoeff());
  return (1 + kRoundoff) * std::sqrt(bound.compliance * q.cwiseAbs2().dot(bound.stiffness));
}

}  // namespace elastogear::contact
