// What must hold for worm and wheel at every size.
#include <functional>
#include <numbers>
#include <random>

#include "elastogear/base/error.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "mesh_checks.h"

namespace elastogear::gear::gear_mesh_test {
namespace {

struct Case {
  const char* name;
  std::function<mesh::Mesh(const Design&)> mesh;
};

Case worm_case(const char* name, Size size) {
  return {name, [size](const Design& d) { return worm_mesh(d, worm_counts(size, d.z1)); }};
}
Case wheel_case(const char* name, Size size) {
  return {name, [size](const Design& d) { return wheel_mesh(d, wheel_counts(size)); }};
}
std::string case_name(const testing::TestParamInfo<Case>& info) { return info.param.name; }

class GearMesh : public testing::TestWithParam<Case> {};

TEST_P(GearMesh, is_conforming) {
  const mesh::Mesh mesh = GetParam().mesh({});
  expect_conforming(mesh);
  expect_distinct_used_nodes(mesh);
}

TEST_P(GearMesh, has_well_shaped_cells) { expect_good_cells(GetParam().mesh({})); }

INSTANTIATE_TEST_SUITE_P(Reference, GearMesh,
                         testing::Values(worm_case("tiny_worm", Size::tiny),
                                         worm_case("small_worm", Size::small),
                                         wheel_case("tiny_wheel", Size::tiny),
                                         wheel_case("small_wheel", Size::small)),
                         case_name);

class LargeGearMesh : public testing::TestWithParam<Case> {};

TEST_P(LargeGearMesh, has_well_shaped_cells) { expect_good_cells(GetParam().mesh({})); }

INSTANTIATE_TEST_SUITE_P(Reference, LargeGearMesh,
                         testing::Values(worm_case("medium_worm", Size::medium),
                                         worm_case("paper_worm", Size::paper),
                                         wheel_case("medium_wheel", Size::medium),
                                         wheel_case("paper_wheel", Size::paper)),
                         case_name);

TEST(PaperSize, passes_the_papers_table_1) {
  const mesh::Mesh worm = worm_mesh({}, worm_counts(Size::paper));
  EXPECT_GE(worm.n_nodes(), 90082);
  EXPECT_GE(worm.cells.size(), 98666);
  EXPECT_GE(worm.face_sets.at("flanks").size(), 10106u);
  const mesh::Mesh wheel = wheel_mesh({}, wheel_counts(Size::paper));
  EXPECT_GE(wheel.n_nodes(), 468587);
  EXPECT_GE(wheel.cells.size(), 406672);
  EXPECT_GE(wheel.face_sets.at("flanks").size(), 11760u);
}

// Other numbers of starts: the staircase, the seam and the sets must not rely on two threads.
TEST(GearMeshOfOtherDesigns, is_conforming_and_well_shaped) {
  for (int z1 : {1, 3}) {
    Design d;
    d.z1 = z1;
    d.a = z1 == 1 ? 49e-3 : 53e-3;
    d.shoulder = 1.5e-3;
    const mesh::Mesh worm = worm_mesh(d, worm_counts(Size::tiny, z1));
    expect_conforming(worm);
    expect_good_cells(worm);
    const mesh::Mesh wheel = wheel_mesh(d, wheel_counts(Size::tiny));
    expect_conforming(wheel);
    expect_good_cells(wheel);
    const Geometry g = derive(d);
    for (int i = 0; i < z1; ++i)
      expect_flank(worm, "thread_" + std::to_string(i + 1) + "_left", g.worm, i, 1);
  }
}

// Worm drives of 1 to 6 starts with diameter quotients of 7 to 14 and pressure angles of 14 to 25 deg, by
// proportions, with cells of an order. Returns how many of them have meshes.
int good_random_drives(int designs, int order) {
  std::mt19937 random(1);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  int good = 0;
  for (int i = 0; i < designs; ++i) {
    const double m_n = between(0.5e-3, 10e-3), alpha_n = between(14, 25) * std::numbers::pi / 180;
    const int z_1 = static_cast<int>(between(1, 7)), z_2 = 4 * z_1 + static_cast<int>(between(16, 100));
    const double q = between(7, 14), a = m_n / std::cos(std::atan(z_1 / q)) * (q + z_2) / 2;
    try {
      const Design d = proportioned(m_n, alpha_n, z_1, z_2, a);
      for (const mesh::Mesh& mesh : {worm_mesh(d, worm_counts(Size::tiny, z_1, order)),
                                     wheel_mesh(d, wheel_counts(Size::tiny, order))})
        EXPECT_GE(mesh::quality(mesh).min_scaled_jacobian, 0.25);
      ++good;
    } catch (const Error& error) {
      const std::string why = error.what();
      EXPECT_TRUE(why.find("undercut") != why.npos || why.find("worm_fillet") != why.npos ||
                  why.find("scaled Jacobian") != why.npos)
          << why;
    }
  }
  return good;
}

TEST(ProportionedDesign, exists_and_has_good_cells_for_nearly_all_random_drives) {
  EXPECT_GE(good_random_drives(100, 1), 95);
}

TEST(ProportionedDesign, has_good_cells_of_second_order_as_often) { EXPECT_GE(good_random_drives(10, 2), 9); }

}  // namespace
}  // namespace elastogear::gear::gear_mesh_test
