#pragma once
// Block Lanczos for (K - sigma M)^-1 M in the inner product of M (Grimes, Lewis & Simon, SIAM J. Matrix Anal.
// Appl. 15, 1994): many right-hand sides go through the factor together, all else is matrix products.

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "reduction/eigensolver/block_product.h"
#include "reduction/eigensolver/tall_basis.h"

namespace elastogear::reduction {

/// Real numbers that a long vector's entry takes. A complex vector is two columns, its real part and then its
/// imaginary one; K and M are real all the same.
template <class Scalar>
constexpr int kParts = Eigen::NumTraits<Scalar>::IsComplex ? 2 : 1;

template <class Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// (K - sigma M)^-1 M V = V T + V_next R [0 .. 0 I], V^H M V = I. Scalar: double or std::complex<double>.
template <class Scalar = double>
struct KrylovBasis {
  const BlockProduct* M = nullptr;
  double sigma = 0;
  TallBasis* V = nullptr;  ///< own rows; the first `size` vectors count, then those of V_next
  Eigen::MatrixXd M_next;  ///< M V_next
  Dense<Scalar> T;         ///< capacity x capacity, its upper triangle counts
  Dense<Scalar> R;         ///< vectors of V_next x last block
  int size = 0;            ///< vectors of V in the relation
  bool exhausted = false;  ///< the space is invariant: V_next is empty

  int capacity() const { return V->capacity() / kParts<Scalar>; }
};

template <class Scalar = double>
struct RitzPairs {
  Eigen::VectorXd theta;  ///< 1 / (lambda - sigma), by descending modulus: the nearest to sigma first
  Eigen::VectorXd error;  ///< |(K - sigma M)^-1 M phi - theta phi|_M / |theta|
  Dense<Scalar> s;        ///< phi = V s
};

/// M times random columns, the same on every call. Collective.
Eigen::MatrixXd random_forces(const BlockProduct& M, int n_columns);

/// A basis whose first block is made of the vectors W, in V, whose contents are lost. Memory: V and 4 blocks
/// of own rows. Collective.
template <class Scalar>
KrylovBasis<Scalar> start_basis(const BlockProduct& M, double sigma, Eigen::MatrixXd W, TallBasis& V);

/// Adds the next block of vectors, W = (K - sigma M)^-1 M V_next. Collective. Call while there is room and
/// the basis is not exhausted.
template <class Scalar>
void expand(KrylovBasis<Scalar>& basis, Eigen::MatrixXd W);
template <class Scalar>
bool has_room(const KrylovBasis<Scalar>& basis);

template <class Scalar>
RitzPairs<Scalar> ritz_pairs(const KrylovBasis<Scalar>& basis);

/// phi = [V V_next] s of the given columns of `pairs`: one step of inverse iteration, which the relation
/// above gives for nothing, is added.
template <class Scalar>
Dense<Scalar> improved_coefficients(const KrylovBasis<Scalar>& basis, const RitzPairs<Scalar>& pairs,
                                    const std::vector<int>& columns);

/// Own rows of phi = [V V_next] s.
template <class Scalar>
Eigen::MatrixXd combine(const KrylovBasis<Scalar>& basis, const Dense<Scalar>& s);
/// phi^H M phi_2 for the vectors phi of s and given M phi_2 (own rows). Collective.
template <class Scalar>
Dense<Scalar> project(const KrylovBasis<Scalar>& basis, const Dense<Scalar>& s,
                      const Eigen::Ref<const Eigen::MatrixXd>& M_phi);

/// A^H B of vectors over all ranks. A, B: own rows. Collective.
template <class Scalar>
Dense<Scalar> gram(MPI_Comm comm, const Eigen::Ref<const Eigen::MatrixXd>& A,
                   const Eigen::Ref<const Eigen::MatrixXd>& B);

/// Sum over all ranks, the same bits on each.
Eigen::MatrixXd sum(MPI_Comm comm, const Eigen::MatrixXd& own);
/// A' B over all ranks. A, B: own rows.
Eigen::MatrixXd inner(MPI_Comm comm, const Eigen::Ref<const Eigen::MatrixXd>& A,
                      const Eigen::Ref<const Eigen::MatrixXd>& B);

}  // namespace elastogear::reduction
