#include "reduction/cyclic/harmonic_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <complex>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/block_product.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSameEigenvalue = 1e-6;  // relative: vectors so close are separated anew
constexpr double kSameModulus = 1e-6;

struct Problem {
  const fem::Matrices& matrices;
  const fem::Harmonic& harmonic;
  int first_orbit;
  Residual work;

  // The columns i W, rows of this rank.
  MatrixXd turned(const MatrixXd& W) const { return fem::times_i(harmonic, first_orbit, W); }
};

MatrixXd sum_over_ranks(MPI_Comm comm, MatrixXd own) {
  MPI_Allreduce(MPI_IN_PLACE, own.data(), static_cast<int>(own.size()), MPI_DOUBLE, MPI_SUM, comm);
  return own;
}

// W^H A W of the complex columns that W stands for.
MatrixXcd complex_gram(Mat A, const Problem& problem, const MatrixXd& W) {
  const MatrixXd A_W = BlockProduct(A)(W);
  MatrixXcd gram(W.cols(), W.cols());
  gram.real() = sum_over_ranks(comm_of(A), W.transpose() * A_W);
  gram.imag() = sum_over_ranks(comm_of(A), problem.turned(W).transpose() * A_W);
  return gram;
}

// W spans, as a real space, what m = W.cols()/2 complex columns z span together with i z: returns these, as
// eigenvectors. W is orthonormal, so that its complex Gram matrix has the eigenvalue 2 for the columns and 0.
MatrixXd complex_eigenvectors(const Problem& problem, const MatrixXd& W) {
  const auto m = W.cols() / 2;
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> gram(complex_gram(problem.matrices.M, problem, W));
  const VectorXd scale = gram.eigenvalues().tail(m).cwiseSqrt().cwiseInverse();
  MatrixXcd U = gram.eigenvectors().rightCols(m) * scale.asDiagonal();
  if (m > 1) {
    const MatrixXcd H = U.adjoint() * complex_gram(problem.matrices.K, problem, W) * U;
    U *= Eigen::SelfAdjointEigenSolver<MatrixXcd>(H).eigenvectors();
  }
  return W * U.real() + problem.turned(W) * U.imag();
}

// One of each pair of columns of W; groups of pairs with close eigenvalues are taken together.
MatrixXd one_of_each_pair(const Problem& problem, const MatrixXd& W, const VectorXd& eigenvalue) {
  MatrixXd Z(W.rows(), W.cols() / 2);
  for (Eigen::Index begin = 0, end; begin < W.cols(); begin = end) {
    end = begin + 2;
    while (end < W.cols() && eigenvalue(end) - eigenvalue(end - 1) < kSameEigenvalue * eigenvalue(end))
      end += 2;
    Z.middleCols(begin / 2, (end - begin) / 2) =
        complex_eigenvectors(problem, W.middleCols(begin, end - begin));
  }
  return Z;
}

void measure_all(const Problem& problem, const MatrixXd& Z, HarmonicModes& modes) {
  modes.eigenvalue.resize(Z.cols());
  modes.residual.resize(Z.cols());
  for (Eigen::Index j = 0; j < Z.cols(); ++j) {
    load(problem.work.phi, Z.col(j));
    measure(problem.matrices.K, problem.matrices.M, problem.work, &modes.eigenvalue(j), &modes.residual(j));
  }
}

// |z_i^H M_k z_j|, i != j.
double largest_product(const Problem& problem, const MatrixXd& Z) {
  MatrixXcd gram = complex_gram(problem.matrices.M, problem, Z);
  gram.diagonal().setZero();
  return gram.size() > 0 ? gram.cwiseAbs().maxCoeff() : 0;
}

// The real vectors W of a complex harmonic become its modes z, half as many.
MatrixXd complex_modes(const Problem& problem, const MatrixXd& W, HarmonicModes& modes) {
  MatrixXd Z = one_of_each_pair(problem, W, modes.eigenvalue);
  measure_all(problem, Z, modes);
  modes.orthogonality = largest_product(problem, Z);
  return Z;
}

