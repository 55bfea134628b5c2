// Cantilevers of hexahedra against beam theory.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <unsupported/Eigen/MatrixFunctions>

#include "../fem/system.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::beam_test {
namespace {

using model::Element;

constexpr double kLength = 1, kHeight = 0.1, kWidth = 0.1;
constexpr double kArea = kHeight * kWidth, kI = kWidth * kHeight * kHeight * kHeight / 12;
// Without lateral contraction the clamped end is that of beam theory exactly.
const model::Material kMaterial{210e9, 0, 7850};
const double kShear = kMaterial.E / 2 * 5 / 6;  // kappa G

mesh::Mesh cantilever(int n) { return test::brick({10 * n, n, n}, {kLength, kWidth, kHeight}); }

// Mean deflection of the end under a unit transverse force spread evenly over its nodes.
double tip_deflection(const mesh::Mesh& mesh, Element element, const model::Material& material) {
  const auto system = test::assemble(mesh, {"xmin"}, PETSC_COMM_SELF, {{"", material}}, {element});
  const auto K = fem::gather_matrix(system.matrices.K, system.rows);
  const auto dofs = fem::free_dofs(fem::held_directions(mesh, {"xmin"}));
  const auto& tip = mesh.node_sets.at("xmax");
  Eigen::VectorXd f = Eigen::VectorXd::Zero(K.rows());
  for (int i = 0; i < f.size(); ++i)
    if (dofs[i] % 3 == 2 && std::binary_search(tip.begin(), tip.end(), dofs[i] / 3)) f(i) = 1.0 / tip.size();
  return f.dot(Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(K).solve(f));
}

double timoshenko_deflection(const model::Material& material) {
  const double G = material.E / (2 * (1 + material.nu));
  return std::pow(kLength, 3) / (3 * material.E * kI) + kLength / (5.0 / 6 * G * kArea);
}

// Determinant of the clamped-free Timoshenko beam at omega: the dimensionless state (w/L, psi, M L/EI, V
// L^2/EI) carried along by its transfer matrix; w' = psi + V/(kappa G A), psi' = M/(E I), M' = -V - omega^2
// rho I psi, V' = -omega^2 rho A w.
double characteristic(double omega) {
  const double EI = kMaterial.E * kI, L = kLength, s = omega * omega * kMaterial.rho;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A(0, 1) = 1;
  A(0, 3) = EI / (kShear * kArea * L * L);
  A(1, 2) = 1;
  A(2, 1) = -s * kI * L * L / EI;
  A(2, 3) = -1;
  A(3, 0) = -s * kArea * std::pow(L, 4) / EI;
  return Eigen::Matrix4d(A.exp()).bottomRightCorner<2, 2>().determinant();
}

// n-th root of the characteristic function, bracketed by small steps and bisected.
double timoshenko_frequency(int n) {
  double a = 1, step = 50;
  for (int found = 0;; a += step)
    if (characteristic(a) * characteristic(a + step) < 0 && found++ == n) break;
  for (int i = 0; i < 60; ++i) {
    step /= 2;
    if (characteristic(a) * characteristic(a + step) > 0) a += step;
  }
  return a;
}

Eigen::VectorXd frequencies(const mesh::Mesh& mesh, int n, const model::Material& material,
                            model::ElementMass mass = model::ElementMass::compatible) {
  const auto system =
      test::assemble(mesh, {"xmin"}, PETSC_COMM_SELF, {{"", material}}, {model::Element::incompatible, mass});
  reduction::EigenOptions options;
  options.n_modes = n;
  const auto ignore = [](int, Vec) {};
  return reduction::find_eigenmodes(system.matrices.K, system.matrices.M, options, ignore)
      .eigenvalue.cwiseSqrt();
}

TEST(Cantilever, of_one_element_of_height_bends_within_two_percent) {
  for (double nu : {0.0, 0.3}) {
    const model::Material material{210e9, nu, 7850};
    const double exact = timoshenko_deflection(material);
    EXPECT_NEAR(tip_deflection(cantilever(1), Element::incompatible, material) / exact, 1, 0.02) << nu;
    EXPECT_LT(tip_deflection(cantilever(1), Element::plain, material) / exact, 0.8);  // shear locking
  }
}

// Observed order from the errors on two meshes, the second twice as fine.
double order(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

TEST(Cantilever, deflection_converges_to_timoshenko_with_second_order) {
  const double exact = timoshenko_deflection(kMaterial);
  for (Element element : {Element::plain, Element::incompatible}) {
    const double coarse = tip_deflection(cantilever(2), element, kMaterial) / exact - 1;
    const double fine = tip_deflection(cantilever(4), element, kMaterial) / exact - 1;
    EXPECT_NEAR(order(coarse, fine), 2, 0.2);
    EXPECT_LT(std::abs(fine), element == Element::plain ? 0.04 : 0.001);
  }
}

TEST(Cantilever, frequencies_converge_to_timoshenko_with_second_order) {
  const int bending[3] = {0, 2, 6};  // first of each pair; torsion and tension lie between
  const auto coarse = frequencies(cantilever(2), 8, kMaterial),
             fine = frequencies(cantilever(4), 8, kMaterial);
  for (int i = 0; i < 3; ++i) {
    const double exact = timoshenko_frequency(i);
    EXPECT_NEAR(fine(bending[i]) / exact, 1, 0.01) << i;
    EXPECT_NEAR(order(coarse(bending[i]) / exact - 1, fine(bending[i]) / exact - 1), 2, 0.3) << i;
  }
}

// Cells of bending modes move along parabolas; those of tension are stretched alone, and have no amplitudes.
TEST(Cantilever, of_condensed_mass_errs_less_in_upper_bending_and_the_same_in_tension) {
  const auto nodal = frequencies(cantilever(2), 8, kMaterial),
             condensed = frequencies(cantilever(2), 8, kMaterial, model::ElementMass::condensed);
  const int bending[2] = {2, 6}, tension = 5;
  for (int i = 0; i < 2; ++i) {
    const double exact = timoshenko_frequency(i + 1), off = condensed(bending[i]) / exact - 1;
    EXPECT_LT(std::abs(off), 0.8 * std::abs(nodal(bending[i]) / exact - 1)) << i;
    EXPECT_LT(std::abs(off), 0.025) << i;
  }
  EXPECT_NEAR(condensed(tension) / nodal(tension), 1, 1e-4);
}

TEST(Cantilever, of_slender_shape_has_euler_bernoulli_frequencies) {
  const auto mesh = test::brick({100, 2, 2}, {10, kWidth, kHeight});
  const double root[3] = {1.875104068711961, 4.694091132974174, 7.854757438237612};
  const auto omega = frequencies(mesh, 6, kMaterial);
  for (int i = 0; i < 3; ++i) {
    const double exact = root[i] * root[i] / 100 * std::sqrt(kMaterial.E * kI / (kMaterial.rho * kArea));
    EXPECT_NEAR(omega(2 * i) / exact, 1, 1e-3) << i;
    EXPECT_NEAR(omega(2 * i + 1) / exact, 1, 1e-3) << i;
  }
}

}  // namespace
}  // namespace elastogear::beam_test
