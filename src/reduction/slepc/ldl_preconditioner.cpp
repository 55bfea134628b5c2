#include "reduction/slepc/ldl_preconditioner.h"

#include <petsc/private/pcimpl.h>

#include <algorithm>
#include <optional>
#include <string>

#include "elastogear/base/error.h"

namespace elastogear::reduction {
namespace {

// A matrix as it was when it was analysed.
struct Known {
  PetscObjectId id = 0;
  PetscObjectState pattern = 0;
  bool operator==(const Known&) const = default;
};

Known known(Mat A) {
  Known now;
  if (!A) return now;
  check(PetscObjectGetId(reinterpret_cast<PetscObject>(A), &now.id));
  check(MatGetNonzeroState(A, &now.pattern));
  return now;
}

struct Ldl {
  ST st = nullptr;                 // borrowed: it owns the PC
  ShiftedSolver* given = nullptr;  // borrowed
  std::optional<ShiftedFactor> factor = {};
  Known K = {}, M = {};  // of the factor
  bool factorised = false;
  int negative = 0;
};

Ldl& ldl(PC pc) { return *static_cast<Ldl*>(pc->data); }

// K, M and sigma of the matrix K - sigma M; M is null where it is assembled.
struct Operator {
  Mat K, M;
  double sigma;
};

Operator operator_of(PC pc) {
  PetscBool shell = PETSC_FALSE;
  Operator A{pc->pmat, nullptr, 0};
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc->pmat), MATSHELL, &shell));
  if (!shell) return A;
  const ST st = ldl(pc).st;
  require(st != nullptr, "PC type ", kLdlType,
          ": the matrix must be assembled, or that of an ST; use -st_matmode copy");
  PetscInt n_matrices = 0;
  check(STGetNumMatrices(st, &n_matrices));
  require(n_matrices == 2, "PC type ", kLdlType, ": the ST has ", n_matrices, " matrices, must be 2");
  check(STGetMatrix(st, 0, &A.K));
  check(STGetMatrix(st, 1, &A.M));
  check(STGetShift(st, &A.sigma));
  return A;
}

ShiftedSolver& analysed(PC pc, const Operator& A) {
  Ldl& data = ldl(pc);
  if (data.given) return *data.given;
  if (!data.factor || data.K != known(A.K) || data.M != known(A.M)) {
    data.factor.emplace(A.K, A.M);
    data.K = known(A.K);
    data.M = known(A.M);
    data.factorised = false;
  }
  return *data.factor;
}

ShiftedSolver& factorised(PC pc) {
  const Operator A = operator_of(pc);
  ShiftedSolver& factor = analysed(pc, A);
  Ldl& data = ldl(pc);
  if (!data.factorised) data.negative = factor.factorise(A.sigma);
  data.factorised = true;
  return factor;
}

// PETSc's error code of what f throws, whose message goes the way of PETSc's messages.
template <class F>
PetscErrorCode coded(PC pc, F&& f) {
  std::string message;
  try {
    f();
    return 0;
  } catch (const std::exception& error) {
    message = failure_text(error);
  }
  SETERRQ(PetscObjectComm(reinterpret_cast<PetscObject>(pc)), PETSC_ERR_LIB, "%s", message.c_str());
}

// The shift of the ST is not known yet when it asks for a new factor.
PetscErrorCode set_up(PC pc) {
  ldl(pc).factorised = false;
  return 0;
}

PetscErrorCode mat_apply(PC pc, Mat B, Mat X) {
  const PetscScalar* b = nullptr;
  PetscScalar* x = nullptr;
  PetscInt n_own = 0, n_columns = 0, b_stride = 0, x_stride = 0;
  PetscCall(MatGetLocalSize(B, &n_own, nullptr));
  PetscCall(MatGetSize(B, nullptr, &n_columns));
  PetscCall(MatDenseGetLDA(B, &b_stride));
  PetscCall(MatDenseGetLDA(X, &x_stride));
  PetscCheck(x_stride == n_own, PETSC_COMM_SELF, PETSC_ERR_SUP, "The columns must follow one another");
  PetscCall(MatDenseGetArrayRead(B, &b));
  PetscCall(MatDenseGetArrayWrite(X, &x));
  for (PetscInt j = 0; j < n_columns; ++j)
    std::copy_n(b + static_cast<std::ptrdiff_t>(j) * b_stride, n_own,
                x + static_cast<std::ptrdiff_t>(j) * n_own);
  PetscCall(coded(pc, [&] { factorised(pc).solve(Eigen::Map<Eigen::MatrixXd>(x, n_own, n_columns)); }));
  PetscCall(MatDenseRestoreArrayWrite(X, &x));
  return MatDenseRestoreArrayRead(B, &b);
}

PetscErrorCode apply(PC pc, Vec b, Vec x) {
  PetscScalar* values = nullptr;
  PetscInt n_own = 0;
  PetscCall(VecCopy(b, x));
  PetscCall(VecGetLocalSize(x, &n_own));
  PetscCall(VecGetArray(x, &values));
  PetscCall(coded(pc, [&] { factorised(pc).solve(Eigen::Map<Eigen::MatrixXd>(values, n_own, 1)); }));
  return VecRestoreArray(x, &values);
}

PetscErrorCode reset(PC pc) {
  ldl(pc).factor.reset();
  ldl(pc).factorised = false;
  return 0;
}

PetscErrorCode destroy(PC pc) {
  delete static_cast<Ldl*>(pc->data);
  pc->data = nullptr;
  return 0;
}

PetscErrorCode view(PC pc, PetscViewer viewer) {
  PetscBool ascii = PETSC_FALSE;
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(viewer), PETSCVIEWERASCII, &ascii));
  if (!ascii) return 0;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  L D L' by MUMPS in the order of METIS\n"));
  const ShiftedSolver* factor = ldl(pc).given ? ldl(pc).given : ldl(pc).factor ? &*ldl(pc).factor : nullptr;
  if (!factor) return 0;
  const FactorSize size = factor->size();
  PetscCall(PetscViewerASCIIPrintf(viewer, "  factor: %g entries, %g flops\n", size.entries, size.flops));
  if (!ldl(pc).factorised) return 0;
  return PetscViewerASCIIPrintf(viewer, "  negative pivots: %d\n", ldl(pc).negative);
}

PetscErrorCode create(PC pc) {
  pc->data = new Ldl{};
  pc->ops->setup = set_up;
  pc->ops->apply = apply;
  pc->ops->applytranspose = apply;
  pc->ops->matapply = mat_apply;
  pc->ops->reset = reset;
  pc->ops->destroy = destroy;
  pc->ops->view = view;
  return 0;
}

}  // namespace

void register_ldl() { check(PCRegister(kLdlType, create)); }

bool is_ldl(PC pc) {
  PetscBool same = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), kLdlType, &same));
  return same;
}

void ldl_set_transform(PC pc, ST st) { ldl(pc).st = st; }

void ldl_set_factor(PC pc, ShiftedSolver* factor) {
  ldl(pc).given = factor;
  ldl(pc).factorised = false;
}

int ldl_negative_pivots(PC pc) {
  factorised(pc);
  return ldl(pc).negative;
}

FactorSize ldl_size(PC pc) { return analysed(pc, operator_of(pc)).size(); }

}  // namespace elastogear::reduction
