#pragma once
// A System as a PETSc problem: the callbacks of TS, SNES, the shell matrix and its exact preconditioner.

#include <algorithm>
#include <functional>

#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

/// Largest share of the forces that may be unbalanced, where nothing else is asked for.
inline constexpr double kResidualTolerance = 1e-8;
/// Share of the forces that may be unbalanced where steps are chosen by their error, a share of the elastic
/// displacement: forces that are unbalanced by a share move bodies by no more than that share of it.
inline double unbalanced_at(double step_error) { return std::max(kResidualTolerance, 0.1 * step_error); }

/// Share of a Newton step's contact forces that its linear solution may leave, where Newton's method may
/// leave the share `unbalanced` of all forces: little beside it, and no less than is ever asked of forces.
inline double left_of_step(double unbalanced) { return std::max(kResidualTolerance, 0.1 * unbalanced); }

/// Data that the callbacks share. It must outlive the TS.
struct Problem {
  explicit Problem(System& s) : system(s), solver(s.solver_bodies()) {}

  System& system;
  LowRankSolver solver;
  Residual residual;            ///< of the last evaluation
  double slack = 0;             ///< share of the forces that may be unbalanced, where it is above -snes_rtol
  double left = kAsFactorised;  ///< share of its contact forces that the solution of a step may leave
  std::string trouble;          ///< why a state was last called inadmissible; empty: it was not
  std::exception_ptr pending;   ///< what a callback threw
  std::function<void()> pulse = [] {};  ///< called at every evaluation, product and solve; may throw
};

/// Exception that a pulse throws to give up the present solve; it is no error.
struct Interrupted {};

/// Sets F, its Jacobian, the convergence test and the solvers of a TS whose type is known. `J` is created.
void attach(Problem& problem, TS ts, UniqueMat& J);

/// Part of attach: creates the shell matrix for the solver's products.
void make_matrix(Problem& problem, UniqueMat& J);
/// Part of attach: sets the convergence test by blocks, and the exact solver as preconditioner.
void set_solvers(Problem& problem, SNES snes);
void assemble(Mat J, Mat P);
/// Largest norm of a block over the sum of the norms of its forces: 0 in balance, at most 1. Blocks in which
/// nothing acts but the roundoff of others have none.
double imbalance(const Residual& r);
/// Returns whether forces can be computed at this state; if not, `trouble` says why.
bool is_admissible(Problem& problem, double time, ConstVector U, ConstVector V);

}  // namespace elastogear::dynamics
