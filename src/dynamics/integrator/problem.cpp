#include "dynamics/integrator/problem.h"

#include "dynamics/integrator/vec_view.h"
#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

constexpr double kLinearTolerance = 1e-10;  // where the solver is only a preconditioner
constexpr int kNewtonLimit = 25;
constexpr const char* kNotFinite = "the motion is not finite";
// A block of equations (the joint or the elastic coordinates of a body) whose forces are below this share of
// the largest block's has roundoff alone.
constexpr double kZeroForce = 1e-14;
constexpr double kDeepest = 0.9;  // share of the contact depth that may be used before a step is cut

template <class Object>
Problem& context(Object object, PetscErrorCode (*get)(Object, void*)) {
  Problem* problem = nullptr;
  check(get(object, &problem));
  return *problem;
}

// Makes SNES give the step up, so that it is cut.
void set_inadmissible(TS ts) {
  SNES snes = nullptr;
  check(TSGetSNES(ts, &snes));
  check(SNESSetFunctionDomainError(snes));
}

PetscErrorCode function(TS ts, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* ctx) {
  auto& problem = *static_cast<Problem*>(ctx);
  return guard(problem.pending, [&] {
    problem.pulse();
    const ReadView u(U), v(V), a(A);
    problem.trouble = (*v).allFinite() && (*a).allFinite() ? "" : kNotFinite;
    if (!problem.trouble.empty() || !is_admissible(problem, t, *u, *v)) return set_inadmissible(ts);
    problem.residual = problem.system.residual({t, *u, *v, *a});
    if (problem.residual.F.allFinite()) return assign(F, problem.residual.F);
    problem.trouble = "forces are not finite";
    set_inadmissible(ts);
  });
}

// A step that none follows is solved for as with factors.
void set_accuracy(TS ts, Problem& problem) {
  SNES snes = nullptr;
  PetscBool once = PETSC_FALSE;
  check(TSGetSNES(ts, &snes));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(snes), SNESKSPONLY, &once));
  PetscReal unbalanced = 0;
  check(SNESGetTolerances(snes, nullptr, &unbalanced, nullptr, nullptr, nullptr));
  problem.left = once ? kAsFactorised : left_of_step(unbalanced);
}

PetscErrorCode jacobian(TS ts, PetscReal t, Vec U, Vec V, Vec A, PetscReal shift_v, PetscReal shift_a, Mat J,
                        Mat P, void* ctx) {
  auto& problem = *static_cast<Problem*>(ctx);
  return guard(problem.pending, [&] {
    problem.pulse();
    set_accuracy(ts, problem);
    const ReadView u(U), v(V), a(A);
    problem.solver.set(problem.system.effective_matrix({t, *u, *v, *a}, {shift_v, shift_a}));
    assemble(J, P);
  });
}

PetscErrorCode multiply(Mat A, Vec x, Vec y) {
  Problem& problem = context(A, MatShellGetContext);
  return guard(problem.pending, [&] {
    problem.pulse();
    assign(y, problem.solver.multiply(*ReadView(x)));
  });
}

PetscErrorCode solve(PC pc, Vec y, Vec x) {
  Problem& problem = context(pc, PCShellGetContext);
  return guard(problem.pending, [&] {
    problem.pulse();
    assign(x, problem.solver.solve(*ReadView(y), problem.left));
  });
}

// SNES's own test would weigh angles against modal amplitudes; this one looks at every block for itself.
PetscErrorCode converged(SNES snes, PetscInt, PetscReal, PetscReal, PetscReal norm,
                         SNESConvergedReason* reason, void* ctx) {
  const auto& problem = *static_cast<Problem*>(ctx);
  PetscReal atol = 0, rtol = 0;
  PetscCall(SNESGetTolerances(snes, &atol, &rtol, nullptr, nullptr, nullptr));
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm))
    *reason = SNES_DIVERGED_FNORM_NAN;
  else if (norm <= atol)
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (imbalance(problem.residual) <= std::max<double>(rtol, problem.slack))
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  return 0;
}

}  // namespace

double imbalance(const Residual& r) {
  double share = 0;
  const double nothing = kZeroForce * r.scale.maxCoeff();
  for (Eigen::Index i = 0; i < r.norm.size(); ++i)
    if (r.scale[i] > nothing) share = std::max(share, r.norm[i] / r.scale[i]);
  return share;
}

void set_solvers(Problem& problem, SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  SNESLineSearch search = nullptr;
  check(SNESSetConvergenceTest(snes, converged, &problem, nullptr));
  // No tolerance of the update: after a refused trial PETSc compares the norms of an earlier solve with it.
  check(SNESSetTolerances(snes, PETSC_DEFAULT, kResidualTolerance, 0, kNewtonLimit, PETSC_DEFAULT));
  check(SNESGetLineSearch(snes, &search));
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  check(SNESGetKSP(snes, &ksp));
  const bool exact = problem.system.solver_is_exact() && problem.solver.is_exact();
  check(KSPSetType(ksp, exact ? KSPPREONLY : KSPGMRES));
  if (!exact) check(KSPSetTolerances(ksp, kLinearTolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetContext(pc, &problem));
  check(PCShellSetApply(pc, solve));
  check(PCShellSetName(pc, "low-rank solver"));
}

void assemble(Mat J, Mat P) {
  for (Mat matrix : {J, P}) {
    check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }
}

bool is_admissible(Problem& problem, double time, ConstVector U, ConstVector V) {
  problem.trouble.clear();
  if (!U.allFinite())
    problem.trouble = kNotFinite;
  else if (problem.system.depth_share(time, U, V) > kDeepest)
    problem.trouble = "bodies penetrate each other by nearly the contact depth (-contact_depth)";
  else if (!problem.system.contacts(time, U, V).balanced)
    problem.trouble = "contact forces and residual flexibility do not converge";
  return problem.trouble.empty();
}

void make_matrix(Problem& problem, UniqueMat& J) {
  const auto n = static_cast<PetscInt>(problem.system.size());
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &problem, J.out()));
  check(MatShellSetOperation(J, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
}

void attach(Problem& problem, TS ts, UniqueMat& J) {
  SNES snes = nullptr;
  make_matrix(problem, J);
  check(TSSetI2Function(ts, nullptr, function, &problem));
  check(TSSetI2Jacobian(ts, J, J, jacobian, &problem));
  check(TSGetSNES(ts, &snes));
  set_solvers(problem, snes);
}

}  // namespace elastogear::dynamics
