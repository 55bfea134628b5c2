// The same mesh, restraint and element in another program.
#include "calculix.h"

#include <gtest/gtest.h>

#include <optional>

#include "../fem/other_cells.h"
#include "../fem/system.h"
#include "../figures.h"
#include "elastogear/gear/worm.h"
#include "elastogear/reduction/eigenmodes.h"
#include "fem/elements/quadrature.h"
#include "fem/elements/shape.h"

namespace elastogear::calculix_test {
namespace {

using mesh::CellType;

// Relative. CalculiX keeps the incompatible modes as degrees of freedom that have inertia; condensed ones
// have none. The difference is of the order (cell size / wave length)^2, as that of each from the exact
// value.
constexpr double kDiscretisation = 0.005;
// Relative: the same shape functions and quadrature, so that only the two eigensolvers differ.
constexpr double kSameElement = 1e-4;

// A twisted, tapered, bent beam: no two cells alike.
mesh::Mesh crooked_beam() {
  const auto bend = [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    const double a = 3 * X.x(), s = 1 - 0.4 * X.x();
    const double y = s * (X.y() - 0.01), z = s * (X.z() - 0.012);
    return {X.x() + 2 * y * X.x(), std::cos(a) * y - std::sin(a) * z, std::sin(a) * y + std::cos(a) * z};
  };
  return test::mapped(test::distorted(test::brick({170, 3, 3}, {1, 0.02, 0.025}), 0.0005), bend);
}

// A stubby block with curved edges, twisted and tapered.
mesh::Mesh crooked_block(CellType type, std::array<int, 3> n) {
  const auto bend = [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    const double a = 1.5 * X.x(), s = 1 - 0.4 * X.x(), y = s * (X.y() - 0.1), z = s * (X.z() - 0.15);
    return {X.x() + 0.5 * y * X.x(), std::cos(a) * y - std::sin(a) * z, std::sin(a) * y + std::cos(a) * z};
  };
  return test::mapped(test::cells_of(type, test::distorted(test::brick(n, {1, 0.2, 0.3}), 0.01)), bend);
}

// M with as many points as the stiffness has, which is what CalculiX uses: too few for an exact mass.
void assemble_calculix_mass(const mesh::Mesh& mesh, const fem::Rule& rule, const fem::RowNumbering& rows,
                            Mat M) {
  check(MatZeroEntries(M));
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Matrix3Xd X = fem::cell_coordinates(mesh, cell);
    Eigen::MatrixXd M_e = Eigen::MatrixXd::Zero(X.cols(), X.cols());
    for (int p = 0; p < rule.w.size(); ++p) {
      const auto [N, dN] = fem::shape_values(mesh.cells.type[cell], rule.xi.col(p));
      M_e += test::kSteel.rho * rule.w(p) * Eigen::Matrix3d(X * dN).determinant() * N * N.transpose();
    }
    for (int a = 0; a < X.cols(); ++a)
      for (int b = 0; b < X.cols(); ++b) {
        const int i = rows.row[mesh.cells[cell][a]], j = rows.row[mesh.cells[cell][b]];
        for (int k = 0; i >= 0 && j >= 0 && k < 3; ++k)
          check(MatSetValue(M, 3 * i + k, 3 * j + k, M_e(a, b), ADD_VALUES));
      }
  }
  check(MatAssemblyBegin(M, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(M, MAT_FINAL_ASSEMBLY));
}

struct Comparison {
  std::string of;
  mesh::Mesh mesh;
  model::Element element;
  std::string calculix_element;
  int n_modes;
  double tolerance;
  std::optional<fem::Rule> mass_rule = std::nullopt;  // CalculiX's, where it is not exact
  std::string restrained = "xmin";
  model::Material material = test::kSteel;
};

void compare(const Comparison& c) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  const auto expected =
      test::calculix_frequencies({c.mesh, c.material, {c.restrained}, c.calculix_element}, c.n_modes);
  const auto system =
      test::assemble(c.mesh, {c.restrained}, PETSC_COMM_SELF, {{"", c.material}}, {c.element});
  if (c.mass_rule) assemble_calculix_mass(c.mesh, *c.mass_rule, system.rows, system.matrices.M);
  reduction::EigenOptions options;
  options.n_modes = c.n_modes;
  const auto ignore = [](int, Vec) {};
  const auto modes = reduction::find_eigenmodes(system.matrices.K, system.matrices.M, options, ignore);
  double worst = 0;
  for (int i = 0; i < c.n_modes; ++i) {
    const double f = std::sqrt(modes.eigenvalue(i)) / (2 * M_PI);
    worst = std::max(worst, std::abs(f / expected[i] - 1));
    std::cout << c.calculix_element << ", mode " << i << ": " << f << " Hz, " << expected[i] << " Hz\n";
  }
  test::figure({c.of, std::to_string(c.n_modes) + " frequencies", c.tolerance == kDiscretisation ? "%" : ""},
               worst, c.tolerance);
}

TEST(Frequencies, of_a_crooked_beam_equal_calculix) {
  compare({"crooked beam", crooked_beam(), model::Element::incompatible, "C3D8I", 20, kDiscretisation});
}

struct Case {
  CellType type;
  const char* calculix_element;
  std::array<int, 3> n;  // hexahedra along each side of the block
  std::optional<fem::Rule> mass_rule = std::nullopt;
  model::Element element = model::Element::incompatible;
};

struct SameElement : testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Types, SameElement,
    testing::Values(Case{CellType::hex20, "C3D20", {8, 2, 2}},
                    Case{CellType::tet4, "C3D4", {12, 4, 4}, fem::tetrahedron_rule(1)},
                    Case{CellType::tet10, "C3D10", {8, 2, 2}, fem::tetrahedron_rule(4)},
                    Case{CellType::wedge6, "C3D6", {12, 4, 4}, fem::wedge_rule(1, 2)},
                    Case{CellType::wedge15, "C3D15", {8, 2, 2}, fem::wedge_rule(3, 3)},
                    Case{CellType::hex8, "C3D8", {12, 4, 4}, fem::hexahedron_rule(2), model::Element::plain}),
    [](const auto& info) { return std::string(info.param.calculix_element); });

TEST_P(SameElement, has_the_first_50_frequencies_of_calculix) {
  const auto& [type, name, n, mass_rule, element] = GetParam();
  compare({"blocks of six cell types", crooked_block(type, n), element, name, 50, kSameElement, mass_rule});
}

// CalculiX takes the axes at the integration points too.
TEST(Frequencies, of_an_orthotropic_block_equal_calculix) {
  model::Material fibre = test::kFibre;
  model::Orientation& orientation = fibre.orthotropic->orientation;
  orientation.rotation.setZero();
  const auto block = crooked_block(CellType::hex20, {8, 2, 2});
  const auto with_fibre = [&] {
    compare({"orthotropic block",
             block,
             model::Element::incompatible,
             "C3D20",
             20,
             kSameElement,
             {},
             "xmin",
             fibre});
  };
  with_fibre();
  orientation.system = model::Orientation::System::cylindrical;
  orientation.origin << 0.1, -0.5, 0.2;
  orientation.axis << 1, 0.2, 0.1;
  with_fibre();
}

TEST(Frequencies, of_a_worm_equal_calculix) {
  const auto worm = gear::worm_mesh(gear::Design{}, {});
  compare({"worm", worm, model::Element::plain, "C3D8", 20, kSameElement, fem::hexahedron_rule(2), "seats"});
}

}  // namespace
}  // namespace elastogear::calculix_test
