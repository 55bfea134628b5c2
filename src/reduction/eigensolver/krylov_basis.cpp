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

struct Orthonormal {
  MatrixXd H;    // columns of V x b: W = V H + Q R
  MatrixXd R;    // rank x b
  MatrixXd M_Q;  // own rows x rank
  double scale;  // norm of the block before anything was taken off
  bool done = false;
};

// Rows of R that are not noise.
std::vector<int> kept_rows(const MatrixXd& R, double scale) {
  std::vector<int> kept;
  for (int i = 0; i < R.rows(); ++i)
    if (R.row(i).norm() > kRoundoff * scale) kept.push_back(i);
  return kept;
}

// W := W G^-1/2, G: its Gram matrix; drops directions that are noise. Returns the factor applied.
MatrixXd normalise(MatrixXd& W, const MatrixXd& G, double correction, Orthonormal& result) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(G);
  const double largest = gram.eigenvalues().maxCoeff(), smallest = gram.eigenvalues().minCoeff();
  const VectorXd d = gram.eigenvalues().cwiseMax(kRoundoff * largest).cwiseSqrt();
  const MatrixXd R = d.asDiagonal() * gram.eigenvectors().transpose() * result.R;
  const std::vector<int> kept = kept_rows(R, result.scale);
  const MatrixXd U = (gram.eigenvectors() * d.cwiseInverse().asDiagonal())(Eigen::all, kept);
  result.R = R(kept, Eigen::all);
  W = times(W, U);
  result.done = smallest > kWellConditioned * largest &&
                correction * correction < kSmallCorrection * kSmallCorrection * smallest;
  return U;
}

// W := Q, orthonormal and orthogonal to the first n columns V of the basis in the inner product of M; drops
// columns that are in their span.
// Each pass projects and then divides by the square root of the Gram matrix; one does when W was nearly
// orthogonal to V before and well conditioned. The Gram matrix after the projection is W' M W - C' C.
Orthonormal orthonormalise(const KrylovBasis& basis, int n, MatrixXd& W, double scale) {
  const BlockProduct& M = *basis.M;
  Orthonormal result{MatrixXd::Zero(n, W.cols()), MatrixXd::Identity(W.cols(), W.cols()), {}, scale};
  for (int pass = 0; pass < kMaxPasses && W.cols() > 0 && !result.done; ++pass) {
    const MatrixXd M_W = M(W);
    MatrixXd G = inner(M.comm(), W, M_W);
    if (pass == 0) result.scale = std::max(scale, std::sqrt(G.diagonal().maxCoeff()));
    double correction = 0;
    if (n > 0) {
      const MatrixXd C = sum(M.comm(), basis.V->dot(n, M_W));
      result.H += C * result.R;
      basis.V->add_product(0, -C, W);
      G -= C.transpose() * C;
      correction = C.colwise().norm().maxCoeff();
    }
    normalise(W, G, correction, result);
  }
  result.M_Q = M(W);
  if (W.cols() > 0) result.M_Q = times(result.M_Q, normalise(W, inner(M.comm(), W, result.M_Q), 0, result));
  return result;
}

void append(KrylovBasis& basis, const MatrixXd& Q, const Orthonormal& orthonormal) {
  basis.V->set(basis.size, Q);
  basis.M_next = orthonormal.M_Q;
  basis.R = orthonormal.R;
  basis.exhausted = Q.cols() == 0;
}

// Takes off what the three-term recurrence says is in the last two blocks; all the rest is roundoff. Returns
// the norm of what was taken.
double recur(KrylovBasis& basis, MatrixXd& W) {
  const int block = static_cast<int>(basis.R.rows()), before = static_cast<int>(basis.R.cols()),
            begin = basis.size;
  double scale = 0;
  if (begin > 0) {
    basis.V->add_product(begin - before, -basis.R.transpose(), W);
    basis.T.block(begin - before, begin, before, block) = basis.R.transpose();
    scale = basis.R.norm();
  }
  const MatrixXd A = inner(basis.M->comm(), basis.M_next, W);
  basis.V->add_product(begin, -A, W);
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

KrylovBasis start_basis(const BlockProduct& M, SpectralTransform& transform, double sigma, int block,
                        TallBasis& V) {
  int rank = 0;
  MPI_Comm_rank(M.comm(), &rank);
  KrylovBasis basis;
  basis.M = &M;
  basis.sigma = sigma;
  basis.V = &V;
  basis.T.setZero(basis.V->capacity(), basis.V->capacity());
  std::mt19937 generator(static_cast<unsigned>(rank));
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd W(M.n_own(), std::min(block, M.n()));
  for (double& w : W.reshaped()) w = uniform(generator);
  W = transform.solve(M(W));
  const Orthonormal first = orthonormalise(basis, 0, W, 0);
  append(basis, W, first);
  return basis;
}

bool has_room(const KrylovBasis& basis) {
  return !basis.exhausted && basis.size + 2 * basis.R.rows() <= basis.V->capacity();
}

void expand(KrylovBasis& basis, SpectralTransform& transform) {
  const auto block = basis.R.rows();
  const auto begin = basis.size;
  MatrixXd W = transform.solve(basis.M_next);
  const double scale = recur(basis, W);
  basis.size += static_cast<int>(block);
  const Orthonormal next = orthonormalise(basis, basis.size, W, scale);
  basis.T.block(0, begin, basis.size, block) += next.H;
  append(basis, W, next);
}

RitzPairs ritz_pairs(const KrylovBasis& basis) {
  const int m = basis.size;
  MatrixXd s = basis.T.topLeftCorner(m, m);
  const VectorXd theta = diagonalise(s);
  std::vector<int> order(m);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::abs(theta(i)) > std::abs(theta(j)); });
  RitzPairs pairs{theta(order), VectorXd(m), s(Eigen::all, order)};
  const MatrixXd rest = basis.R * pairs.s.bottomRows(basis.R.cols());
  pairs.error = rest.colwise().norm().transpose().cwiseQuotient(pairs.theta.cwiseAbs());
  return pairs;
}

MatrixXd improved_coefficients(const KrylovBasis& basis, const RitzPairs& pairs,
                               const std::vector<int>& columns) {
  const VectorXd theta = pairs.theta(columns);
  MatrixXd s(basis.size + basis.R.rows(), theta.size());
  s.topRows(basis.size) = pairs.s(Eigen::all, columns);
  s.bottomRows(basis.R.rows()) =
      basis.R * s.middleRows(basis.size - basis.R.cols(), basis.R.cols()) * theta.cwiseInverse().asDiagonal();
  return s;
}

MatrixXd combine(const KrylovBasis& basis, const MatrixXd& s) {
  MatrixXd phi = MatrixXd::Zero(basis.V->n_rows(), s.cols());
  basis.V->add_product(0, s, phi);
  return phi;
}

MatrixXd project(const KrylovBasis& basis, const MatrixXd& s, const ConstColumns& M_phi) {
  return s.transpose() * sum(basis.M->comm(), basis.V->dot(static_cast<int>(s.rows()), M_phi));
}

}  // namespace elastogear::reduction
