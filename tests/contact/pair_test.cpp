#include "elastogear/contact/pair.h"

#include <gtest/gtest.h>

#include "contact/projection/projection.h"
#include "contact/settings.h"
#include "elastogear/base/error.h"
#include "surfaces.h"

namespace elastogear::contact::pair_test {
namespace {

using test::at;
using test::Random;
using test::total_force;
constexpr double roundoff = 1e-12;

Settings settings(double stiffness, double depth) {
  Settings s;
  s.surface = ContactSurface::facets;
  s.stiffness = stiffness;
  s.depth = depth;
  return s;
}

model::Surface wavy(int n, double height, double phase) {
  return test::grid(n, n, [=](double u, double v) {
    return Eigen::Vector3d(u, v, height * std::sin(9 * u + phase) * std::cos(7 * v - phase));
  });
}

SurfaceState shaken(const model::Surface& s, Random& random, double size, const Eigen::Vector3d& r,
                    const Eigen::Vector3d& psi) {
  SurfaceState state = at(s, r, psi);
  for (auto x : state.x_B.colwise()) x += random.vector(size);
  return state;
}

void expect_equal(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].slave_node, b[i].slave_node);
    EXPECT_EQ(a[i].face, b[i].face);
    EXPECT_EQ(a[i].g_n, b[i].g_n);
    EXPECT_EQ(a[i].f, b[i].f);
    EXPECT_EQ(a[i].W, b[i].W);
  }
}

// Nodes touch only on the left half of the master, whose body has static responses there, or on the right.
TEST(Pair, without_a_static_response_the_compliance_of_the_penalty_is_left) {
  const model::Surface master = test::plane(4, 1), punch = test::flipped(test::plane(1, 1, 0.2, 0.2));
  Settings s = settings(1e3, 0.1);
  s.law = ContactLaw::unilateral;
  std::vector<bool> master_responds(10);
  for (int node : {0, 1, 5, 6}) master_responds[node] = true;
  const std::vector<bool> none(4, false), all(4, true);
  const auto compliances = [&](double x, const std::vector<bool>& punch_responds) {
    Pair pair(punch, master, s, {}, {}, {punch_responds, master_responds});
    std::vector<double> c;
    for (const ContactPoint& point : pair.detect(at(punch, {x, 0.4, -1e-6}), at(master)))
      c.push_back(point.c);
    EXPECT_EQ(c.size(), 4u);
    return c;
  };
  const double soft = 1 / (1e3 * 0.01);  // of 0.01 m^2 a node
  for (double c : compliances(0.02, none)) EXPECT_NEAR(c, 1e-4 * soft, roundoff);
  for (double c : compliances(0.72, none)) EXPECT_NEAR(c, soft, roundoff);
  for (double c : compliances(0.72, all)) EXPECT_NEAR(c, 1e-4 * soft, roundoff);
}

TEST(Pair, law_by_default_is_unilateral_unless_something_asks_for_a_penalty) {
  const Settings none;
  EXPECT_EQ(chosen_law(none, true), ContactLaw::unilateral);
  EXPECT_EQ(chosen_law(none, false), ContactLaw::penalty);
  Settings asked;
  asked.law = ContactLaw::unilateral;
  EXPECT_EQ(chosen_law(asked, false), ContactLaw::augmented);
  for (double Settings::*given : {&Settings::stiffness, &Settings::damping, &Settings::hysteresis}) {
    Settings s;
    s.*given = 1;
    EXPECT_EQ(chosen_law(s, true), ContactLaw::penalty);
    s.law = ContactLaw::unilateral;
    EXPECT_EQ(chosen_law(s, true), ContactLaw::unilateral);
  }
}

TEST(Pair, points_by_default_are_faces_where_the_slave_is_of_second_order) {
  model::Surface linear, second;
  second.side.setZero(8, 1);
  const Settings none;
  EXPECT_EQ(chosen_points(none, linear), SlavePoints::nodes);
  EXPECT_EQ(chosen_points(none, second), SlavePoints::faces);
  Settings s;
  s.two_pass = true;
  EXPECT_EQ(chosen_points(s, second), SlavePoints::nodes);
  s = {};
  s.points = SlavePoints::nodes;
  EXPECT_EQ(chosen_points(s, second), SlavePoints::nodes);
}

