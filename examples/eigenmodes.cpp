// Eigenvalues of a square membrane by the EPS type "block_lanczos": matrices that have nothing to do with
// gears.
//
//   eigenmodes [-cells 60] [-eps_nev 30 | -eps_interval 0,2000] [-eps_monitor] [-eps_view] [-eps_type
//   krylovschur]
//
// -laplace(u) = lambda u on the unit square, u = 0 on its edges, by the five-point difference formula with a
// unit mass matrix. With h = 1 / cells its eigenvalues are
//   lambda_jk = 4 / h^2 (sin^2(j pi h / 2) + sin^2(k pi h / 2)),  j, k = 1 .. cells - 1,
// double ones where j != k.

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/reduction/block_lanczos.h"

namespace {

using namespace elastogear;
using UniqueEPS = Handle<EPS, EPSDestroy>;

struct Membrane {
  int cells = 60;  // on an edge
  int n() const { return (cells - 1) * (cells - 1); }
};

// Five entries in a row at most: `middle` and, of the neighbours in the grid, `beside`.
UniqueMat five_point_matrix(const Membrane& membrane, double middle, double beside) {
  UniqueMat A;
  const int side = membrane.cells - 1;
  PetscInt begin = 0, end = 0;
  check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, membrane.n(), membrane.n(), 5, nullptr, 4,
                     nullptr, A.out()));
  check(MatGetOwnershipRange(A, &begin, &end));
  for (PetscInt row = begin; row < end; ++row) {
    const int i = row % side, j = row / side;
    check(MatSetValue(A, row, row, middle, INSERT_VALUES));
    if (i > 0) check(MatSetValue(A, row, row - 1, beside, INSERT_VALUES));
    if (i + 1 < side) check(MatSetValue(A, row, row + 1, beside, INSERT_VALUES));
    if (j > 0) check(MatSetValue(A, row, row - side, beside, INSERT_VALUES));
    if (j + 1 < side) check(MatSetValue(A, row, row + side, beside, INSERT_VALUES));
  }
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

std::vector<double> closed_form(const Membrane& membrane) {
  std::vector<double> lambda;
  const double h = 1.0 / membrane.cells;
  const auto part = [h](int j) { return std::pow(2 / h * std::sin(j * std::numbers::pi * h / 2), 2); };
  for (int j = 1; j < membrane.cells; ++j)
    for (int k = 1; k < membrane.cells; ++k) lambda.push_back(part(j) + part(k));
  std::sort(lambda.begin(), lambda.end());
  return lambda;
}

// Returns whether the eigenvalues, and their number, are right.
bool solve(const Membrane& membrane) {
  const double c = std::pow(membrane.cells, 2);
  const UniqueMat K = five_point_matrix(membrane, 4 * c, -c), M = five_point_matrix(membrane, 1, 0);
  UniqueEPS eps;
  check(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, reduction::kBlockLanczos));
  check(EPSSetDimensions(eps, 30, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetFromOptions(eps));
  check(EPSSolve(eps));

  PetscInt converged = 0, wanted = 0;
  PetscReal lower = 0, upper = 0, largest_residual = 0;
  EPSWhich which = EPS_SMALLEST_REAL;
  check(EPSGetConverged(eps, &converged));
  check(EPSGetDimensions(eps, &wanted, nullptr, nullptr));
  check(EPSGetWhichEigenpairs(eps, &which));
  std::vector<double> exact = closed_form(membrane);
  if (which == EPS_ALL) {
    check(EPSGetInterval(eps, &lower, &upper));
    std::erase_if(exact, [&](double lambda) { return lambda < lower || lambda > upper; });
    wanted = static_cast<PetscInt>(exact.size());
  }
  double largest_error = 0;
  for (PetscInt i = 0; i < std::min(converged, wanted); ++i) {
    PetscScalar lambda = 0;
    PetscReal residual = 0;
    check(EPSGetEigenvalue(eps, i, &lambda, nullptr));
    check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &residual));
    largest_residual = std::max(largest_residual, residual);
    largest_error = std::max(largest_error, std::abs(lambda / exact[static_cast<std::size_t>(i)] - 1));
  }
  check(PetscPrintf(PETSC_COMM_WORLD,
                    "%d eigenvalues of %d wanted, largest error %.1e, largest residual %.1e\n",
                    static_cast<int>(converged), static_cast<int>(wanted), largest_error, largest_residual));
  return converged >= wanted && largest_error < 1e-9 && largest_residual < 1e-6;
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  try {
    Membrane membrane;
    PetscInt cells = membrane.cells;
    check(PetscOptionsGetInt(nullptr, nullptr, "-cells", &cells, nullptr));
    membrane.cells = static_cast<int>(cells);
    reduction::register_block_lanczos();
    return solve(membrane) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