// Gathers all rows on rank 0.
MatrixXd gathered(MPI_Comm comm, MatrixXd own) {
  int rank = 0, size = 1, rows = static_cast<int>(own.rows());
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  if (size == 1) return own;
  std::vector<int> count(size), first(size + std::size_t{1}, 0);
  MPI_Gather(&rows, 1, MPI_INT, count.data(), 1, MPI_INT, 0, comm);
  for (int r = 0; r < size; ++r) first[r + std::size_t{1}] = first[r] + count[r];
  MatrixXd all(rank == 0 ? first[size] : 0, own.cols());
  for (Eigen::Index j = 0; j < own.cols(); ++j)
    MPI_Gatherv(own.col(j).data(), rows, MPI_DOUBLE, rank == 0 ? all.col(j).data() : nullptr, count.data(),
                first.data(), MPI_DOUBLE, 0, comm);
  return all;
}

// Squared moduli of the complex components.
VectorXd squared_moduli(const fem::Harmonic& harmonic, const VectorXd& z) {
  const VectorXd iz = fem::times_i(harmonic, 0, z);
  return z.cwiseAbs2() + iz.cwiseAbs2();
}

void fix_phase(const fem::Harmonic& harmonic, Eigen::Ref<VectorXd> z) {
  const VectorXd iz = fem::times_i(harmonic, 0, z), moduli = squared_moduli(harmonic, z);
  const double least = (1 - 2 * kSameModulus) * moduli.maxCoeff();
  const auto first = std::find_if(moduli.begin(), moduli.end(), [&](double m) { return m >= least; });
  const auto at = first - moduli.begin();  // Re: the real parts of an orbit come first
  const double modulus = std::sqrt(moduli(at)), re = z(at) / modulus, im = -iz(at) / modulus;
  z = re * z - im * iz;
}

}  // namespace

void fix_phases(const fem::Harmonic& harmonic, MatrixXd& z) {
  for (Eigen::Index j = 0; j < z.cols(); ++j) {
    VectorXd column = z.col(j);
    if (harmonic.real)
      fix_sign(column);
    else
      fix_phase(harmonic, column);
    z.col(j) = column;
  }
}

HarmonicModes find_harmonic_modes(const fem::Matrices& matrices, const fem::Harmonic& harmonic,
                                  int first_orbit, const EigenOptions& options, const Progress& progress) {
  const auto& [K, M] = matrices;
  const Problem problem{matrices, harmonic, first_orbit, make_residual(K)};
  PetscInt n_own = 0;
  check(MatGetLocalSize(K, &n_own, nullptr));
  MatrixXd W(n_own, options.n_modes);
  const auto keep = [&](int i, Vec phi) {
    const PetscScalar* values = nullptr;
    if (i >= W.cols()) return;  // more than were counted: an error below
    check(VecGetArrayRead(phi, &values));
    W.col(i) = Eigen::Map<const VectorXd>(values, n_own);
    check(VecRestoreArrayRead(phi, &values));
  };
  const Eigenmodes found = find_eigenmodes(K, M, options, keep, progress);
  require(found.eigenvalue.size() == options.n_modes, "harmonic ", harmonic.k, " has ",
          found.eigenvalue.size(), " modes in the interval, ", options.n_modes,
          " were counted; move its ends");
  HarmonicModes modes;
  modes.k = harmonic.k;
  modes.eigenvalue = found.eigenvalue;
  modes.residual = found.residual;
  modes.orthogonality = found.orthogonality;
  modes.iterations = found.iterations;
  if (!harmonic.real) W = complex_modes(problem, W, modes);
  modes.z = gathered(comm_of(K), std::move(W));
  if (modes.z.rows() > 0) fix_phases(harmonic, modes.z);
  return modes;
}

}  // namespace elastogear::reduction
