#pragma once
// Block Lanczos for (K - sigma M)^-1 M with full reorthogonalisation in the inner product of M (Grimes, Lewis
// & Simon, SIAM J. Matrix Anal. Appl. 15, 1994): many right-hand sides go through the factor together.

#include <Eigen/Core>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/reduction/factorisation.h"

namespace elastogear::reduction {

/// (K - sigma M)^-1 M V = V T + V_next R [0 .. 0 I], V' M V = I.
struct KrylovBasis {
  Mat M = nullptr;
  double sigma = 0;
  Eigen::MatrixXd V;       ///< own rows x capacity; the first `size` columns count, then those of V_next
  Eigen::MatrixXd T;       ///< capacity x capacity, its upper triangle counts
  Eigen::MatrixXd R;       ///< columns of V_next x last block
  int size = 0;            ///< columns of V in the relation
  bool exhausted = false;  ///< the space is invariant: V_next is empty
};

struct RitzPairs {
  Eigen::VectorXd theta;  ///< 1 / (lambda - sigma), by descending modulus: the nearest to sigma first
  Eigen::VectorXd error;  ///< |(K - sigma M)^-1 M phi - theta phi|_M / |theta|
  Eigen::MatrixXd s;      ///< phi = V s
};

/// Room for `capacity` columns and a first block of random ones. The factor is that of K - sigma M.
/// Memory: (capacity + 2 block) own rows. Collective.
KrylovBasis start_basis(Mat M, ShiftedFactor& factor, double sigma, int block, int capacity);

/// Adds the next block of columns. Collective. Call while there is room and the basis is not exhausted.
void expand(KrylovBasis& basis, ShiftedFactor& factor);
bool has_room(const KrylovBasis& basis);

RitzPairs ritz_pairs(const KrylovBasis& basis);

/// Own rows of the Ritz vectors of the given columns of `pairs`, improved by one step of inverse iteration
/// that the relation above gives for nothing.
Eigen::MatrixXd ritz_vectors(const KrylovBasis& basis, const RitzPairs& pairs,
                             const std::vector<int>& columns);

}  // namespace elastogear::reduction
