#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <limits>
#include <numbers>

#include "contact/projection/closest_point.h"
#include "contact/projection/face_boxes.h"
#include "contact/search/neighbour_list.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/deformation_bound.h"
#include "elastogear/contact/pair.h"
#include "surfaces.h"

namespace elastogear::contact::skin_test {
namespace {

using test::Random;

constexpr int n_modes = 12;

// A wavy patch of 2 x 2 m with smooth modes of 5 mm at q = 1.
struct Elastic {
  model::Surface surface;
  Eigen::SparseMatrix<double> K_r;
};

Elastic elastic_patch(int n, bool turned, Random& random) {
  Elastic e;
  e.surface = test::grid(n, n, [&](double u, double v) {
    return Eigen::Vector3d(2 * u - 1, 2 * v - 1, 0.02 * std::sin(7 * u) * std::cos(5 * v));
  });
  if (turned) e.surface = test::flipped(e.surface);
  e.surface.node.resize(e.surface.X.cols());
  model::DenseRows Phi(3 * e.surface.X.cols(), n_modes);
  e.K_r.resize(n_modes, n_modes);
  for (int k = 0; k < n_modes; ++k) {
    e.K_r.insert(k, k) = std::pow(1.0 + k, 2);
    const Eigen::Vector3d direction = random.vector(1), wave = random.vector(3);
    for (Eigen::Index i = 0; i < e.surface.X.cols(); ++i)
      Phi.block<3, 1>(3 * i, k) = 5e-3 * std::cos(wave.dot(e.surface.X.col(i))) * direction;
  }
  e.K_r.makeCompressed();
  e.surface.Phi = Phi;
  return e;
}

Eigen::VectorXd amplitudes(Random& random, double size) {
  Eigen::VectorXd q(n_modes);
  for (double& x : q) x = random.uniform(-size, size);
  return q;
}

Settings settings(Update update) {
  Settings s;
  s.surface = ContactSurface::facets;
  s.stiffness = 1;
  s.penalty = Penalty::per_node;
  s.depth = 0.03;
  s.update = update;
  s.two_pass = true;
  return s;
}

void expect_equal(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].slave_side, b[i].slave_side);
    EXPECT_EQ(a[i].slave_node, b[i].slave_node);
    EXPECT_EQ(a[i].face, b[i].face);
    EXPECT_NEAR(a[i].g_n, b[i].g_n, 1e-15);  // roundoff of positions of size 1
  }
}

TEST(DeformationBound, is_never_below_the_largest_displacement_and_is_reached) {
  Random random(1);
  const Elastic e = elastic_patch(9, false, random);
  const DeformationBound by_energy = deformation_bound(e.surface.Phi, e.K_r);
  const DeformationBound by_nodes = deformation_bound(e.surface.Phi, {});
  ASSERT_GT(by_energy.compliance, 0);
  EXPECT_EQ(by_nodes.compliance, 0);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd q = amplitudes(random, 1);
    EXPECT_GE(largest_displacement(by_energy, q), largest_displacement(by_nodes, q));
  }
  // A static force on a node, in the direction in which it gives most, displaces it by the bound.
  double tightest = 0;
  const auto& Phi = std::get<model::DenseRows>(e.surface.Phi);
  for (Eigen::Index i = 0; i < e.surface.X.cols(); ++i) {
    const Eigen::Matrix3d C = Phi.middleRows<3>(3 * i) * e.K_r.diagonal().cwiseInverse().asDiagonal() *
                              Phi.middleRows<3>(3 * i).transpose();
    const Eigen::Vector3d f = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvectors().col(2);
    const Eigen::VectorXd q =
        e.K_r.diagonal().cwiseInverse().asDiagonal() * (Phi.middleRows<3>(3 * i).transpose() * f);
    tightest = std::max(tightest, largest_displacement(by_nodes, q) / largest_displacement(by_energy, q));
  }
  EXPECT_NEAR(tightest, 1, 1e-6);
}

TEST(Travel, bounds_the_way_of_every_point_of_the_ball) {
  Random random(2);
  const Elastic e = elastic_patch(6, false, random);
  const Ball ball = enclosing_ball(e.surface.X);
  double largest_share = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const RelativeMotion from{test::rotation(random.vector(3)), random.vector(1)};
    const double size = std::pow(10.0, random.uniform(-6, 0));
    const RelativeMotion to{from.R * test::rotation(random.vector(size)), from.r + random.vector(size)};
    const Eigen::Matrix3Xd way = ((to.R - from.R) * e.surface.X).colwise() + (to.r - from.r);
    const double farthest = std::sqrt(way.colwise().squaredNorm().maxCoeff());
    EXPECT_GE(travel(ball, from, to) * (1 + 1e-12), farthest);
    largest_share = std::max(largest_share, farthest / travel(ball, from, to));
  }
  EXPECT_GT(largest_share, 0.8);
}