TEST(Pair, contacts_are_identical_for_refit_and_realign_and_all_k) {
  Random random(1);
  const model::Surface a = test::flipped(wavy(17, 0.02, 1)), b = wavy(14, 0.02, 0);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::Vector3d psi = random.vector(2), tilt = random.vector(0.02);
    const Eigen::Matrix3d R = test::rotation(psi);
    SurfaceState state_b = shaken(b, random, 2e-3, random.vector(3), psi);
    SurfaceState state_a =
        shaken(a, random, 2e-3, state_b.r_WB + R * Eigen::Vector3d(0.01, 0.02, -0.005), psi);
    state_a.R_WB = R * test::rotation(tilt);
    std::vector<ContactPoint> first;
    for (Update update : {Update::refit, Update::realign})
      for (int k : {6, 14, 18, 24, 26}) {
        Settings s = settings(1, 0.05);
        s.k = k;
        s.update = update;
        s.two_pass = true;
        const auto contacts = Pair(a, b, s).detect(state_a, state_b);
        EXPECT_GT(contacts.size(), 100u);
        if (first.empty()) first = contacts;
        expect_equal(contacts, first);
      }
  }
}

TEST(Pair, contacts_do_not_depend_on_what_was_searched_before) {
  Random random(3);
  const model::Surface a = test::flipped(wavy(12, 0.02, 1)), b = wavy(12, 0.02, 0);
  Pair pair(a, b, settings(1, 0.05));
  for (int trial = 0; trial < 10; ++trial) {
    const SurfaceState state_a = shaken(a, random, 1e-3, random.vector(0.02), random.vector(0.02));
    expect_equal(pair.detect(state_a, at(b)), Pair(a, b, settings(1, 0.05)).detect(state_a, at(b)));
  }
}

TEST(Pair, forces_and_moments_on_both_sides_balance) {
  Random random(4);
  const model::Surface a = test::flipped(wavy(15, 0.03, 1)), b = wavy(11, 0.03, 0);
  Settings s = settings(1, 0.05);
  s.two_pass = true;
  const SurfaceState state[2] = {shaken(a, random, 1e-3, {1, 2, 3}, {0.5, 0.4, 0.3}),
                                 shaken(b, random, 1e-3, {1, 2, 3}, {0.5, 0.4, 0.3})};
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double size = 0;
  const auto apply = [&](int side, int node, const Eigen::Vector3d& f) {
    const Eigen::Vector3d x = state[side].R_WB * state[side].x_B.col(node) + state[side].r_WB;
    force += f;
    moment += x.cross(f);
    size += f.norm();
  };
  for (const ContactPoint& c : Pair(a, b, s).detect(state[0], state[1])) {
    apply(c.slave_side, c.slave_node, c.F.col(0));
    for (int i = 0; i < 4; ++i) apply(1 - c.slave_side, c.master_nodes[i], c.F.col(1 + i));
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(force.norm(), 1e-14 * size);
  EXPECT_LT(moment.norm(), 1e-13 * size);
}

// All contact forces derive from the contact energy: over faces, ridges, valleys and free boundaries alike.
TEST(Pair, forces_are_the_slope_of_the_energy) {
  Random random(5);
  const model::Surface a = test::flipped(wavy(9, 0.05, 1)), b = wavy(8, 0.05, 0);
  Settings s = settings(1, 0.2);
  s.extension = 0.1;
  Pair pair(a, b, s);
  const SurfaceState state_a = at(a, {0.001, 0.002, 0.01}), state_b = at(b);
  const auto energy = [&](const SurfaceState& x, const SurfaceState& y) {
    double sum = 0;
    for (const ContactPoint& c : pair.detect(x, y)) sum += c.energy;
    return sum;
  };
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Matrix3Xd d_a(3, a.X.cols()), d_b(3, b.X.cols());
    for (auto d : d_a.colwise()) d = random.vector(1);
    for (auto d : d_b.colwise()) d = random.vector(1);
    double slope = 0;
    for (const ContactPoint& c : pair.detect(state_a, state_b)) {
      slope -= c.F.col(0).dot(d_a.col(c.slave_node));
      for (int i = 0; i < 4; ++i) slope -= c.F.col(1 + i).dot(d_b.col(c.master_nodes[i]));
    }
    const double h = 1e-7;
    const auto moved = [&](double t) {
      SurfaceState x = state_a, y = state_b;
      x.x_B += t * d_a, y.x_B += t * d_b;
      return energy(x, y);
    };
    EXPECT_NEAR((moved(h) - moved(-h)) / (2 * h), slope, 1e-5 * std::abs(slope) + 1e-9);
  }
}

