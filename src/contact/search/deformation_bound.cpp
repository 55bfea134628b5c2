#include "elastogear/contact/deformation_bound.h"

#include <cmath>

#include "elastogear/model/row_bounds.h"

namespace elastogear::contact {
namespace {

constexpr double kRoundoff = 1e-9;  // relative, far above that of sums of n_q terms

bool is_positive_diagonal(const Eigen::SparseMatrix<double>& K) {
  return K.rows() > 0 && K.nonZeros() == K.rows() && (K.diagonal().array() > 0).all();
}

}  // namespace

DeformationBound deformation_bound(const model::BasisRows& Phi, const Eigen::SparseMatrix<double>& K_r) {
  DeformationBound bound{&Phi, {}, 0};
  if (std::holds_alternative<model::SparseRows>(Phi) || !is_positive_diagonal(K_r)) return bound;
  bound.stiffness = K_r.diagonal();
  const model::RowBounds* known = model::known_bounds(Phi);
  bound.compliance = known ? known->compliance.maxCoeff()
                           : model::largest_square(*model::dense_rows(Phi), bound.stiffness.cwiseInverse());
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