TEST(Travel, corners_bound_the_way_of_every_point_of_a_body_that_spins) {
  constexpr int kNodes = 400;
  constexpr double kRadius = 0.01, kHalf = 0.05,
                   kOctagon = 1.0824;  // m, m, circumscribed over inscribed circle
  Eigen::Matrix3Xd X(3, kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const double turn = 2.4 * i;
    X.col(i) << kRadius * std::cos(turn), kRadius * std::sin(turn), kHalf * (2.0 * i / (kNodes - 1) - 1);
  }
  const Eigen::Matrix3Xd corners = corners_around(X);
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const RelativeMotion from{test::rotation(random.vector(3)), random.vector(1)};
    const double angle = std::pow(10.0, random.uniform(-6, 0)),
                 lift = random.uniform(0, 0.1 * angle * kRadius);
    const RelativeMotion to{from.R * test::rotation({0, 0, angle}), from.r + random.vector(lift)};
    const Eigen::Matrix3Xd way = ((to.R - from.R) * X).colwise() + (to.r - from.r);
    const double farthest = std::sqrt(way.colwise().squaredNorm().maxCoeff());
    EXPECT_GE(travel(corners, 0, from, to) * (1 + 1e-9), farthest);
    EXPECT_LT(travel(corners, 0, from, to), 1.01 * kOctagon * farthest);
    EXPECT_GT(travel(enclosing_ball(X), from, to), 4 * farthest);
  }
}

TEST(Skin, way_of_a_deformed_surface_is_bounded) {
  Random random(6);
  const Elastic a = elastic_patch(16, true, random), b = elastic_patch(14, false, random);
  const Pair pair(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
  double largest_share = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const double size = std::pow(10.0, random.uniform(-4, 0));
    const SurfaceMotion from{amplitudes(random, 1), random.vector(1), test::rotation(random.vector(3))};
    const SurfaceMotion to{from.q + amplitudes(random, size), from.r_WB + random.vector(0.01 * size),
                           from.R_WB * test::rotation(random.vector(0.01 * size))};
    const SurfaceState before = surface_state(a.surface, from), after = surface_state(a.surface, to);
    const Eigen::Matrix3Xd way =
        (after.R_WB * after.x_B - before.R_WB * before.x_B).colwise() + (after.r_WB - before.r_WB);
    const double farthest = std::sqrt(way.colwise().squaredNorm().maxCoeff());
    EXPECT_GE(pair.travel(0, from, to) * (1 + 1e-12), farthest);
    largest_share = std::max(largest_share, farthest / pair.travel(0, from, to));
  }
  EXPECT_GT(largest_share, 0.3);
}

// Faces have extensions at the free boundaries of the patch.
TEST(Skin, boxes_around_faces_are_no_farther_than_these) {
  constexpr double kExtension = 0.3;
  Random random(7);
  const Elastic e = elastic_patch(6, false, random);
  const Topology topology = contact::topology(e.surface.face, static_cast<int>(e.surface.X.cols()));
  const SurfaceView view{e.surface.face, topology, e.surface.X, kExtension};
  const FaceBoxes boxes = face_boxes(view);
  int n_near = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d x = random.vector(2);
    for (int f = 0; f < e.surface.face.cols(); ++f) {
      const double of_box = distance(boxes, x, std::array{f}),
                   of_face = std::sqrt(closest_point(face_of(view, f), x).distance2);
      EXPECT_LE(of_box, of_face * (1 + 1e-12));
      n_near += of_box > 0.8 * of_face;
    }
  }
  EXPECT_GT(n_near, 1000);
  EXPECT_EQ(distance(boxes, random.vector(2), {}), std::numeric_limits<double>::infinity());
}