TEST(Pair, forces_turn_with_the_bodies) {
  const model::Surface a = test::flipped(wavy(9, 0.02, 1)), b = wavy(8, 0.02, 0);
  const auto straight = Pair(a, b, settings(1, 0.1)).detect(at(a), at(b));
  const Eigen::Vector3d psi(1, 2, 3), r(4, 5, 6);
  const auto turned = Pair(a, b, settings(1, 0.1)).detect(at(a, r, psi), at(b, r, psi));
  ASSERT_EQ(straight.size(), turned.size());
  const Eigen::Matrix3d R = test::rotation(psi);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    EXPECT_NEAR((R * straight[i].f - turned[i].f).norm(), 0, roundoff);
    EXPECT_NEAR((R * straight[i].n - turned[i].n).norm(), 0, 1e-9);
    EXPECT_NEAR((R * straight[i].W.middleRows<3>(6) - turned[i].W.middleRows<3>(6)).norm(), 0, 1e-8);
  }
}

TEST(Pair, penalty_per_area_gives_the_same_force_on_refined_slaves) {
  const model::Surface master = test::plane(5, 5, 2, 2);
  const double c = 1e6, depth = 1e-3;
  for (int n : {1, 4, 16}) {
    const model::Surface quads = test::flipped(test::plane(n, n)),
                         slaves[] = {quads, test::triangulated(quads)};
    for (const model::Surface& slave : slaves) {
      const auto contacts =
          Pair(slave, master, settings(c, 0.1)).detect(at(slave, {0.31, 0.52, -depth}), at(master));
      EXPECT_NEAR(total_force(contacts).z(), c * depth, roundoff * c);
      Settings per_node = settings(c, 0.1);
      per_node.penalty = Penalty::per_node;
      const auto others = Pair(slave, master, per_node).detect(at(slave, {0.31, 0.52, -depth}), at(master));
      EXPECT_NEAR(total_force(others).z(), c * depth * (n + 1) * (n + 1), roundoff * c * n * n);
    }
  }
}

TEST(Pair, offset_is_added_to_every_gap) {
  constexpr double c = 1e6;
  const model::Surface master = test::plane(5, 5, 2, 2), punch = test::flipped(test::plane(2, 2));
  for (double gap : {-2e-3, -5e-4, 5e-4})
    for (double offset : {-1e-3, 0., 1e-3}) {
      Settings s = settings(c, 0.1);
      s.offset = offset;
      const auto contacts = Pair(punch, master, s).detect(at(punch, {0.3, 0.4, gap}), at(master));
      EXPECT_EQ(contacts.size(), gap + offset < 0 ? 9u : 0u) << gap << " " << offset;
      EXPECT_NEAR(total_force(contacts).z(), c * std::max(0., -gap - offset), roundoff * c);
    }
}

// A punch flush with the master: every node lies on an edge or a free boundary.
TEST(Pair, flat_punch_on_a_conforming_mesh_has_every_node_in_contact) {
  Random random(6);
  const model::Surface master = test::plane(6, 6), punch = test::flipped(master);
  for (double lateral : {0.0, 1e-12, 1e-4}) {
    Settings s = settings(1, 0.1);
    s.two_pass = true;
    const auto contacts =
        Pair(punch, master, s).detect(shaken(punch, random, lateral, {0, 0, -0.01}, {0, 0, 0}), at(master));
    EXPECT_EQ(contacts.size(), 2u * 49u);
    Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
    for (const ContactPoint& c : contacts) on_a += c.slave_side == 0 ? c.f : Eigen::Vector3d(-c.f);
    EXPECT_NEAR(on_a.z(), 0.01, 2 * lateral + roundoff);
  }
}

