#include "elastogear/gear/worm.h"

#include <numbers>

#include "elastogear/base/error.h"
#include "mesh_checks.h"

namespace elastogear::gear::worm_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Worm, flank_nodes_lie_on_the_exact_flanks_from_fillet_to_tip) {
  const Geometry g = derive(Design{});
  for (Size size : {Size::tiny, Size::small, Size::paper}) {
    const mesh::Mesh mesh = worm_mesh({}, worm_counts(size));
    for (int i : {0, 1}) {
      const std::string name = "thread_" + std::to_string(i + 1);
      expect_flank(mesh, name + "_left", g.worm, i, 1);
      expect_flank(mesh, name + "_right", g.worm, i, -1);
    }
  }
}

TEST(Worm, flank_sets_add_up) {
  const mesh::Mesh mesh = worm_mesh({}, {});
  const auto size = [&](const char* name) { return mesh::face_set(mesh, name).size(); };
  EXPECT_EQ(size("left"), size("thread_1_left") + size("thread_2_left"));
  EXPECT_EQ(size("right"), size("thread_1_right") + size("thread_2_right"));
  EXPECT_EQ(size("flanks"), size("left") + size("right"));
  EXPECT_EQ(size("left"), size("right"));
  EXPECT_EQ(mesh::cell_set(mesh, "body").size(), static_cast<std::size_t>(mesh.cells.size()));
}

TEST(Worm, threads_end_at_their_length_to_half_a_section) {
  const Design d;
  const WormCounts n;
  const mesh::Mesh mesh = worm_mesh(d, n);
  const Geometry g = derive(d);
  double end = 0;  // of the tip's middle
  for (const mesh::Face& face : mesh::face_set(mesh, "left"))
    for (int node : face)
      if (mesh.X.col(node).head<2>().norm() > g.worm.r_a - 1e-9)
        end = std::max(end, mesh.X(2, node) + g.worm.p * psi(g.worm, g.worm.r_a));
  EXPECT_NEAR(end, d.thread_length / 2, kPi * g.worm.p / n.turn);
}

TEST(Worm, seats_are_whole_cylinders) {
  const Design d;
  const mesh::Mesh mesh = worm_mesh(d, worm_counts(Size::small));
  const auto check = [&](const char* name, double from, double to, double diameter) {
    double low = 1, high = -1;
    for (int node : mesh::node_set(mesh, name)) {
      EXPECT_NEAR(mesh.X.col(node).head<2>().norm(), diameter / 2, 1e-12);
      low = std::min(low, mesh.X(2, node)), high = std::max(high, mesh.X(2, node));
    }
    EXPECT_NEAR(low, from, 1e-12);
    EXPECT_NEAR(high, to, 1e-12);
  };
  check("seat_1", d.seat_1_begin, d.seat_1_end, d.seat_1_diameter);
  check("seat_2", d.seat_2_begin, d.seat_2_end, d.seat_2_diameter);
  EXPECT_EQ(mesh::node_set(mesh, "seats").size(),
            mesh::node_set(mesh, "seat_1").size() + mesh::node_set(mesh, "seat_2").size());
}

TEST(Worm, root_nodes_lie_on_the_fillet_arc_of_the_axial_section) {
  const Design d;
  const Geometry g = derive(d);
  const mesh::Mesh mesh = worm_mesh(d, worm_counts(Size::small));
  const double rho = d.worm_fillet, centre_r = g.worm.r_f + rho;
  // The arc touches the flank at r_form, so its centre follows from that point.
  const double centre_z =
      g.worm.p * psi(g.worm, g.worm.r_form) + std::sqrt(rho * rho - std::pow(centre_r - g.worm.r_form, 2));
  for (int thread : {0, 1})
    for (int node : mesh::node_set(mesh, "root_" + std::to_string(thread + 1))) {
      const Eigen::Vector3d x = mesh.X.col(node);
      const double turned = std::atan2(x[1], x[0]) - x[2] / g.worm.p - tooth_angle(g.worm, thread);
      const double z = std::abs(g.worm.p * std::remainder(turned, 2 * kPi));
      EXPECT_NEAR(std::hypot(z - centre_z, x.head<2>().norm() - centre_r), rho, 1e-12);
    }
  EXPECT_EQ(mesh::node_set(mesh, "root").size(),
            mesh::node_set(mesh, "root_1").size() + mesh::node_set(mesh, "root_2").size());
}