// Two elastic patches slide, roll and vibrate over each other for 200 small steps.
TEST(Skin, contacts_equal_those_of_a_search_at_every_stage) {
  for (Update update : {Update::bound, Update::refit, Update::realign}) {
    Random random(3);
    const Elastic a = elastic_patch(16, true, random), b = elastic_patch(14, false, random);
    Pair searched(a.surface, b.surface, settings(update));
    Pair kept(a.surface, b.surface, settings(update), {&a.K_r, &b.K_r});
    SurfaceMotion m_a{Eigen::VectorXd::Zero(n_modes), {-0.3, 0.1, 0.01}, test::rotation({0.01, -0.02, 0.3})};
    SurfaceMotion m_b{Eigen::VectorXd::Zero(n_modes), {0, 0, 0}, Eigen::Matrix3d::Identity()};
    int n_contacts = 0, n_displaced = 0;
    constexpr int n_steps = 200;
    for (int step = 0; step < n_steps; ++step) {
      m_a.q += amplitudes(random, 2e-2);
      m_b.q += amplitudes(random, 2e-2);
      m_a.r_WB += Eigen::Vector3d(1e-3, -5e-4, 0) + random.vector(2e-4);
      m_a.R_WB = m_a.R_WB * test::rotation(random.vector(2e-4));
      m_b.R_WB = m_b.R_WB * test::rotation(random.vector(2e-4));
      const auto found = kept.detect(m_a, m_b);
      expect_equal(found, searched.detect(surface_state(a.surface, m_a), surface_state(b.surface, m_b)));
      n_contacts += static_cast<int>(found.size());
      n_displaced += kept.n_displaced();
    }
    EXPECT_GT(n_contacts, 10 * n_steps);
    EXPECT_LT(kept.n_searches(), n_steps / 3);
    EXPECT_GE(kept.n_searches(), 10);
    EXPECT_LT(n_displaced, n_steps * static_cast<int>(a.surface.X.cols() + b.surface.X.cols()));
  }
}

