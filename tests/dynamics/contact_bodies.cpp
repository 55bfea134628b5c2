#include "contact_bodies.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "../contact/surfaces.h"
#include "elastogear/body/rigid.h"

namespace elastogear::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;

// A primitive of 1 / sqrt(x^2 + y^2) over x and y.
double primitive(double x, double y) {
  const auto part = [](double a, double b) { return a == 0 ? 0 : a * std::asinh(b / std::abs(a)); };
  return part(x, y) + part(y, x);
}

// Normal displacement at a distance from the centre of a square of size h under a total force of 1 N.
double compliance(const HalfSpace& spec, const Vector2d& at) {
  const double b = spec.h / 2, E_star = spec.E / (1 - spec.nu * spec.nu);
  const double integral = primitive(at[0] + b, at[1] + b) - primitive(at[0] + b, at[1] - b) -
                          primitive(at[0] - b, at[1] + b) + primitive(at[0] - b, at[1] - b);
  return integral / (std::numbers::pi * E_star * spec.h * spec.h);
}

// Of all nodes of the quarter; every force acts on its mirror images, too.
MatrixXd compliances(const HalfSpace& spec, const Eigen::Matrix3Xd& X) {
  MatrixXd C(X.cols(), X.cols());
  for (Eigen::Index i = 0; i < C.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = 0;
      for (double sx : {-1, 1})
        for (double sy : {-1, 1}) sum += compliance(spec, {X(0, i) + sx * X(0, j), X(1, i) + sy * X(1, j)});
      C(i, j) = C(j, i) = sum;
    }
  return C;
}

}  // namespace

void complete(model::Surface& surface) {
  for (int i = 0; i < surface.X.cols(); ++i) surface.node.push_back(i);
  surface.group.assign(static_cast<std::size_t>(surface.face.cols()), 0);
  surface.group_name = {"all"};
}

std::shared_ptr<model::ElasticBody> rigid_with(model::Surface surface, double mass) {
  auto body = std::make_shared<model::ElasticBody>(
      body::rigid_body(mass, Eigen::Vector3d::Zero(), mass / 6 * Eigen::Matrix3d::Identity()));
  complete(surface);
  surface.Phi = model::DenseRows(3 * surface.X.cols(), 0);
  body->surface = std::move(surface);
  return body;
}

std::shared_ptr<const model::ElasticBody> half_space(const HalfSpace& spec, double R) {
  const double l = spec.n * spec.h;
  auto body = rigid_with(contact::test::grid(spec.n, spec.n, [&](double u, double v) {
    return Eigen::Vector3d(l * u, l * v, -l * l * (u * u + v * v) / (2 * R));
  }));
  model::Surface& surface = body->surface;
  const auto n_s = surface.X.cols();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(compliances(spec, surface.X));
  const MatrixXd V = modes.eigenvectors().rowwise().reverse();
  const Eigen::VectorXd stiffness = modes.eigenvalues().reverse().cwiseInverse();
  model::DenseRows Phi = model::DenseRows::Zero(3 * n_s, n_s);
  for (Eigen::Index i = 0; i < n_s; ++i) Phi.row(3 * i + 2) = V.row(i);
  surface.Phi = Phi;
  body->M_r = Eigen::VectorXd::Ones(n_s).asDiagonal();
  body->K_r = stiffness.asDiagonal();
  body->frequency = stiffness.cwiseSqrt() / (2 * std::numbers::pi);
  body->inertia.C_l.setZero(n_s, 3);
  body->inertia.C_r.setZero(n_s, 3);
  body->inertia.S_1.setZero(9, n_s);
  return body;
}

Eigen::VectorXd equilibrium(dynamics::System& system, Eigen::VectorXd U) {
  constexpr int kIterations = 40;
  constexpr double kTolerance = 1e-10;  // of the forces that balance
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  dynamics::LowRankSolver solver(system.solver_bodies());
  for (int i = 0; i < kIterations; ++i) {
    const dynamics::State x{0, U, zero, zero};
    const dynamics::Residual r = system.residual(x);
    if (i > 0 && (r.norm.array() <= kTolerance * r.scale.array()).all()) break;
    solver.set(system.effective_matrix(x, {0, 0}));
    U -= solver.solve(r.F);
  }
  return U;
}

model::Snapshot state_at_rest(dynamics::System& system, const Eigen::VectorXd& U) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(U.size());
  return dynamics::snapshot(system, {0, U, zero, zero});
}

}  // namespace elastogear::test
