// Meshes of 20-node hexahedra.
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "elastogear/mesh/repetition.h"
#include "gear/rack.h"
#include "gear/worm/profiles.h"
#include "mesh_checks.h"

namespace elastogear::gear::second_order_test {
namespace {

mesh::Mesh quadratic_worm(const Design& d, Size size = Size::tiny) {
  return worm_mesh(d, worm_counts(size, d.z1, 2));
}

mesh::Mesh quadratic_wheel(const Design& d, Size size = Size::tiny) {
  return wheel_mesh(d, wheel_counts(size, 2));
}

// The Euler characteristic that is asked of the boundary counts the pieces that the sides are cut into.
void expect_good_mesh(const mesh::Mesh& mesh) {
  expect_conforming(mesh);
  expect_distinct_used_nodes(mesh);
  expect_good_cells(mesh);
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    ASSERT_EQ(mesh.cells.type[cell], mesh::CellType::hex20);
}

TEST(SecondOrderMesh, is_conforming_with_good_cells_and_nodes_on_the_flanks) {
  const Geometry g = derive(Design{});
  const mesh::Mesh worm = quadratic_worm({}), wheel = quadratic_wheel({});
  expect_good_mesh(worm);
  expect_good_mesh(wheel);
  expect_flank(worm, "thread_2_left", g.worm, 1, 1);
  expect_flank(worm, "thread_1_right", g.worm, 0, -1);
  expect_flank(wheel, "tooth_41_left", g.wheel, 40, 1);
  expect_flank(wheel, "tooth_01_right", g.wheel, 0, -1);
}

// The sizes and numbers of nodes of docs/validation/recovery.md, section Roots; the paper's worm and wheel
// have 90,082 and 468,587 nodes.
TEST(SecondOrderMesh, of_larger_sizes_has_good_cells_and_at_most_the_papers_nodes) {
  for (Size size : {Size::small, Size::medium, Size::paper}) {
    const mesh::Mesh worm = quadratic_worm({}, size), wheel = quadratic_wheel({}, size);
    expect_good_cells(worm);
    expect_good_cells(wheel);
    EXPECT_LE(worm.n_nodes() + wheel.n_nodes(), 90082 + 468587);
  }
}

TEST(SecondOrderMesh, has_rows_that_grow_from_the_root_inwards) {
  WheelCounts n = wheel_counts(Size::tiny, 2);
  n.growth = 3;
  const Design d;
  const mesh::Mesh mesh = wheel_mesh(d, n);
  const double r_f = derive(d).wheel.r_f, rim = d.rim_diameter / 2;
  const Toothing t = derive(d).wheel;
  double above_rim = r_f;  // radius of the first node above the rim, in the middle of a space
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const Eigen::Vector3d x = mesh.X.col(node);
    const double r = x.head<2>().norm(), pitch = 2 * std::numbers::pi / t.z;
    const double beside = std::remainder(std::atan2(x[1], x[0]) - t.theta_1 - pitch / 2, pitch);
    if (r > rim + 1e-6 && std::abs(x[2]) < 1e-9 && std::abs(beside) < 1e-6)
      above_rim = std::min(above_rim, r);
  }
  // The midside node of the inner of two rows, three times as thick as the outer one.
  EXPECT_NEAR(above_rim, rim + 0.75 * (r_f - rim) / 2, 1e-6 * (r_f - rim));
  n.growth = 0.5;
  EXPECT_THROW(wheel_mesh(d, n), Error);
  n.growth = 3;
  n.tooth_growth = 11;
  EXPECT_THROW(wheel_mesh(d, n), Error);
}

TEST(SecondOrderMesh, of_other_drives_is_as_good) {
  for (int z1 : {1, 3}) {
    Design d;
    d.z1 = z1;
    d.a = z1 == 1 ? 49e-3 : 53e-3;
    d.shoulder = 1.5e-3;
    d.hand = z1 == 1 ? Hand::left : Hand::right;
    const Geometry g = derive(d);
    const mesh::Mesh worm = quadratic_worm(d);
    expect_good_mesh(worm);
    expect_flank(worm, "thread_1_left", g.worm, 0, 1);
  }
  Design hobbed;
  hobbed.wheel_form = WheelForm::throated;
  hobbed.face_width = 11e-3;
  const mesh::Mesh wheel = quadratic_wheel(hobbed);
  expect_good_mesh(wheel);
  EXPECT_LT(largest_distance(wheel, "tooth_07_left", derive(hobbed).wheel, 6, 1), 1e-9);
  CylindricalDrive pair;
  pair.m_n = 3e-3;
  pair.beta = 0.3;
  pair.gears = {{.name = "sun", .z = 20, .cutter = {}, .blank = {}},
                {.name = "ring", .z = 60, .internal = true, .cutter = {}, .blank = {}}};
  for (CylindricalGear& gear : pair.gears) gear.blank.face_width = 12e-3;
  pair.pairs = {{.first = 0, .second = 1}};
  const CylindricalGeometry g = derive(pair);
  for (int i : {0, 1}) {
    const mesh::Mesh mesh = cylindrical_mesh(pair, g, i, cylindrical_counts(pair, g, i, Size::tiny, 2));
    expect_good_mesh(mesh);
    expect_flank(mesh, "tooth_01_left", g.gear[i], 0, 1);
  }
}

// m, of a point of a plane from a polygon.
double distance(const std::vector<Eigen::Vector2d>& line, const Eigen::Vector2d& x) {
  double least = 1;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d d = line[i + 1] - line[i];
    const double t = std::clamp((x - line[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (line[i] + t * d - x).norm());
  }
  return least;
}

// The fillet as a polygon, which is off the curve by 1e-9 m.
std::vector<Eigen::Vector2d> fillet_of(const Profile& profile) {
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i <= 1000; ++i) line.push_back(profile.fillet(i / 1000.0));
  return line;
}

// Plane coordinates: across the tooth, from its axis, and the radius.
TEST(SecondOrderMesh, has_its_root_nodes_on_the_fillets) {
  const Design d;
  const Geometry g = derive(d);
  const auto worm_line = fillet_of(worm_profile(d, g));
  const mesh::Mesh worm = quadratic_worm(d, Size::small);
  for (int node : worm.node_sets.at("root")) {
    const Eigen::Vector3d x = worm.X.col(node);
    const double z = x[2] - g.worm.p * (std::atan2(x[1], x[0]) - g.worm.theta_1);
    ASSERT_LT(distance(worm_line, {std::abs(std::remainder(z, g.p_x)), x.head<2>().norm()}), 1e-8);
  }
  const auto wheel_line = fillet_of(generated_profile(wheel_rack(d, g), g.wheel, d.rim_diameter / 2));
  const mesh::Mesh wheel = quadratic_wheel(d, Size::small);
  for (int node : wheel.node_sets.at("root")) {
    const Eigen::Vector3d x = wheel.X.col(node);
    const double theta = std::remainder(std::atan2(x[1], x[0]) - x[2] / g.wheel.p - g.wheel.theta_1,
                                        2 * std::numbers::pi / g.wheel.z),
                 r = x.head<2>().norm();
    ASSERT_LT(distance(wheel_line, {r * std::sin(std::abs(theta)), r * std::cos(theta)}), 1e-8);
  }
}

// A set holds the midside nodes of its edges: the set of one root has two strips of them along the face.
TEST(SecondOrderMesh, has_its_midside_nodes_in_the_sets) {
  WheelCounts n = wheel_counts(Size::small, 2);
  n.order = 1;
  const mesh::Mesh linear = wheel_mesh({}, n), mesh = quadratic_wheel({}, Size::small);
  const int layers = n.web_layers + 2 * n.face_layers;
  const int strips = 2 * (n.fillet + 1);  // edges from plane to plane, up the fillets and on their other half
  const int columns = static_cast<int>(linear.node_sets.at("root_01").size()) / (layers + 1);
  EXPECT_EQ(columns, strips + 2);
  EXPECT_EQ(mesh.node_sets.at("root_01").size(),
            linear.node_sets.at("root_01").size() + columns * layers + strips * (layers + 1));
  for (int node : mesh.node_sets.at("bore"))
    EXPECT_NEAR(mesh.X.col(node).head<2>().norm(), Design{}.wheel_bore / 2, 1e-12);
  EXPECT_EQ(mesh.face_sets.at("flanks").size(), 5 * linear.face_sets.at("flanks").size());
}

TEST(SecondOrderMesh, repeats_from_tooth_to_tooth) {
  const mesh::Mesh mesh = quadratic_wheel({});
  const int n = mesh.n_nodes() / 41;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const int sector = node / n;
    const double turned = 2 * std::numbers::pi / 41 * sector;
    const Eigen::Vector3d x = Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()) * mesh.X.col(node % n);
    ASSERT_LT((x - mesh.X.col(node)).norm(), 1e-12);
  }
  const std::vector<int> cells(static_cast<std::size_t>(mesh.cells.size()), 0);
  const std::vector<bool> nodes(static_cast<std::size_t>(mesh.n_nodes()), false);
  const auto search = mesh::find_repetition(mesh, {cells, nodes});
  ASSERT_TRUE(search.found) << search.reason;
  EXPECT_EQ(search.found->turn.n_sectors, 41);
}

TEST(SecondOrderMesh, refuses_other_orders) {
  EXPECT_THROW(worm_mesh({}, {.order = 3}), Error);
  EXPECT_THROW(wheel_mesh({}, {.order = 0}), Error);
}

}  // namespace
}  // namespace elastogear::gear::second_order_test
