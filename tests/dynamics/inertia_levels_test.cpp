// What inertia keeps of the deformation, where it matters that the mass matrix stays positive definite:
// slender bodies on a hinge, whose modes nearly carry all of their inertia.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <iostream>

#include "../figures.h"
#include "../message_of.h"
#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::inertia_levels_test {
using namespace dynamics;
using body::InertiaLevel;
using Eigen::Vector3d;
using test::message_of;

namespace {

// Held at its left end x = 0, with the marker TIP on the other one (3.16).
std::shared_ptr<const model::ElasticBody> bar(const Vector3d& size, const model::Material& material,
                                              int n_modes) {
  test::BoxSpec spec{
      .corner = {0, -size[1] / 2, -size[2] / 2}, .size = size, .cells = {10, 2, 2}, .material = material};
  spec.held = [](const Vector3d& X, int) { return X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal, n_modes));
  const auto& Phi = std::get<model::DenseRows>(body->surface.Phi);
  Eigen::Matrix3Xd mean = Eigen::Matrix3Xd::Zero(3, n_modes), moment = mean;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  int n = 0;
  for (Eigen::Index i = 0; i < body->surface.X.cols(); ++i) {
    const Vector3d r = body->surface.X.col(i) - Vector3d(size[0], 0, 0);
    if (std::abs(r.x()) > 1e-9) continue;
    ++n;
    mean += Phi.middleRows<3>(3 * i);
    for (int k = 0; k < n_modes; ++k) moment.col(k) += r.cross(Vector3d(Phi.col(k).segment<3>(3 * i)));
    spread += r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose();
  }
  model::DenseRows rows(6, n_modes);
  rows << mean / n, spread.inverse() * moment;
  body->markers.push_back({"TIP", {size[0], 0, 0}, true, rows});
  return body;
}

struct Way {
  std::vector<Vector3d> tip;  // m, in the body frame, beside where it is undeformed
  double balance = 0, energy = 0;
  RunSummary summary;
};

Way way(System system, double length, double dt, double end) {
  Way way;
  way.summary = simulate(system, {.dt = dt, .end_time = end}, [&](const model::Snapshot& now) {
    const model::BodyState& b = now.bodies[0];
    way.tip.push_back(b.R_WB.transpose() * (now.sensors[0].position - b.r_WB) - Vector3d(length, 0, 0));
    way.balance = std::max(way.balance, std::abs(now.energy.balance));
    way.energy = std::max(way.energy, now.energy.kinetic + now.energy.elastic);
  });
  return way;
}

// A steel bar of 1 m x 50 mm turns at 1 rad/s; its tip is pressed along it by 50 kN (20 MPa) within 2 ms.
System pressed_bar(InertiaLevel level) {
  MarkerSetups markers;
  markers.loads.push_back({.name = "push",
                           .marker = {"bar", "TIP"},
                           .force = {-5e4, 0, 0},
                           .follows = true,
                           .signal = ramp_signal(1, 2e-3)});
  markers.sensors.push_back({"tip", {"bar", "TIP"}});
  return System({{.name = "bar",
                  .body = bar({1, 0.05, 0.05}, {2.1e11, 0.3, 7850}, 20),
                  .joint = {.type = body::JointType::revolute},
                  .rotation = {.s_dot_0 = 1}}},
                {}, {.inertia = level}, markers);
}

// A beam of rubber, 0.3 m x 30 mm, falls from the horizontal about a hinge at its end.
System swinging_rubber(InertiaLevel level, int n_modes) {
  MarkerSetups markers;
  markers.sensors.push_back({"tip", {"beam", "TIP"}});
  return System({{.name = "beam",
                  .body = bar({0.3, 0.03, 0.03}, {5e6, 0.45, 1100}, n_modes),
                  .joint = {.type = body::JointType::revolute}}},
                {}, {.inertia = level, .gravity = {0, -9.81, 0}}, markers);
}

double difference(const Way& a, const Way& b) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.tip.size(), b.tip.size()); ++i)
    largest = std::max(largest, (a.tip[i] - b.tip[i]).norm());
  return largest;
}

double largest(const Way& a) {
  double largest = 0;
  for (const Vector3d& x : a.tip) largest = std::max(largest, x.norm());
  return largest;
}

TEST(InertiaLevels, default_follows_level_full_in_a_bar_under_pressure) {
  const Way right = way(pressed_bar(InertiaLevel::full), 1, 1e-5, 5e-3),
            found = way(pressed_bar(Environment{}.inertia), 1, 1e-5, 5e-3);
  std::cout << "pressed bar: tip " << largest(found) << " m, off level full by " << difference(found, right)
            << " m; balance " << found.balance << " of " << found.energy << " J\n";
  EXPECT_NEAR(largest(right), 9.7e-5, 0.05e-5);  // F L / E A = 9.52e-5 m, and what the ramp leaves to swing
  test::figure({"bar pressed while it turns", "shortening at level `affine`", "%"},
               difference(found, right) / largest(right), 0.001);
  EXPECT_LT(found.balance, 1e-3 * found.energy);
}

TEST(InertiaLevels, linear_says_where_it_loses_its_mass_matrix) {
  std::vector<double> times;
  System system = pressed_bar(InertiaLevel::linear);
  const std::string message = message_of([&] {
    simulate(system, {.dt = 1e-5, .end_time = 5e-3},
             [&](const model::Snapshot& now) { times.push_back(now.time); });
  });
  EXPECT_NE(message.find("body 'bar' at t = "), std::string::npos) << message;
  EXPECT_NE(message.find("-inertia affine"), std::string::npos) << message;
  ASSERT_GT(times.size(), 1u);
  EXPECT_LT(times.back(), 2e-3);
}

TEST(InertiaLevels, default_follows_level_full_in_a_beam_of_rubber_whatever_the_modes) {
  const auto fall = [](InertiaLevel level, int n_modes) {
    return way(swinging_rubber(level, n_modes), 0.3, 1e-3, 0.5);
  };
  for (int n_modes : {4, 10, 15, 20, 40}) {
    const Way right = fall(InertiaLevel::full, n_modes), found = fall(Environment{}.inertia, n_modes);
    std::cout << n_modes << " modes: tip " << largest(found) << " m, off level full by "
              << difference(found, right) << " m; balance " << found.balance << " of " << found.energy
              << " J\n";
    EXPECT_NEAR(largest(right), 0.0037, 0.0001) << n_modes;
    EXPECT_NEAR(largest(found), largest(right), 0.005 * largest(right)) << n_modes;
    // After 0.5 s the bending vibration is off by what is not affine in it, whatever the modes.
    EXPECT_LT(difference(found, right), 0.04 * largest(right)) << n_modes;
    EXPECT_LT(found.balance, 1e-4 * found.energy) << n_modes;
  }
}

}  // namespace
}  // namespace elastogear::inertia_levels_test
