#include "reduction/slepc/spectral_transform.h"

#include "elastogear/base/error.h"
#include "reduction/slepc/ldl_preconditioner.h"

namespace elastogear::reduction {
namespace {

MPI_Comm comm_of(ST st) { return PetscObjectComm(reinterpret_cast<PetscObject>(st)); }

PC preconditioner(ST st) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(STGetKSP(st, &ksp));
  check(KSPGetPC(ksp, &pc));
  return pc;
}

// Negative pivots of a factorisation that PETSc holds.
int negative_pivots(PC pc) {
  Mat factor = nullptr;
  PetscInt negative = 0;
  check(PCFactorGetMatrix(pc, &factor));
  check(MatGetInertia(factor, &negative, nullptr, nullptr));
  return static_cast<int>(negative);
}

UniqueMat wrapped(ST st, PetscInt n_rows, const Eigen::MatrixXd& X) {
  UniqueMat dense;
  check(MatCreateDense(comm_of(st), static_cast<PetscInt>(X.rows()), PETSC_DECIDE, n_rows,
                       static_cast<PetscInt>(X.cols()), const_cast<double*>(X.data()), dense.out()));
  return dense;
}

}  // namespace

int SpectralTransform::factorise(double sigma) {
  check(STSetShift(st_, sigma));
  check(STSetUp(st_));
  const PC pc = preconditioner(st_);
  return is_ldl(pc) ? ldl_negative_pivots(pc) : negative_pivots(pc);
}

Eigen::MatrixXd SpectralTransform::solve(const Eigen::MatrixXd& B) {
  Mat K = nullptr;
  PetscInt n = 0;
  check(STGetMatrix(st_, 0, &K));
  check(MatGetSize(K, &n, nullptr));
  Eigen::MatrixXd X(B.rows(), B.cols());
  const UniqueMat right = wrapped(st_, n, B), left = wrapped(st_, n, X);
  check(STMatMatSolve(st_, right, left));
  return X;
}

FactorSize SpectralTransform::size() const {
  const PC pc = preconditioner(st_);
  if (is_ldl(pc)) return ldl_size(pc);
  constexpr double kEntriesPerRow = 500, kFlopsPerEntry = 1000;  // of solids with some 100,000 rows
  Mat K = nullptr;
  PetscInt n = 0;
  check(STGetMatrix(st_, 0, &K));
  check(MatGetSize(K, &n, nullptr));
  return {kEntriesPerRow * n, kFlopsPerEntry * kEntriesPerRow * n};
}

}  // namespace elastogear::reduction
