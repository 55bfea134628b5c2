#include "dynamics/integrator/rigid_fields.h"

#include <Eigen/IterativeLinearSolvers>

namespace elastogear::dynamics {
namespace {

constexpr double kFieldTolerance = 1e-8;  // a preconditioner takes its coarse space from them
constexpr double kNegligible = 1e-12;     // of the largest mass

}  // namespace

Eigen::MatrixXd rigid_fields(const model::ElasticBody& body) {
  Eigen::MatrixXd M_S(body.n_q(), 6);
  M_S << body.inertia.C_l, body.inertia.C_r;
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(body.M_r);
  solver.setTolerance(kFieldTolerance);
  return solver.solve(M_S);
}

bool is_node_by_node(const model::ElasticBody& body) {
  if (body.basis != model::Basis::full || body.n_q() % 3 != 0) return false;
  const double negligible = kNegligible * body.inertia.C_l.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < body.n_q(); ++i)
    for (Eigen::Index direction = 0; direction < 3; ++direction)
      if (direction != i % 3 && std::abs(body.inertia.C_l(i, direction)) > negligible) return false;
  return true;
}

}  // namespace elastogear::dynamics