// Patches that know how fast they move: the same contacts, by fewer searches. Velocities that mislead cost
// searches, but no contact.
TEST(Skin, searches_are_made_ahead_of_surfaces_that_move_on) {
  constexpr int n_steps = 200;
  constexpr double dt = 1e-3;  // s
  const Eigen::Vector3d step_B(1.5e-3, -7e-4, 0), turn(0, 0, 5e-4);
  const auto searches = [&](double share) {  // of the velocity, that the motion tells
    Random random(8);
    const Elastic a = elastic_patch(16, true, random), b = elastic_patch(14, false, random);
    Pair searched(a.surface, b.surface, settings(Update::bound));
    Pair kept(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
    SurfaceMotion m_a{Eigen::VectorXd::Zero(n_modes), {-0.3, 0.1, 0.01}, test::rotation({0.01, -0.02, 0.3})};
    SurfaceMotion m_b{Eigen::VectorXd::Zero(n_modes), {0, 0, 0}, Eigen::Matrix3d::Identity()};
    m_a.v_WB_B = share / dt * step_B;
    m_a.w_WB_B = share / dt * turn;
    int n_contacts = 0;
    for (int step = 0; step < n_steps; ++step) {
      m_a.q += amplitudes(random, 2e-3);
      m_b.q += amplitudes(random, 2e-3);
      m_a.r_WB += m_a.R_WB * step_B;
      m_a.R_WB = m_a.R_WB * test::rotation(turn);
      const auto found = kept.detect(m_a, m_b);
      expect_equal(found, searched.detect(surface_state(a.surface, m_a), surface_state(b.surface, m_b)));
      n_contacts += static_cast<int>(found.size());
    }
    EXPECT_GT(n_contacts, 10 * n_steps);
    return kept.n_searches();
  };
  const int at_rest = searches(0);
  EXPECT_LT(searches(1), 0.75 * at_rest);
  EXPECT_LT(searches(0.1), 0.75 * at_rest);  // the direction counts
  EXPECT_LT(searches(-1), 8 * at_rest);      // away from where the surfaces go
}

// A patch dives through another, farther than the depth limit, and comes back.
TEST(Skin, nodes_deeper_than_the_limit_are_found_as_soon_as_they_are_not) {
  Random random(4);
  const Elastic a = elastic_patch(16, true, random), b = elastic_patch(14, false, random);
  Pair searched(a.surface, b.surface, settings(Update::bound));
  Pair kept(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
  SurfaceMotion m_a{Eigen::VectorXd::Zero(n_modes), {-0.3, 0.1, 0}, test::rotation({0.01, -0.02, 0.3})};
  SurfaceMotion m_b{Eigen::VectorXd::Zero(n_modes), {0, 0, 0}, Eigen::Matrix3d::Identity()};
  int n_empty = 0, n_full = 0, n_displaced = 0;
  constexpr int n_steps = 240;
  for (int step = 0; step < n_steps; ++step) {
    m_a.q += amplitudes(random, 5e-3);
    m_a.r_WB[2] = 0.06 - 0.16 * std::sin(std::numbers::pi * step / n_steps);
    const auto found = kept.detect(m_a, m_b);
    expect_equal(found, searched.detect(surface_state(a.surface, m_a), surface_state(b.surface, m_b)));
    (found.empty() ? n_empty : n_full)++;
    n_displaced += kept.n_displaced();
  }
  EXPECT_GT(n_empty, n_steps / 4);
  EXPECT_GT(n_full, n_steps / 4);
  EXPECT_LT(n_displaced, n_steps * static_cast<int>(a.surface.X.cols() + b.surface.X.cols()) / 2);
}

// A patch rests just beyond another, is lifted by jumps of all sizes and comes back. Nodes that have been
// seen to be clear are displaced no more until the surfaces have gone as far, there and back.
TEST(Skin, nodes_seen_to_be_clear_are_left_out_until_the_way_is_used_up) {
  Random random(5);
  const Elastic a = elastic_patch(16, true, random), b = elastic_patch(14, false, random);
  Pair searched(a.surface, b.surface, settings(Update::bound));
  Pair kept(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
  const SurfaceMotion m_b{Eigen::VectorXd::Zero(n_modes), {0, 0, 0}, Eigen::Matrix3d::Identity()};
  SurfaceMotion m_a{Eigen::VectorXd::Zero(n_modes), {-0.3, 0.1, 0}, test::rotation({0.01, -0.02, 0.3})};
  const auto contacts_at = [&](double z) {
    m_a.r_WB[2] = z;
    const auto found = kept.detect(m_a, m_b);
    expect_equal(found, searched.detect(surface_state(a.surface, m_a), surface_state(b.surface, m_b)));
    return static_cast<int>(found.size());
  };
  constexpr double kLow = 0.02, kHigh = 0.05;
  int n_contacts = 0;
  for (int step = 0; step < 200; ++step) {
    const double size = std::pow(10.0, random.uniform(-5, 0));
    contacts_at(kLow + size * (kHigh - kLow));
    contacts_at(kLow);
    m_a.q = amplitudes(random, size);
    n_contacts += contacts_at(kLow);
  }
  EXPECT_GT(n_contacts, 200);
}

// The tip of a cone rocks on a plane, until the normals of its node and the face are no longer opposite: that
// node alone is near, and those around it give the normal.
TEST(Skin, normals_of_nodes_follow_the_motion) {
  const model::Surface cone = test::flipped(test::grid(16, 16, [](double u, double v) {
    return Eigen::Vector3d(2 * u - 1, 2 * v - 1, std::hypot(2 * u - 1, 2 * v - 1));
  }));
  const model::Surface plane =
      test::grid(14, 14, [](double u, double v) { return Eigen::Vector3d(2 * u - 1, 2 * v - 1, 0); });
  Settings s = settings(Update::bound);
  s.two_pass = false;
  s.normal_angle = 176;
  Pair searched(cone, plane, s), kept(cone, plane, s);
  const SurfaceMotion below{{}, {0, 0, 0}, Eigen::Matrix3d::Identity()};
  int n_without = 0, n_with = 0;
  for (int step = 0; step < 200; ++step) {
    const double tilt = 0.1 * std::sin(0.05 * step);
    const SurfaceMotion above{{}, {0.03, 0.04, -0.002}, test::rotation({tilt, 0.3 * tilt, 0})};
    const auto found = kept.detect(above, below);
    expect_equal(found, searched.detect(surface_state(cone, above), surface_state(plane, below)));
    (found.empty() ? n_without : n_with)++;
  }
  EXPECT_GT(n_without, 20);
  EXPECT_GT(n_with, 20);
}

TEST(Skin, of_bodies_that_are_far_apart_displaces_no_node) {
  Random random(4);
  const Elastic a = elastic_patch(8, true, random), b = elastic_patch(8, false, random);
  Pair pair(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
  const SurfaceMotion m_b{amplitudes(random, 1), {0, 0, 0}, Eigen::Matrix3d::Identity()};
  EXPECT_TRUE(pair.detect({amplitudes(random, 1), {0, 0, 3}, Eigen::Matrix3d::Identity()}, m_b).empty());
  EXPECT_EQ(pair.n_displaced(), 0);
}

TEST(Skin, refuses_wrong_coordinates) {
  Random random(5);
  const Elastic a = elastic_patch(4, true, random), b = elastic_patch(4, false, random);
  Pair pair(a.surface, b.surface, settings(Update::bound), {&a.K_r, &b.K_r});
  const SurfaceMotion good{amplitudes(random, 1), {0, 0, 0}, Eigen::Matrix3d::Identity()};
  SurfaceMotion few = good, nan = good;
  few.q.conservativeResize(n_modes - 1);
  nan.q[3] = std::nan("");
  EXPECT_THROW(pair.detect(few, good), Error);
  EXPECT_THROW(pair.detect(good, nan), Error);
  Settings negative = settings(Update::bound);
  negative.skin = -1;
  EXPECT_THROW(Pair(a.surface, b.surface, negative), Error);
}

}  // namespace
}  // namespace elastogear::contact::skin_test
