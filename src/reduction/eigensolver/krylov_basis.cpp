#include "reduction/eigensolver/krylov_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include "reduction/dense/dense_blas.h"
#include "reduction/dense/dense_eigenproblem.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstColumns = Eigen::Ref<const MatrixXd>;

constexpr double kRoundoff = 1e-14;          // of the first block's norm: a direction below it is noise
constexpr double kNearlyOrthonormal = 0.25;  // smallest over largest eigenvalue of the Gram matrix
constexpr double kWellConditioned = 1e-6;    // the same: dividing by its root loses three digits at most
constexpr double kSmallCorrection = 1e-6;    // relative: what is left of it after the projection is roundoff
constexpr int kMaxPasses = 5;

MatrixXd times(const ConstColumns& W, const MatrixXd& U) {
  MatrixXd product(W.rows(), U.cols());
  multiply(Op::plain, Op::plain, 1, W, U, 0, product);
  return product;
}

// A^H B of complex vectors from A' B of the real columns that hold their real and imaginary parts.
template <class Scalar>
Dense<Scalar> as_scalars(MatrixXd product) {
  if constexpr (kParts<Scalar> == 1) {
    return product;
  } else {
    const auto part = [&](int i, int j) {
      return product(Eigen::seq(i, Eigen::last, 2), Eigen::seq(j, Eigen::last, 2));
    };
    Dense<Scalar> result(product.rows() / 2, product.cols() / 2);
    if (result.size() == 0) return result;
    result.real() = part(0, 0) + part(1, 1);
    result.imag() = part(0, 1) - part(1, 0);
    return result;
  }
}

// The real coefficients by which columns of real and imaginary parts are combined as complex vectors are by
// C.
template <class Scalar>
MatrixXd as_reals(const Dense<Scalar>& C) {
  if constexpr (kParts<Scalar> == 1) {
    return C;
  } else {
    MatrixXd reals(2 * C.rows(), 2 * C.cols());
    for (Eigen::Index j = 0; j < C.cols(); ++j)
      for (Eigen::Index i = 0; i < C.rows(); ++i)
        reals.block<2, 2>(2 * i, 2 * j) << C(i, j).real(), C(i, j).imag(), -C(i, j).imag(), C(i, j).real();
    return reals;
  }
}

template <class Scalar>
Eigen::Index n_vectors(const MatrixXd& W) {
  return W.cols() / kParts<Scalar>;
}

// V^H W of the first n vectors of the basis.
template <class Scalar>
Dense<Scalar> dot(const KrylovBasis<Scalar>& basis, int n, const ConstColumns& W) {
  return as_scalars<Scalar>(sum(basis.M->comm(), basis.V->dot(n * kParts<Scalar>, W)));
}

// W += V C for the vectors of the basis from `first` on.
template <class Scalar>
void add_product(const KrylovBasis<Scalar>& basis, int first, const Dense<Scalar>& C,
                 Eigen::Ref<MatrixXd> W) {
  basis.V->add_product(first * kParts<Scalar>, as_reals<Scalar>(C), W);
}

template <class Scalar>
struct Orthonormal {
  Dense<Scalar> H;  // vectors of V x b: W = V H + Q R
  Dense<Scalar> R;  // rank x b
  MatrixXd M_Q;     // own rows of `rank` vectors
  double scale;     // norm of the block before anything was taken off
  bool done = false;
};

// Rows of R that are not noise.
template <class Scalar>
std::vector<int> kept_rows(const Dense<Scalar>& R, double scale) {
  std::vector<int> kept;
  for (int i = 0; i < R.rows(); ++i)
    if (R.row(i).norm() > kRoundoff * scale) kept.push_back(i);
  return kept;
}

// W := W G^-1/2, G: its Gram matrix; drops directions that are noise. Returns the real factor applied.
template <class Scalar>
MatrixXd normalise(MatrixXd& W, const Dense<Scalar>& G, double correction, Orthonormal<Scalar>& result) {
  const Eigen::SelfAdjointEigenSolver<Dense<Scalar>> gram(G);
  const double largest = gram.eigenvalues().maxCoeff(), smallest = gram.eigenvalues().minCoeff();
  const VectorXd d = gram.eigenvalues().cwiseMax(kRoundoff * largest).cwiseSqrt();
  const Dense<Scalar> R = d.asDiagonal() * gram.eigenvectors().adjoint() * result.R;
  const std::vector<int> kept = kept_rows<Scalar>(R, result.scale);
  const Dense<Scalar> scaled = gram.eigenvectors() * d.cwiseInverse().asDiagonal();
  const MatrixXd U = as_reals<Scalar>(scaled(Eigen::all, kept));
  result.R = R(kept, Eigen::all);
  W = times(W, U);
  result.done = smallest > kWellConditioned * largest &&
                correction * correction < kSmallCorrection * kSmallCorrection * smallest;
  return U;
}