// Area moment about the axis of the thread's axial section above the root, by the trapezoidal rule: flank and
// fillet.
double thread_moment(const Design& d, const Geometry& g) {
  const Toothing& t = g.worm;
  const double rho = d.worm_fillet, centre = t.r_f + rho;
  const double x = t.p * psi(t, t.r_form) + std::sqrt(rho * rho - std::pow(centre - t.r_form, 2));
  const auto width = [&](double r) {
    return r > t.r_form ? t.p * psi(t, r) : x - std::sqrt(std::max(0.0, rho * rho - std::pow(centre - r, 2)));
  };
  constexpr int kSteps = 20000;
  const double h = (t.r_a - t.r_f) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = t.r_f + (i + 0.5) * h;
    sum += 2 * width(r) * r * h;
  }
  return sum;
}

double cone(double r_1, double r_2, double length) {
  return kPi / 3 * length * (r_1 * r_1 + r_1 * r_2 + r_2 * r_2);
}

TEST(Worm, volume_converges_to_the_exact_one) {
  const Design d;
  const Geometry g = derive(d);
  const double root = g.worm.r_f, c = d.shoulder;
  const double seat_1 = d.seat_1_diameter / 2, seat_2 = d.seat_2_diameter / 2;
  const double stub_1 = d.shaft_1_diameter / 2, stub_2 = d.shaft_2_diameter / 2;
  double V = kPi * root * root * (d.seat_2_begin - d.seat_1_end - 2 * c);
  V += cone(root, seat_1, c) + kPi * seat_1 * seat_1 * (d.seat_1_end - d.seat_1_begin) +
       cone(seat_1, stub_1, c);
  V += cone(root, seat_2, c) + kPi * seat_2 * seat_2 * (d.seat_2_end - d.seat_2_begin) +
       cone(seat_2, stub_2, c);
  V += kPi * stub_1 * stub_1 * (d.seat_1_begin - c - d.shaft_1_end);
  V += kPi * stub_2 * stub_2 * (d.shaft_2_end - d.seat_2_end - c);
  V -= kPi / 4 * d.worm_bore * d.worm_bore * (d.shaft_2_end - d.shaft_1_end);
  // Guldin: each thread turns by thread_length/p.
  V += d.z1 * thread_moment(d, g) * d.thread_length / g.worm.p;
  const auto error = [&](Size size) { return std::abs(volume(worm_mesh(d, worm_counts(size))) / V - 1); };
  EXPECT_LT(error(Size::tiny), 0.03);
  EXPECT_LT(error(Size::small), 0.015);
  EXPECT_LT(error(Size::paper), 0.006);
}

TEST(WormCounts, that_do_not_fit_are_refused) {
  EXPECT_THROW(worm_mesh({}, {.tooth = 3}), Error);
  EXPECT_THROW(worm_mesh({}, {.space = 0}), Error);
  EXPECT_THROW(worm_mesh({}, {.flank = -1}), Error);
  EXPECT_THROW(worm_mesh({}, {.turn = 8}), Error);
  EXPECT_THROW(worm_mesh({}, {.turn = 25}), Error);
  EXPECT_THROW(worm_mesh({}, {.ring = 2000000000}), Error);
  EXPECT_THROW(worm_mesh({}, {.turn = 2000000000}), Error);
  EXPECT_THROW(worm_mesh({}, {.flank = 1000, .ring = 1000, .turn = 800}), Error);
}

}  // namespace
}  // namespace elastogear::gear::worm_test
