#include "elastogear/reduction/block_lanczos.h"

#include <slepcblaslapack.h>
#include <slepcsys.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <random>

#include "elastogear/base/error.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Columns = Eigen::Ref<MatrixXd>;

constexpr double kRoundoff = 1e-14;          // of the first block's norm: a direction below it is noise
constexpr double kNearlyOrthonormal = 0.25;  // smallest over largest eigenvalue of the Gram matrix
constexpr int kMaxPasses = 5;  // of orthogonalisation; two do unless the block nearly loses rank

MPI_Comm comm_of(Mat A) { return PetscObjectComm(reinterpret_cast<PetscObject>(A)); }

MatrixXd multiply(Mat M, Columns W) {
  UniqueMat dense, product;
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(MatGetSize(M, &n, nullptr));
  check(MatCreateDense(comm_of(M), static_cast<PetscInt>(W.rows()), PETSC_DECIDE, n,
                       static_cast<PetscInt>(W.cols()), W.data(), dense.out()));
  check(MatMatMult(M, dense, MAT_INITIAL_MATRIX, PETSC_DEFAULT, product.out()));
  check(MatDenseGetArrayRead(product, &values));
  MatrixXd MW = Eigen::Map<const MatrixXd>(values, W.rows(), W.cols());
  check(MatDenseRestoreArrayRead(product, &values));
  return MW;
}

// C := alpha op(A) B + beta C by BLAS.
void gemm(bool transposed, double alpha, const Eigen::Ref<const MatrixXd>& A,
          const Eigen::Ref<const MatrixXd>& B, double beta, Columns C) {
  const auto m = static_cast<PetscBLASInt>(C.rows()), n = static_cast<PetscBLASInt>(C.cols()),
             k = static_cast<PetscBLASInt>(B.rows());
  const auto stride = [](const auto& X) {
    return static_cast<PetscBLASInt>(std::max<Eigen::Index>(1, X.outerStride()));
  };
  const PetscBLASInt a = stride(A), b = stride(B), c = stride(C);
  if (m == 0 || n == 0) return;
  BLASgemm_(transposed ? "T" : "N", "N", &m, &n, &k, &alpha, A.data(), &a, B.data(), &b, &beta, C.data(), &c);
}

// A' B over all ranks; the same bits on each.
MatrixXd inner(MPI_Comm comm, const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B) {
  MatrixXd own(A.cols(), B.cols()), sum(A.cols(), B.cols());
  gemm(true, 1, A, B, 0, own);
  const int length = static_cast<int>(own.size());
  MPI_Reduce(own.data(), sum.data(), length, MPI_DOUBLE, MPI_SUM, 0, comm);
  MPI_Bcast(sum.data(), length, MPI_DOUBLE, 0, comm);
  return sum;
}

struct Orthonormal {
  MatrixXd H;  // columns of V x b: W = V H + Q R
  MatrixXd R;  // rank x b
};

// Rows of R that are not noise.
std::vector<int> kept_rows(const MatrixXd& R, double scale) {
  std::vector<int> kept;
  for (int i = 0; i < R.rows(); ++i)
    if (R.row(i).norm() > kRoundoff * scale) kept.push_back(i);
  return kept;
}

// W := Q, orthonormal and orthogonal to V in the inner product of M; drops columns that are in the span of V.
// Each pass projects and then divides by the square root of the Gram matrix.
Orthonormal orthonormalise(Mat M, const Eigen::Ref<const MatrixXd>& V, MatrixXd& W) {
  const MPI_Comm comm = comm_of(M);
  Orthonormal result{MatrixXd::Zero(V.cols(), W.cols()), MatrixXd::Identity(W.cols(), W.cols())};
  double scale = 0;
  for (int pass = 0; pass < kMaxPasses && W.cols() > 0; ++pass) {
    MatrixXd MW = multiply(M, W);
    if (pass == 0) scale = std::sqrt(inner(comm, W, MW).diagonal().maxCoeff());
    if (V.cols() > 0) {
      const MatrixXd C = inner(comm, V, MW);
      result.H += C * result.R;
      gemm(false, -1, V, C, 1, W);
      MW = multiply(M, W);
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(inner(comm, W, MW));
    const double largest = gram.eigenvalues().maxCoeff(), smallest = gram.eigenvalues().minCoeff();
    const VectorXd d = gram.eigenvalues().cwiseMax(kRoundoff * largest).cwiseSqrt();
    const MatrixXd R = d.asDiagonal() * gram.eigenvectors().transpose() * result.R;
    const std::vector<int> kept = kept_rows(R, scale);
    const MatrixXd U = gram.eigenvectors() * d.cwiseInverse().asDiagonal();
    result.R = R(kept, Eigen::all);
    MatrixXd Q(W.rows(), static_cast<Eigen::Index>(kept.size()));
    gemm(false, 1, W, U(Eigen::all, kept), 0, Q);
    W = std::move(Q);
    if (pass > 0 && smallest > kNearlyOrthonormal * largest) break;
  }
  return result;
}

void append(KrylovBasis& basis, const MatrixXd& Q) {
  basis.V.middleCols(basis.size, Q.cols()) = Q;
  basis.exhausted = Q.cols() == 0;
}

}  // namespace