// W := Q, orthonormal and orthogonal to the first n vectors V of the basis in the inner product of M; drops
// vectors that are in their span.
// Each pass projects and then divides by the square root of the Gram matrix; one does when W was nearly
// orthogonal to V before and well conditioned. The Gram matrix after the projection is W^H M W - C^H C.
template <class Scalar>
Orthonormal<Scalar> orthonormalise(const KrylovBasis<Scalar>& basis, int n, MatrixXd& W, double scale) {
  const BlockProduct& M = *basis.M;
  const Eigen::Index b = n_vectors<Scalar>(W);
  Orthonormal<Scalar> result{Dense<Scalar>::Zero(n, b), Dense<Scalar>::Identity(b, b), {}, scale};
  for (int pass = 0; pass < kMaxPasses && W.cols() > 0 && !result.done; ++pass) {
    const MatrixXd M_W = M(W);
    Dense<Scalar> G = gram<Scalar>(M.comm(), W, M_W);
    if (pass == 0) result.scale = std::max(scale, std::sqrt(G.diagonal().real().maxCoeff()));
    double correction = 0;
    if (n > 0) {
      const Dense<Scalar> C = dot(basis, n, M_W);
      result.H += C * result.R;
      add_product<Scalar>(basis, 0, -C, W);
      G -= C.adjoint() * C;
      correction = C.colwise().norm().maxCoeff();
    }
    normalise(W, G, correction, result);
  }
  result.M_Q = M(W);
  if (W.cols() > 0)
    result.M_Q = times(result.M_Q, normalise(W, gram<Scalar>(M.comm(), W, result.M_Q), 0, result));
  return result;
}

template <class Scalar>
void append(KrylovBasis<Scalar>& basis, const MatrixXd& Q, const Orthonormal<Scalar>& orthonormal) {
  basis.V->set(basis.size * kParts<Scalar>, Q);
  basis.M_next = orthonormal.M_Q;
  basis.R = orthonormal.R;
  basis.exhausted = Q.cols() == 0;
}

// Takes off what the three-term recurrence says is in the last two blocks; all the rest is roundoff. Returns
// the norm of what was taken.
template <class Scalar>
double recur(KrylovBasis<Scalar>& basis, MatrixXd& W) {
  const int block = static_cast<int>(basis.R.rows()), before = static_cast<int>(basis.R.cols()),
            begin = basis.size;
  double scale = 0;
  if (begin > 0) {
    add_product<Scalar>(basis, begin - before, -basis.R.adjoint(), W);
    basis.T.block(begin - before, begin, before, block) = basis.R.adjoint();
    scale = basis.R.norm();
  }
  const Dense<Scalar> A = gram<Scalar>(basis.M->comm(), basis.M_next, W);
  add_product<Scalar>(basis, begin, -A, W);
  basis.T.block(begin, begin, block, block) = A;
  return scale + A.norm();
}

}  // namespace

MatrixXd sum(MPI_Comm comm, const MatrixXd& own) {
  MatrixXd total(own.rows(), own.cols());
  const int length = static_cast<int>(own.size());
  MPI_Reduce(own.data(), total.data(), length, MPI_DOUBLE, MPI_SUM, 0, comm);
  MPI_Bcast(total.data(), length, MPI_DOUBLE, 0, comm);
  return total;
}

MatrixXd inner(MPI_Comm comm, const ConstColumns& A, const ConstColumns& B) {
  MatrixXd own(A.cols(), B.cols());
  multiply(Op::transposed, Op::plain, 1, A, B, 0, own);
  return sum(comm, own);
}

template <class Scalar>
Dense<Scalar> gram(MPI_Comm comm, const ConstColumns& A, const ConstColumns& B) {
  return as_scalars<Scalar>(inner(comm, A, B));
}

MatrixXd random_forces(const BlockProduct& M, int n_columns) {
  int rank = 0;
  MPI_Comm_rank(M.comm(), &rank);
  std::mt19937 generator(static_cast<unsigned>(rank));
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd W(M.n_own(), n_columns);
  for (double& w : W.reshaped()) w = uniform(generator);
  return M(W);
}

