#include "reduction/modes/dense_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/fem/gather.h"
#include "reduction/dense/dense_eigenproblem.h"
#include "reduction/dense/residual.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLargest = 5000;  // rows: some minutes, and 1 GB
constexpr int kShare = 3;       // one in so many modes wanted

// K phi = lambda M phi, ascending, phi' M phi = I.
struct Spectrum {
  VectorXd lambda;
  MatrixXd phi;
};

Spectrum solve(const MatrixXd& K, const MatrixXd& M) {
  const Eigen::LLT<MatrixXd> L(M);
  require(L.info() == Eigen::Success, "the mass matrix is not positive definite");
  MatrixXd A = L.matrixL().solve(K);
  A = L.matrixL().solve(A.transpose()).eval();
  A = (A + A.transpose()).eval() / 2;
  Spectrum spectrum{diagonalise(A), {}};
  spectrum.phi = L.matrixU().solve(A);
  return spectrum;
}

// Roundoff of `solve` is that of the largest eigenvalue. One step of inverse iteration takes what is high off
// the low modes, and a Ritz problem among these alone separates them anew.
void refine(const MatrixXd& K, const MatrixXd& M, Spectrum& spectrum) {
  VectorXd& lambda = spectrum.lambda;
  if (lambda(0) <= 0) return;  // an error of the caller's
  const double middle = std::sqrt(lambda(0) * lambda(lambda.size() - 1));
  Eigen::Index n = 0;
  while (n < lambda.size() && lambda(n) < middle) ++n;
  while (n < lambda.size() && lambda(n) - lambda(n - 1) < kEqual * lambda(n)) ++n;
  const Eigen::LLT<MatrixXd> L(K);
  if (L.info() != Eigen::Success) return;
  const MatrixXd M_phi = M * spectrum.phi.leftCols(n);
  const MatrixXd Y = L.solve(M_phi) * lambda.head(n).asDiagonal();
  const MatrixXd K_r = lambda.head(n).asDiagonal() * (M_phi.transpose() * Y), M_r = Y.transpose() * (M * Y);
  const Spectrum low = solve((K_r + K_r.transpose()) / 2, M_r);
  lambda.head(n) = low.lambda;
  spectrum.phi.leftCols(n) = Y * low.phi;
}

// The whole matrix on rank 0.
MatrixXd gathered(Mat A) {
  PetscInt n = 0;
  check(MatGetSize(A, &n, nullptr));
  std::vector<int> row(static_cast<std::size_t>(n));
  std::iota(row.begin(), row.end(), 0);
  return fem::gather_matrix(A, row);
}

int count_wanted(const VectorXd& lambda, const EigenOptions& options) {
  Eigen::Index n = options.n_modes;
  while (options.whole_pairs && n < lambda.size() && lambda(n) - lambda(n - 1) < kEqual * lambda(n)) ++n;
  return static_cast<int>(n);
}

double largest_product(const MatrixXd& M, const MatrixXd& phi) {
  MatrixXd gram = phi.transpose() * (M * phi);
  gram.diagonal().setZero();
  return gram.cwiseAbs().maxCoeff();
}

// Own rows of a column that rank 0 has.
void scatter(Mat A, const double* column, Vec own) {
  int rank = 0, size = 1;
  const PetscInt* ranges = nullptr;
  PetscScalar* values = nullptr;
  MPI_Comm_rank(comm_of(A), &rank);
  MPI_Comm_size(comm_of(A), &size);
  check(MatGetOwnershipRanges(A, &ranges));
  std::vector<int> first(ranges, ranges + size), count;
  for (int r = 0; r < size; ++r) count.push_back(static_cast<int>(ranges[r + 1] - ranges[r]));
  check(VecGetArrayWrite(own, &values));
  MPI_Scatterv(column, count.data(), first.data(), MPI_DOUBLE, values, count[rank], MPI_DOUBLE, 0,
               comm_of(A));
  check(VecRestoreArrayWrite(own, &values));
}

// Solution on rank 0: the spectrum, the number of wanted modes, the lowest eigenvalue and the largest product
// of two modes.
struct Solution {
  Spectrum spectrum;
  int count = 0;
  double lowest = 0, orthogonality = 0;
};

Solution solve_on_root(Mat K, Mat M, const EigenOptions& options) {
  Solution solution;
  int rank = 0;
  MPI_Comm_rank(comm_of(K), &rank);
  const MatrixXd K_all = gathered(K), M_all = gathered(M);
  collectively(comm_of(K), [&] {
    if (rank != 0) return;
    solution.spectrum = solve(K_all, M_all);
    solution.lowest = solution.spectrum.lambda(0);
    refine(K_all, M_all, solution.spectrum);
    solution.count = count_wanted(solution.spectrum.lambda, options);
    solution.orthogonality = largest_product(M_all, solution.spectrum.phi.leftCols(solution.count));
  });
  MPI_Bcast(&solution.count, 1, MPI_INT, 0, comm_of(K));
  MPI_Bcast(&solution.lowest, 1, MPI_DOUBLE, 0, comm_of(K));
  MPI_Bcast(&solution.orthogonality, 1, MPI_DOUBLE, 0, comm_of(K));
  return solution;
}

}  // namespace

bool suits_dense(int n, int n_modes) { return n <= kLargest && n_modes > n / kShare; }

Eigenmodes find_by_lapack(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                          const Progress& progress) {
  report(progress, "eigenmodes", 0);
  const Solution solution = solve_on_root(K, M, options);
  require_definite(K, M, solution.lowest);
  SearchState state;
  state.eigenvalue.resize(solution.count);
  state.residual.resize(solution.count);
  state.orthogonality = solution.orthogonality;
  const Residual w = make_residual(K);
  const MatrixXd& phi = solution.spectrum.phi;
  for (int i = 0; i < solution.count; ++i) {
    scatter(K, phi.size() > 0 ? phi.col(i).data() : nullptr, w.phi);
    measure(K, M, w, &state.eigenvalue(i), &state.residual(i));
    sink(i, w.phi);
  }
  if (options.commit) options.commit(state);
  report(progress, "eigenmodes", 1);
  return {state.eigenvalue, state.residual, state.orthogonality, 1};
}

}  // namespace elastogear::reduction