TEST(Pair, prolonged_open_ends_are_in_reach_of_the_coarse_search) {
  const model::Surface master = test::plane(4, 4), slave = test::flipped(test::plane(1, 1, 0.1, 0.1));
  for (Update update : {Update::refit, Update::realign}) {
    Settings s = settings(1, 1e-3);  // far less than the prolongation of 0.025
    s.extension = 0.1;
    s.update = update;
    EXPECT_EQ(Pair(slave, master, s).detect(at(slave, {1.02, 0.5, -5e-4}), at(master)).size(), 2u);
    EXPECT_EQ(Pair(slave, master, s).detect(at(slave, {1.03, 0.5, -5e-4}), at(master)).size(), 0u);
  }
}

// Elastic foundation: the force on a sphere pressed into a plane is c pi R depth^2.
TEST(Pair, sphere_on_a_plane_has_the_force_of_an_elastic_foundation) {
  const model::Surface sphere = test::cube(40, test::onto_sphere), plane = test::plane(9, 9, 2, 2);
  const double c = 7, depth = 0.1;
  const auto contacts =
      Pair(sphere, plane, settings(c, 0.2)).detect(at(sphere, {1, 1, 1 - depth}), at(plane));
  const double discretisation = 0.01;
  EXPECT_NEAR(total_force(contacts).z() / (c * test::pi * depth * depth), 1, discretisation);
}

TEST(Pair, two_passes_give_each_body_half_of_the_force_as_slave) {
  const model::Surface b = test::plane(5, 5, 3, 3), a = test::flipped(test::plane(2, 2));
  Settings s = settings(1, 0.1);
  s.two_pass = true;
  double share[2] = {0, 0};
  const auto contacts = Pair(a, b, s).detect(at(a, {0.6, 0.6, -0.01}), at(b));
  for (const ContactPoint& c : contacts) share[c.slave_side] += c.f.norm();
  EXPECT_NEAR(share[0], 0.005, roundoff);
  EXPECT_GT(share[1], 0.001);
}

TEST(Pair, default_stiffness_is_that_of_both_sides_in_series) {
  model::Surface a = test::plane(4, 4), b = test::plane(2, 2);
  a.c_f.setConstant(3e12);
  b.c_f.setConstant(6e12);
  EXPECT_NEAR(Pair(a, b, {}).settings().stiffness, 2e12, 1);
  EXPECT_NEAR(Pair(a, b, {}).settings().depth, 0.125, roundoff);
  Settings s;
  s.penalty = Penalty::per_node;
  EXPECT_NEAR(Pair(a, b, s).settings().stiffness, 2e12 / 25, 1);
  a.c_f.resize(0);
  EXPECT_THROW(Pair(a, b, {}), Error);
  EXPECT_NO_THROW(Pair(a, b, settings(1, 0)));
}

TEST(Pair, positions_that_are_not_finite_are_refused) {
  const model::Surface a = test::plane(2, 2), b = test::flipped(a);
  Pair pair(a, b, {});
  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    SurfaceState state = at(b);
    state.x_B(1, 4) = bad;
    EXPECT_THROW(pair.detect(at(a), state), Error);
    state = at(a);
    state.r_WB[0] = bad;
    EXPECT_THROW(pair.detect(state, at(b)), Error);
  }
  SurfaceState few = at(a);
  few.x_B.conservativeResize(3, 5);
  EXPECT_THROW(pair.detect(few, at(b)), Error);
}

TEST(Pair, settings_and_surfaces_out_of_range_are_refused) {
  const model::Surface good = test::plane(2, 2);
  const auto refuses = [&](auto change) {
    Settings s;
    change(s);
    EXPECT_THROW(Pair(good, good, s), Error);
  };
  refuses([](Settings& s) { s.k = 7; });
  refuses([](Settings& s) { s.stiffness = -1; });
  refuses([](Settings& s) { s.stiffness = std::nan(""); });
  refuses([](Settings& s) { s.slave = 2; });
  refuses([](Settings& s) { s.depth = -1; });
  refuses([](Settings& s) { s.normal_angle = 10; });
  refuses([](Settings& s) { s.extension = 1; });
  model::Surface bad = good;
  bad.face(0, 0) = 9;
  EXPECT_THROW(Pair(bad, good, {}), Error);
  EXPECT_THROW(Pair(good, model::Surface{}, {}), Error);
}

}  // namespace
}  // namespace elastogear::contact::pair_test