template <class Scalar>
KrylovBasis<Scalar> start_basis(const BlockProduct& M, double sigma, MatrixXd W, TallBasis& V) {
  KrylovBasis<Scalar> basis;
  basis.M = &M;
  basis.sigma = sigma;
  basis.V = &V;
  basis.T.setZero(basis.capacity(), basis.capacity());
  const Orthonormal<Scalar> first = orthonormalise(basis, 0, W, 0);
  append(basis, W, first);
  return basis;
}

template <class Scalar>
bool has_room(const KrylovBasis<Scalar>& basis) {
  return !basis.exhausted && basis.size + 2 * basis.R.rows() <= basis.capacity();
}

template <class Scalar>
void expand(KrylovBasis<Scalar>& basis, MatrixXd W) {
  const auto block = basis.R.rows();
  const auto begin = basis.size;
  const double scale = recur(basis, W);
  basis.size += static_cast<int>(block);
  const Orthonormal<Scalar> next = orthonormalise(basis, basis.size, W, scale);
  basis.T.block(0, begin, basis.size, block) += next.H;
  append(basis, W, next);
}

template <class Scalar>
RitzPairs<Scalar> ritz_pairs(const KrylovBasis<Scalar>& basis) {
  const int m = basis.size;
  Dense<Scalar> s = basis.T.topLeftCorner(m, m);
  const VectorXd theta = diagonalise(s);
  std::vector<int> order(m);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::abs(theta(i)) > std::abs(theta(j)); });
  RitzPairs<Scalar> pairs{theta(order), VectorXd(m), s(Eigen::all, order)};
  const Dense<Scalar> rest = basis.R * pairs.s.bottomRows(basis.R.cols());
  pairs.error = rest.colwise().norm().transpose().cwiseQuotient(pairs.theta.cwiseAbs());
  return pairs;
}

template <class Scalar>
Dense<Scalar> improved_coefficients(const KrylovBasis<Scalar>& basis, const RitzPairs<Scalar>& pairs,
                                    const std::vector<int>& columns) {
  const VectorXd theta = pairs.theta(columns);
  Dense<Scalar> s(basis.size + basis.R.rows(), theta.size());
  s.topRows(basis.size) = pairs.s(Eigen::all, columns);
  s.bottomRows(basis.R.rows()) =
      basis.R * s.middleRows(basis.size - basis.R.cols(), basis.R.cols()) * theta.cwiseInverse().asDiagonal();
  return s;
}

template <class Scalar>
MatrixXd combine(const KrylovBasis<Scalar>& basis, const Dense<Scalar>& s) {
  MatrixXd phi = MatrixXd::Zero(basis.V->n_rows(), s.cols() * kParts<Scalar>);
  add_product(basis, 0, s, phi);
  return phi;
}

template <class Scalar>
Dense<Scalar> project(const KrylovBasis<Scalar>& basis, const Dense<Scalar>& s, const ConstColumns& M_phi) {
  return s.adjoint() * dot(basis, static_cast<int>(s.rows()), M_phi);
}

// NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define ELASTOGEAR_INSTANTIATE(Scalar)                                                                 \
  template Dense<Scalar> gram<Scalar>(MPI_Comm, const ConstColumns&, const ConstColumns&);             \
  template KrylovBasis<Scalar> start_basis<Scalar>(const BlockProduct&, double, MatrixXd, TallBasis&); \
  template void expand(KrylovBasis<Scalar>&, MatrixXd);                                                \
  template bool has_room(const KrylovBasis<Scalar>&);                                                  \
  template RitzPairs<Scalar> ritz_pairs(const KrylovBasis<Scalar>&);                                   \
  template Dense<Scalar> improved_coefficients(const KrylovBasis<Scalar>&, const RitzPairs<Scalar>&,   \
                                               const std::vector<int>&);                               \
  template MatrixXd combine(const KrylovBasis<Scalar>&, const Dense<Scalar>&);                         \
  template Dense<Scalar> project(const KrylovBasis<Scalar>&, const Dense<Scalar>&, const ConstColumns&)
ELASTOGEAR_INSTANTIATE(double);
ELASTOGEAR_INSTANTIATE(std::complex<double>);
#undef ELASTOGEAR_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace elastogear::reduction
