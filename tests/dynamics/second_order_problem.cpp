#include "second_order_problem.h"

namespace elastogear::test {
namespace {

PetscErrorCode function(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  auto& self = *static_cast<Integration*>(context);
  return guard(self.pending, [&] { set_values(F, self.problem.F(t, values(U), values(V), values(A))); });
}

void assemble(Mat P, const MatrixXd& J) {
  for (int i = 0; i < J.rows(); i++)
    for (int j = 0; j < J.cols(); j++) check(MatSetValue(P, i, j, J(i, j), INSERT_VALUES));
  check(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
}

PetscErrorCode jacobian(TS, PetscReal t, Vec U, Vec, Vec, PetscReal shift_V, PetscReal shift_A, Mat, Mat P,
                        void* context) {
  auto& self = *static_cast<Integration*>(context);
  return guard(self.pending, [&] { assemble(P, self.problem.J(t, values(U), shift_V, shift_A)); });
}

PetscErrorCode monitor(TS ts, PetscInt, PetscReal t, Vec, void* context) {
  auto& self = *static_cast<Integration*>(context);
  return guard(self.pending, [&] {
    Vec U = nullptr, V = nullptr;
    check(TS2GetSolution(ts, &U, &V));
    if (self.at_step) self.at_step(t, values(U), values(V));
  });
}

}  // namespace

Integration::Integration(Problem p, const std::string& options, Observer observer, TSProblemType kind)
    : problem(std::move(p)), at_step(std::move(observer)) {
  const Options scope("-ts_type generalized_alpha -ts_exact_final_time matchstep -pc_type lu " + options);
  const auto n = static_cast<PetscInt>(problem.U0.size());
  dynamics::register_generalized_alpha();
  U = vector(problem.U0);
  V = vector(problem.V0);
  residual = vector(problem.U0);
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, nullptr, jacobian.out()));
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetProblemType(ts, kind));
  check(TSSetI2Function(ts, residual, function, this));
  check(TSSetI2Jacobian(ts, jacobian, jacobian, test::jacobian, this));
  check(TS2SetSolution(ts, U, V));
  check(TSMonitorSet(ts, monitor, this, nullptr));
  check(TSSetFromOptions(ts));
}

}  // namespace elastogear::test
