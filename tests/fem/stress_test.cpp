#include "elastogear/fem/stress.h"

#include <gtest/gtest.h>

#include "brick.h"
#include "elastogear/base/error.h"

namespace elastogear::stress_test {
namespace {

using model::Element;

constexpr double kRoundoff = 1e-12;

// Bar under uniaxial tension F/A: u = F/(E A) (x, -nu y, -nu z).
Eigen::VectorXd tension(const mesh::Mesh& mesh, double stress) {
  const Eigen::Vector3d eps =
      stress / test::kSteel.E * Eigen::Vector3d(1, -test::kSteel.nu, -test::kSteel.nu);
  return (eps.asDiagonal() * mesh.X).reshaped();
}

std::vector<int> all_nodes(const mesh::Mesh& mesh) {
  std::vector<int> nodes;
  for (int i = 0; i < mesh.n_nodes(); ++i) nodes.push_back(i);
  return nodes;
}

TEST(StressOperator, shows_force_over_area_in_a_bar_under_tension) {
  const auto mesh = test::distorted(test::brick({6, 3, 3}, {1, 0.2, 0.3}), 0.02);
  const double F = 12e3, A = 0.2 * 0.3;
  for (Element element : {Element::plain, Element::incompatible}) {
    const auto S = fem::stress_operator({mesh, test::kSteelBody, element}, {5, 40, 111});
    const Eigen::VectorXd sigma = S * tension(mesh, F / A);
    for (int i = 0; i < 3; ++i) {
      Eigen::VectorXd expected = Eigen::VectorXd::Unit(6, 0) * F / A;
      EXPECT_LT((sigma.segment<6>(6 * i) - expected).norm(), kRoundoff * test::kSteel.E);
    }
  }
}

TEST(StressOperator, equals_the_whole_field) {
  const auto mesh = test::distorted(test::brick({3, 3, 2}, {1, 0.4, 0.3}), 0.02);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * mesh.n_nodes());
  const auto S = fem::stress_operator({mesh, test::kSteelBody, Element::incompatible}, all_nodes(mesh));
  const Eigen::MatrixXd field = fem::nodal_stress({mesh, test::kSteelBody, Element::incompatible}, u);
  EXPECT_LT((S * u - field.reshaped()).norm(), kRoundoff * field.norm());
}

TEST(NodalStress, takes_one_region_only_at_an_interface) {
  auto mesh = test::brick({2, 1, 1}, {2, 1, 1});
  mesh.cell_sets["rim"] = {1};
  const model::Material soft{test::kSteel.E / 10, test::kSteel.nu, 1000};
  const Eigen::VectorXd u = tension(mesh, 1e6);
  for (bool steel_first : {true, false}) {
    std::vector<model::MaterialRegion> regions{{"", test::kSteel}, {"rim", soft}};
    if (!steel_first) std::swap(regions[0], regions[1]);
    const Eigen::MatrixXd sigma = fem::nodal_stress({mesh, regions, Element::incompatible}, u);
    const double on_interface = steel_first ? 1e6 : 1e5, tolerance = kRoundoff * test::kSteel.E;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const double x = mesh.X(0, i);
      EXPECT_NEAR(sigma(0, i), x == 0 ? 1e6 : x == 1 ? on_interface : 1e5, tolerance);
    }
  }
}

TEST(StressOperator, at_a_node_of_no_cell_is_an_error) {
  auto mesh = test::brick({2, 1, 1}, {2, 1, 1});
  mesh.X.conservativeResize(3, mesh.n_nodes() + 1);
  mesh.X.rightCols<1>().setZero();
  EXPECT_THROW(fem::stress_operator({mesh, test::kSteelBody, Element::plain}, {mesh.n_nodes() - 1}), Error);
}

}  // namespace
}  // namespace elastogear::stress_test
