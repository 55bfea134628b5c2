#include "elastogear/gear/wheel.h"

#include <numbers>

#include "elastogear/base/error.h"
#include "mesh_checks.h"

namespace elastogear::gear::wheel_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::string two_digits(int i) { return (i < 9 ? "0" : "") + std::to_string(i + 1); }

TEST(Wheel, flank_nodes_lie_on_the_exact_flanks_from_fillet_to_tip) {
  const Geometry g = derive(Design{});
  for (Size size : {Size::tiny, Size::small, Size::paper}) {
    const mesh::Mesh mesh = wheel_mesh({}, wheel_counts(size));
    for (int i : {0, 17, 40}) {
      expect_flank(mesh, "tooth_" + two_digits(i) + "_left", g.wheel, i, 1);
      expect_flank(mesh, "tooth_" + two_digits(i) + "_right", g.wheel, i, -1);
    }
  }
}

TEST(Wheel, repeats_exactly_from_tooth_to_tooth) {
  const mesh::Mesh mesh = wheel_mesh({}, wheel_counts(Size::small));
  const int n = mesh.n_nodes() / 41, cells = mesh.cells.size() / 41;
  ASSERT_EQ(n * 41, mesh.n_nodes());
  for (int tooth = 1; tooth < 41; ++tooth) {
    const double c = std::cos(2 * kPi * tooth / 41), s = std::sin(2 * kPi * tooth / 41);
    Eigen::Matrix3d R;
    R << c, -s, 0, s, c, 0, 0, 0, 1;
    const double difference =
        (mesh.X.middleCols(tooth * n, n) - R * mesh.X.leftCols(n)).cwiseAbs().maxCoeff();
    EXPECT_LT(difference, 1e-12 * 0.045);  // relative to the tip radius
    for (int i = 0; i < cells; ++i)
      for (int a = 0; a < 8; ++a)
        ASSERT_EQ(mesh.cells[tooth * cells + i][a], (mesh.cells[i][a] + tooth * n) % mesh.n_nodes());
  }
}

TEST(Wheel, bore_set_is_the_whole_bore) {
  const Design d;
  const mesh::Mesh mesh = wheel_mesh(d, {});
  std::size_t on_bore = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    on_bore += mesh.X.col(i).head<2>().norm() < d.wheel_bore / 2 + 1e-9;
  EXPECT_EQ(mesh::node_set(mesh, "bore").size(), on_bore);
}

TEST(Wheel, rim_begins_at_the_rim_radius_and_body_is_the_rest) {
  const Design d;
  const mesh::Mesh mesh = wheel_mesh(d, {});
  const auto& rim = mesh::cell_set(mesh, "rim");
  const auto& body = mesh::cell_set(mesh, "body");
  EXPECT_EQ(rim.size() + body.size(), static_cast<std::size_t>(mesh.cells.size()));
  for (int cell : rim)
    for (int node : mesh.cells[cell])
      EXPECT_GE(mesh.X.col(node).head<2>().norm(), d.rim_diameter / 2 - 1e-12);
  for (int cell : body)
    for (int node : mesh.cells[cell])
      EXPECT_LE(mesh.X.col(node).head<2>().norm(), d.rim_diameter / 2 + 1e-12);
}

TEST(Wheel, root_sets_lie_between_root_and_form_radius_on_their_own_tooth) {
  const Geometry g = derive(Design{});
  const mesh::Mesh mesh = wheel_mesh({}, wheel_counts(Size::small));
  std::size_t sum = 0;
  for (int tooth = 0; tooth < 41; ++tooth) {
    const auto& nodes = mesh::node_set(mesh, "root_" + two_digits(tooth));
    sum += nodes.size();
    for (int node : nodes) {
      const Eigen::Vector3d x = mesh.X.col(node);
      const double r = x.head<2>().norm();
      EXPECT_GT(r, g.wheel.r_f - 1e-12);
      EXPECT_LT(r, g.wheel.r_form + 1e-12);
      const double turned = std::atan2(x[1], x[0]) - x[2] / g.wheel.p - tooth_angle(g.wheel, tooth);
      EXPECT_LE(std::abs(std::remainder(turned, 2 * kPi)), kPi / 41 + 1e-12);
    }
  }
  EXPECT_EQ(mesh::node_set(mesh, "root").size(), sum);
}

// The envelope of the rack's rounded tip, found without the rolling condition: no rack position cuts below
// it.
TEST(Wheel, fillet_is_the_envelope_of_the_rack_tip) {
  const Design d;
  const Geometry g = derive(d);
  const mesh::Mesh mesh = wheel_mesh(d, wheel_counts(Size::small));
  const double h_c = -d.dedendum + d.wheel_rack_tip;
  const double u_c = g.s_n / 2 + (d.wheel_rack_tip - h_c * std::sin(d.alpha_n)) / std::cos(d.alpha_n);
  for (int node : mesh::node_set(mesh, "root_01")) {
    const Eigen::Vector3d x = mesh.X.col(node);
    if (std::abs(x[2]) > 1e-9 || x[0] > 0) continue;  // plane z = 0, where tooth 1 stands on +Y
    const double r = x.head<2>().norm(), angle = std::atan2(-x[0], x[1]);
    double nearest = 1;
    for (int i = -20000; i <= 20000; ++i) {
      const double s = i * 5e-7;  // m, rack shift
      const double X = r * std::sin(angle + s / g.wheel.r), Y = r * std::cos(angle + s / g.wheel.r);
      const double u = (X - s) * std::cos(g.gamma), h = Y - g.wheel.r;  // normal section of the rack
      nearest = std::min(nearest, std::hypot(u - u_c, h - h_c) - d.wheel_rack_tip);
    }
    EXPECT_NEAR(nearest, 0, 1e-9);  // quadratic in the distance to the nearest sample
  }
}

TEST(Wheel, volume_of_hub_web_and_ring_is_that_of_the_polygonal_rings) {
  const Design d;
  const mesh::Mesh mesh = wheel_mesh(d, wheel_counts(Size::small));
  const auto disc = [](double diameter) { return kPi / 4 * diameter * diameter; };
  const double V = (disc(d.hub_diameter) - disc(d.wheel_bore)) * d.hub_width +
                   (disc(d.web_diameter) - disc(d.hub_diameter)) * d.web_width +
                   (disc(d.rim_diameter) - disc(d.web_diameter)) * d.face_width;
  double body = 0;
  for (int cell : mesh::cell_set(mesh, "body")) body += mesh::volume(mesh, cell);
  EXPECT_NEAR(body / V, 1, 1e-3);
}

TEST(Wheel, volume_converges) {
  const double tiny = volume(wheel_mesh({}, wheel_counts(Size::tiny)));
  const double small = volume(wheel_mesh({}, wheel_counts(Size::small)));
  const double paper = volume(wheel_mesh({}, wheel_counts(Size::paper)));
  EXPECT_NEAR(tiny / paper, 1, 1e-3);
  EXPECT_NEAR(small / paper, 1, 2e-4);
}

TEST(WheelCounts, that_do_not_fit_are_refused) {
  EXPECT_THROW(wheel_mesh({}, {.tooth = 3}), Error);
  EXPECT_THROW(wheel_mesh({}, {.web_layers = 0}), Error);
  EXPECT_THROW(wheel_mesh({}, {.rim = -2}), Error);
  EXPECT_THROW(wheel_mesh({}, {.hub = 2000000000}), Error);
}

}  // namespace
}  // namespace elastogear::gear::wheel_test
