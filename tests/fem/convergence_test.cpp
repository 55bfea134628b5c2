// Displacements given on the boundary of a cube, no loads: u = grad phi with a harmonic phi solves Lame's
// equations, because div u = 0 and the Laplacian of u vanishes.
#include <gtest/gtest.h>

#include <Eigen/IterativeLinearSolvers>
#include <iostream>

#include "elastogear/fem/inertia.h"
#include "other_cells.h"
#include "system.h"

namespace elastogear::convergence_test {
namespace {

using mesh::CellType;
using mesh::Mesh;

constexpr double kRate = 0.2;  // how far the measured order may stay below its limit on these mesh sizes
constexpr double kSolver = 1e-12;

// grad of exp(sqrt(2) x) sin(y) sin(z)
Eigen::Vector3d exact(const Eigen::Vector3d& X) {
  const double e = std::exp(std::sqrt(2.0) * X.x()), r = std::sqrt(2.0);
  return {r * e * std::sin(X.y()) * std::sin(X.z()), e * std::cos(X.y()) * std::sin(X.z()),
          e * std::sin(X.y()) * std::cos(X.z())};
}

// Root of the mean square error at the nodes, weighted by their mass.
double error(const Mesh& mesh, model::Element element) {
  const auto system = test::assemble(mesh, {}, PETSC_COMM_SELF, test::kSteelBody, {element});
  const Eigen::SparseMatrix<double> K = fem::gather_matrix(system.matrices.K, system.rows);
  Eigen::VectorXd u(3 * mesh.n_nodes()), held = Eigen::VectorXd::Zero(u.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) u.segment<3>(3 * i) = exact(mesh.X.col(i));
  for (const mesh::Face& face : mesh.face_sets.at("surface"))
    for (int node : face) held.segment<3>(3 * node).setOnes();
  // Inner rows of K u_h = 0; the identity in the rows of the boundary, whose error is zero.
  const Eigen::VectorXd is_free = 1 - held.array();
  const Eigen::VectorXd scale = held.cwiseProduct(Eigen::VectorXd(K.diagonal()));
  const Eigen::SparseMatrix<double> boundary(scale.asDiagonal());
  const Eigen::SparseMatrix<double> A =
      Eigen::SparseMatrix<double>(is_free.asDiagonal() * K * is_free.asDiagonal()) + boundary;
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(A);
  solver.setTolerance(kSolver);
  const Eigen::VectorXd e = solver.solve(is_free.cwiseProduct(K * u));
  const Eigen::VectorXd w = fem::mass_moments(mesh, test::kSteelBody).w_0.cwiseAbs();
  const Eigen::VectorXd squares = e.reshaped(3, mesh.n_nodes()).colwise().squaredNorm();
  return std::sqrt(squares.dot(w) / w.sum());
}

struct Case {
  CellType type;
  int order;  // of convergence
  model::Element element = model::Element::incompatible;
};

struct Convergence : testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Elements, Convergence,
                         testing::Values(Case{CellType::hex8, 2},
                                         Case{CellType::hex8, 2, model::Element::plain},
                                         Case{CellType::hex8, 2, model::Element::bbar},
                                         Case{CellType::tet4, 2}, Case{CellType::wedge6, 2},
                                         Case{CellType::pyramid5, 2}, Case{CellType::hex20, 3},
                                         Case{CellType::tet10, 3}, Case{CellType::wedge15, 3}));

TEST_P(Convergence, has_the_order_of_the_shape_functions_plus_one) {
  const CellType type = GetParam().type;
  const int order = GetParam().order;
  const model::Element element = GetParam().element;
  const auto at = [&](int n) {
    return error(test::cells_of(type, test::brick({n, n, n}, {1, 1, 1})), element);
  };
  const int n = order == 2 ? 8 : 2;
  const double rate = std::log2(at(n) / at(2 * n));
  std::cout << mesh::name(type) << " order " << rate << "\n";
  EXPECT_GT(rate, order - kRate);
}

}  // namespace
}  // namespace elastogear::convergence_test
