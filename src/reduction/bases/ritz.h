#pragma once
// Rayleigh-Ritz vectors of (K, M) in the span of given columns (docs/theory, section 2.7).

#include <Eigen/Core>

#include "elastogear/reduction/eigenmodes.h"
#include "reduction/eigensolver/block_product.h"
#include "reduction/eigensolver/tall_basis.h"

namespace elastogear::reduction {

/// V' K V = I; grows block by block.
struct RitzSpace {
  const BlockProduct *K = nullptr, *M = nullptr;
  TallBasis V;   ///< own rows; the first `size` columns count
  int size = 0;  ///< columns

  int room() const { return V.capacity() - size; }
};

/// Empty, with room for `capacity` columns. K must be positive definite.
RitzSpace make_space(const BlockProduct& K, const BlockProduct& M, int capacity);

/// Adds the columns of W (own rows), made orthonormal in the inner product of K: in their order, without
/// those of which all but 1e-7 (in that norm) lies in the span of the ones before, and at most `most`, for
/// which there must be room. Returns the columns added. Collective.
Eigen::MatrixXd extend(RitzSpace& space, Eigen::MatrixXd W, int most);

/// Stationary points phi = V s of the Rayleigh quotient in the space. Eq. (2.16).
struct RitzVectors {
  Eigen::VectorXd eigenvalue;  ///< rad^2/s^2, ascending; none below the eigenvalue of its number
  Eigen::MatrixXd s;           ///< phi' M phi = I, phi' K phi = diag(eigenvalue)
  double orthogonality = 0;    ///< largest |phi_i' M phi_j|, i != j
};

/// Collective; the same bits on all ranks. Throws Error when LAPACK fails.
RitzVectors ritz_vectors(const RitzSpace& space);

/// Own rows of V s. Collective only in that all ranks have their rows.
Eigen::MatrixXd combine(const RitzSpace& space, const Eigen::Ref<const Eigen::MatrixXd>& s);

/// Hands all vectors to the sink, in ascending order. The residuals say how far they are from eigenmodes.
/// K, M: those of the space. Collective.
Eigenmodes deliver(const RitzSpace& space, const RitzVectors& ritz, Mat K, Mat M, const ModeSink& sink);

}  // namespace elastogear::reduction