KrylovBasis start_basis(Mat M, ShiftedFactor& factor, double sigma, int block, int capacity) {
  int rank = 0;
  PetscInt n_own = 0, n = 0;
  MPI_Comm_rank(comm_of(M), &rank);
  check(MatGetLocalSize(M, &n_own, nullptr));
  check(MatGetSize(M, &n, nullptr));
  KrylovBasis basis;
  basis.M = M;
  basis.sigma = sigma;
  basis.V.resize(n_own, capacity + block);
  basis.T.setZero(capacity + block, capacity + block);
  std::mt19937 generator(static_cast<unsigned>(rank));
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd W(n_own, std::min<PetscInt>(block, n));
  for (double& w : W.reshaped()) w = uniform(generator);
  W = multiply(M, W);
  factor.solve(W);
  basis.R = orthonormalise(M, basis.V.leftCols(0), W).R;
  append(basis, W);
  return basis;
}

bool has_room(const KrylovBasis& basis) {
  return !basis.exhausted && basis.size + 2 * basis.R.rows() <= basis.V.cols();
}

void expand(KrylovBasis& basis, ShiftedFactor& factor) {
  const auto block = basis.R.rows();
  const auto begin = basis.size;
  MatrixXd W = multiply(basis.M, basis.V.middleCols(begin, block));
  factor.solve(W);
  basis.size += static_cast<int>(block);
  const auto [H, R] = orthonormalise(basis.M, basis.V.leftCols(basis.size), W);
  basis.T.block(0, begin, basis.size, block) = H;
  basis.R = R;
  append(basis, W);
}

RitzPairs ritz_pairs(const KrylovBasis& basis) {
  auto m = static_cast<PetscBLASInt>(basis.size);
  MatrixXd s = basis.T.topLeftCorner(m, m);
  VectorXd theta(m);
  PetscBLASInt n_work = 1 + 6 * m + 2 * m * m, n_integer = 3 + 5 * m, info = 0;
  std::vector<double> work(n_work);
  std::vector<PetscBLASInt> integer(n_integer);
  LAPACKsyevd_("V", "U", &m, s.data(), &m, theta.data(), work.data(), &n_work, integer.data(), &n_integer,
               &info);
  require(info == 0, "LAPACK's dsyevd failed with code ", info, " on ", m, " Lanczos vectors");
  std::vector<int> order(m);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::abs(theta(i)) > std::abs(theta(j)); });
  RitzPairs pairs{theta(order), VectorXd(m), s(Eigen::all, order)};
  const MatrixXd rest = basis.R * pairs.s.bottomRows(basis.R.cols());
  pairs.error = rest.colwise().norm().transpose().cwiseQuotient(pairs.theta.cwiseAbs());
  return pairs;
}

MatrixXd ritz_vectors(const KrylovBasis& basis, const RitzPairs& pairs, const std::vector<int>& columns) {
  const MatrixXd s = pairs.s(Eigen::all, columns);
  const VectorXd theta = pairs.theta(columns);
  const MatrixXd next = basis.R * s.bottomRows(basis.R.cols()) * theta.cwiseInverse().asDiagonal();
  MatrixXd phi(basis.V.rows(), s.cols());
  gemm(false, 1, basis.V.leftCols(basis.size), s, 0, phi);
  if (next.rows() > 0) gemm(false, 1, basis.V.middleCols(basis.size, next.rows()), next, 1, phi);
  return phi;
}

}  // namespace elastogear::reduction
