#pragma once
// Block Lanczos for (K - sigma M)^-1 M in the inner product of M (Grimes, Lewis & Simon, SIAM J. Matrix Anal.
// Appl. 15, 1994): many right-hand sides go through the factor together, all else is matrix products.

#include <Eigen/Core>
#include <vector>

#include "reduction/eigensolver/block_product.h"
#include "reduction/eigensolver/tall_basis.h"
#include "reduction/slepc/spectral_transform.h"

namespace elastogear::reduction {

/// (K - sigma M)^-1 M V = V T + V_next R [0 .. 0 I], V' M V = I.
struct KrylovBasis {
  const BlockProduct* M = nullptr;
  double sigma = 0;
  TallBasis* V = nullptr;  ///< own rows; the first `size` columns count, then those of V_next
  Eigen::MatrixXd M_next;  ///< M V_next
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

/// A first block of random columns, the same on every call, in V, whose contents are lost. The shift of the
/// transform is sigma. Memory: V and 4 block own rows. Collective.
KrylovBasis start_basis(const BlockProduct& M, SpectralTransform& transform, double sigma, int block,
                        TallBasis& V);

/// Adds the next block of columns. Collective. Call while there is room and the basis is not exhausted.
void expand(KrylovBasis& basis, SpectralTransform& transform);
bool has_room(const KrylovBasis& basis);

RitzPairs ritz_pairs(const KrylovBasis& basis);

/// phi = [V V_next] s of the given columns of `pairs`: one step of inverse iteration, which the relation
/// above gives for nothing, is added.
Eigen::MatrixXd improved_coefficients(const KrylovBasis& basis, const RitzPairs& pairs,
                                      const std::vector<int>& columns);

/// Own rows of phi = [V V_next] s.
Eigen::MatrixXd combine(const KrylovBasis& basis, const Eigen::MatrixXd& s);
/// phi' M phi_2 for the vectors phi of s and given M phi_2 (own rows). Collective.
Eigen::MatrixXd project(const KrylovBasis& basis, const Eigen::MatrixXd& s,
                        const Eigen::Ref<const Eigen::MatrixXd>& M_phi);

/// Sum over all ranks, the same bits on each.
Eigen::MatrixXd sum(MPI_Comm comm, const Eigen::MatrixXd& own);
/// A' B over all ranks. A, B: own rows.
Eigen::MatrixXd inner(MPI_Comm comm, const Eigen::Ref<const Eigen::MatrixXd>& A,
                      const Eigen::Ref<const Eigen::MatrixXd>& B);

}  // namespace elastogear::reduction
