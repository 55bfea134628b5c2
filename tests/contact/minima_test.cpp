// Contact where the gap of two smooth surfaces is least, on sides and within faces.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "contact/forces/slave_point.h"
#include "elastogear/contact/pair.h"
#include "surfaces.h"

namespace elastogear::contact::minima_test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kForce = 5;  // N

// z = -(x^2 / 2 r_x + y^2 / 2 r_y) over a square of 1 m, seen from above.
model::Surface cap(int n, double r_x, double r_y) {
  return test::grid(n, n, [=](double u, double v) {
    const double x = u - 0.5, y = v - 0.5;
    return Vector3d(x, y, -0.5 * (x * x / r_x + y * y / r_y));
  });
}

Settings minima() {
  Settings s;
  s.law = ContactLaw::unilateral;
  s.points = SlavePoints::minima;
  s.surface = ContactSurface::smooth;
  s.slave = 0;
  s.depth = 0.5;
  return s;
}

// The slave upside down over the master, turned and shifted so that nothing is symmetric.
struct Two {
  model::Surface slave, master;
  SurfaceState a, b;
};

Two two(double r_y, double gap) {
  Two t{cap(5, 4, r_y), cap(7, 6, 5), {}, {}};
  const Eigen::Matrix3d R =
      (Eigen::AngleAxisd(0.2, Vector3d::UnitZ()) * Eigen::AngleAxisd(test::pi, Vector3d::UnitX()))
          .toRotationMatrix();
  t.a = {t.slave.X, Vector3d(0.03, 0.045, gap), R};
  t.b = {t.master.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  return t;
}

std::vector<ContactPoint> found(Pair& pair, const Two& t, bool on_faces) {
  std::vector<ContactPoint> all = pair.detect(t.a, t.b);
  std::erase_if(all, [&](const ContactPoint& c) { return (c.n_slave() == 4) != on_faces; });
  return all;
}

Eigen::VectorXd local_positions(const Two& t, const ContactPoint& c) {
  Matrix3Xd x(3, c.n_local());
  for (int i = 0; i < c.n_local(); ++i)
    x.col(i) = i < c.n_slave() ? Vector3d(t.a.R_WB * t.a.x_B.col(c.slave_nodes[i]) + t.a.r_WB)
                               : Vector3d(t.b.R_WB * t.b.x_B.col(c.master_nodes[i - c.n_slave()]) + t.b.r_WB);
  return x.reshaped();
}

// The state with one local coordinate moved.
Two moved(Two t, const ContactPoint& c, int j, double step) {
  const int i = j / 3;
  const Vector3d dx = step * Vector3d::Unit(j % 3);
  if (i < c.n_slave())
    t.a.x_B.col(c.slave_nodes[i]) += t.a.R_WB.transpose() * dx;
  else
    t.b.x_B.col(c.master_nodes[i - c.n_slave()]) += t.b.R_WB.transpose() * dx;
  return t;
}

ContactPoint again(Pair& pair, const Two& t, int number) {
  for (const ContactPoint& c : pair.detect(t.a, t.b))
    if (c.slave_point == number) return c;
  ADD_FAILURE() << "point " << number << " is lost";
  return {};
}

TEST(GapMinima, gradient_and_tangent_are_those_of_the_least_gap) {
  // m; -, of the change of heights as faces turn, and of the turning of the face beside where it has a share
  constexpr double kStep = 1e-6, kLeftOut = 1e-3, kBeside = 1e-2;
  const Two t = two(3, 1e-4);
  Pair pair(t.slave, t.master, minima());
  std::vector<ContactPoint> points = found(pair, t, true);
  ASSERT_GE(points.size(), 4u);
  for (ContactPoint& c : points) c.p = kForce;
  pair.set_forces(points);
  for (const ContactPoint& named : points) {
    const ContactPoint c = again(pair, t, named.slave_point);
    const Eigen::VectorXd g_x = c.g_x.reshaped();
    const Eigen::MatrixXd K =
        -c.W * c.k * c.displacement_columns().transpose() + c.F_p.reshaped() * g_x.transpose() / c.c;
    Eigen::MatrixXd K_h(K.rows(), K.cols());
    Eigen::VectorXd g_h(K.rows());
    for (int j = 0; j < 3 * c.n_local(); ++j) {
      const ContactPoint up = again(pair, moved(t, c, j, kStep), c.slave_point),
                         down = again(pair, moved(t, c, j, -kStep), c.slave_point);
      g_h[j] = (up.g_n - down.g_n) / (2 * kStep);
      K_h.col(j) = (up.F - down.F).reshaped() / (2 * kStep);
    }
    EXPECT_LT((g_x - g_h).norm(), kLeftOut * g_h.norm()) << c.slave_point;
    const bool at_side = std::max(std::abs(c.xi), std::abs(c.eta)) > 0.9;
    EXPECT_LT((K - K_h).norm(), (at_side ? kBeside : kLeftOut) * K_h.norm()) << c.slave_point;
  }
}

using Weights = std::map<int, Eigen::VectorXd>;

// Weights of the slave's nodes in the points on its sides and faces, by number.
Weights weights(Pair& pair, const Two& t) {
  Weights of;
  for (const ContactPoint& c : found(pair, t, true)) of[c.slave_point] = c.slave_N;
  return of;
}

// States of bodies that move with a constant speed, before and after a step, in the middle of the next one
// and at its end.
TEST(GapMinima, stand_half_a_step_ahead_in_a_step_of_the_impact_law) {
  constexpr double kFit = 2e-2;  // of the way in a step, which is not uniform
  std::array<Two, 4> at;
  for (int i : {0, 1, 2, 3}) {
    constexpr std::array<double, 4> kTime{0, 1, 1.5, 2};
    at[i] = two(3, -0.03);
    at[i].a.r_WB += kTime[i] * Vector3d(2e-3, 1e-3, 0);
  }
  Pair free(at[0].slave, at[0].master, minima());
  const Weights first = weights(free, at[0]), second = weights(free, at[1]);
  Settings impact = minima();
  impact.law = ContactLaw::augmented;
  Pair pair(at[0].slave, at[0].master, impact);
  pair.set_masses(0, Eigen::VectorXd::Ones(at[0].slave.X.cols()));
  pair.set_masses(1, Eigen::VectorXd::Ones(at[0].master.X.cols()));
  pair.begin_step({0, 1});
  for (int i : {0, 1}) pair.accept(pair.detect(at[i].a, at[i].b));
  pair.begin_step({1e-3, 1});
  const Weights middle = weights(pair, at[2]), end = weights(pair, at[3]);
  ASSERT_GE(middle.size(), 4u);
  EXPECT_EQ(middle, end);
  for (const auto& [number, N] : middle) {
    ASSERT_TRUE(first.contains(number) && second.contains(number));
    const Eigen::VectorXd way = second.at(number) - first.at(number);
    EXPECT_GT(way.norm(), 1e-4);
    EXPECT_LT((N - second.at(number) - 0.5 * way).norm(), kFit * way.norm());
  }
}

TEST(GapMinima, forces_balance_and_so_do_their_moments) {
  const Two t = two(3, 1e-4);
  Pair pair(t.slave, t.master, minima());
  for (const ContactPoint& c : found(pair, t, true)) {
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    const Matrix3Xd x = local_positions(t, c).reshaped(3, c.n_local());
    for (int i = 0; i < c.n_local(); ++i) {
      force += c.F_p.col(i);
      moment += x.col(i).cross(Vector3d(c.F_p.col(i)));
    }
    EXPECT_LT(force.norm(), 1e-14);
    EXPECT_LT(moment.norm(), 1e-14);
  }
}

// A face of the slave over the edge between two faces of the master that was flat before it was deformed.
TEST(GapMinima, there_is_one_on_either_side_of_a_valley_of_the_deformed_master) {
  constexpr double kSlope = 0.02, kRadius = 4, kShift = 0.02, kFit = 1e-3;  // -, m
  Two t{cap(3, kRadius, 3),
        test::grid(2, 1, [](double u, double v) { return Vector3d(u - 0.5, v - 0.5, 0); }),
        {},
        {}};
  t.a = {t.slave.X, Vector3d(kShift, 0, 1.5e-3),
         Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix()};
  t.b = {t.master.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  t.b.x_B.row(2) = kSlope * t.master.X.row(0).cwiseAbs();
  Pair pair(t.slave, t.master, minima());
  std::vector<ContactPoint> points = found(pair, t, true);
  std::erase_if(points, [](const ContactPoint& c) { return c.slave_N.minCoeff() < kFit; });
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NE(points[0].slave_point, points[1].slave_point);
  for (int i : {0, 1}) {
    const double x = -0.25 + 0.25 * points[i].xi + 0.5 * points[i].face;
    EXPECT_NEAR(x, kShift + (i == 0 ? -1 : 1) * kSlope * kRadius, kFit);
  }
}

// Flat squares of 2 x 2 faces, the slave beyond the master's end by a share of a face. Elastic ones may have
// been deformed there.
TEST(GapMinima, nodes_at_ends_that_are_nearly_aligned_touch) {
  for (const auto& [share, elastic, nodes] :
       {std::tuple(0.0, true, 9), {5e-3, true, 9}, {2e-2, true, 6}, {0.0, false, 9}, {5e-3, false, 6}}) {
    model::Surface square =
        test::grid(2, 2, [](double u, double v) { return Vector3d(u - 0.5, v - 0.5, 0); });
    square.Phi = model::DenseRows::Zero(3 * square.X.cols(), elastic ? 1 : 0);
    Two t{square, square, {}, {}};
    t.a = {square.X, Vector3d(share * 0.5, 0, -1e-4),
           Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix()};
    t.b = {square.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    Pair pair(square, square, minima());
    std::vector<ContactPoint> points = found(pair, t, false);
    std::erase_if(points, [](const ContactPoint& c) { return c.slave_side != 0; });
    EXPECT_EQ(points.size(), std::size_t(nodes)) << share;
  }
}

// Points that bore a force stay where they were when they are minima no more, once each, until they are
// released.
TEST(GapMinima, that_vanish_under_their_force_stay_until_they_are_released) {
  constexpr double kMoved = 0.35;  // m, more than a face
  const Two before = two(3, 1e-4);
  Two after = before;
  after.a.r_WB.x() += kMoved;
  const auto is_at = [](const ContactPoint& place) {
    return [place](const ContactPoint& c) {
      return c.n_slave() == 4 && c.slave_nodes == place.slave_nodes &&
             (c.slave_N - place.slave_N).norm() < 1e-9;
    };
  };
  Pair pair(before.slave, before.master, minima());
  std::vector<ContactPoint> points = found(pair, before, true);
  std::erase_if(points, [&](const ContactPoint& c) {  // the master is a square of 1 m
    const Matrix3Xd x = local_positions(after, c).reshaped(3, c.n_local());
    return c.slave_side != 0 || (x.leftCols<4>() * c.slave_N).head<2>().cwiseAbs().maxCoeff() > 0.45;
  });
  ASSERT_GE(points.size(), 2u);
  for (ContactPoint& c : points) c.p = kForce;
  const auto count = [&](const Two& t, const ContactPoint& place) {
    const std::vector<ContactPoint> now = pair.detect(t.a, t.b);
    return std::count_if(now.begin(), now.end(), is_at(place));
  };
  for (const ContactPoint& point : points) EXPECT_EQ(count(after, point), 0) << point.slave_point;
  pair.detect(before.a, before.b);
  pair.keep_minima(points);
  for (int i = 0; i < 2; ++i)
    for (const ContactPoint& point : points) EXPECT_EQ(count(after, point), 1) << point.slave_point;
  for (const ContactPoint& point : points) EXPECT_EQ(count(before, point), 1) << point.slave_point;
  pair.release_minima();
  for (const ContactPoint& point : points) EXPECT_EQ(count(after, point), 0) << point.slave_point;
}

// Points that are followed are those of a look at all, as far as the surfaces have moved little since the
// last one, and are looked for anew where they have moved far or leave their side or face.
TEST(GapMinima, are_followed_to_where_a_look_at_all_finds_them) {
  const Two t = two(3, 1e-4);
  const auto motions = [&](double way) {
    return std::array<SurfaceMotion, 2>{SurfaceMotion{{}, t.a.r_WB + way * Vector3d(1, 0.3, -0.02), t.a.R_WB},
                                        SurfaceMotion{{}, t.b.r_WB, t.b.R_WB}};
  };
  Pair pair(t.slave, t.master, minima()), anew(t.slave, t.master, minima());
  pair.follow_points();
  std::size_t most = 0;
  for (double way : {0.0, 1e-6, 1e-4, 5e-4, 2e-3, 1e-3, 0.06, 0.061, 0.0605, 0.2}) {
    const auto at = motions(way);
    const std::vector<ContactPoint> now = pair.detect(at[0], at[1]), all = anew.detect(at[0], at[1]);
    ASSERT_EQ(now.size(), all.size()) << way;
    most = std::max(most, now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      EXPECT_EQ(now[i].slave_point, all[i].slave_point) << way;
      EXPECT_NEAR(now[i].g_n, all[i].g_n, 1e-13) << way;
      EXPECT_LT((now[i].n - all[i].n).norm(), 1e-9) << way;
    }
  }
  EXPECT_GT(most, 3U);
}

// A look at all is made where it is asked for: of two motions that differ little the same points touch, and
// one that comes within the reach of open candidates is not among them until then.
TEST(GapMinima, that_come_near_are_found_by_a_look_at_all) {
  constexpr double kWay = 0.004;  // m, less than half of that reach
  const Two t = two(3, 0.0105);   // beyond it
  const SurfaceMotion b{{}, t.b.r_WB, t.b.R_WB}, before{{}, t.a.r_WB, t.a.R_WB},
      after{{}, t.a.r_WB - kWay * Vector3d::UnitZ(), t.a.R_WB};
  Settings settings = minima();
  settings.skin = 0.1;
  Pair pair(t.slave, t.master, settings);
  pair.follow_points();
  ASSERT_TRUE(pair.detect(before, b).empty());
  EXPECT_TRUE(pair.detect(after, b).empty());
  pair.look_at_all();
  EXPECT_FALSE(pair.detect(after, b).empty());
}

// Pairs that are told to follow contacts far find those that they have found before, and no others.
TEST(GapMinima, are_followed_far_where_those_that_come_near_may_be_missed) {
  constexpr double kWay = 0.008;  // m, more than half of the reach of open candidates
  const Two t = two(3, 0.0105);   // beyond it
  const SurfaceMotion b{{}, t.b.r_WB, t.b.R_WB}, before{{}, t.a.r_WB, t.a.R_WB},
      after{{}, t.a.r_WB - kWay * Vector3d::UnitZ(), t.a.R_WB},
      deeper{{}, t.a.r_WB - (kWay + 1e-4) * Vector3d::UnitZ(), t.a.R_WB};
  Settings settings = minima();
  settings.skin = 0.1;
  Pair pair(t.slave, t.master, settings);
  pair.follow_points();
  ASSERT_TRUE(pair.detect(before, b).empty());
  pair.follow_far(true);
  EXPECT_TRUE(pair.detect(after, b).empty());
  pair.follow_far(false);
  const std::vector<ContactPoint> seen = pair.detect(after, b);
  ASSERT_FALSE(seen.empty());
  pair.follow_far(true);
  const std::vector<ContactPoint> followed = pair.detect(deeper, b);
  ASSERT_EQ(followed.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(followed[i].g_n, seen[i].g_n - 1e-4, 1e-6);
}

// A node that slides over the faces of a pyramid, which was a plane before it was deformed, along their sides
// and past the corner of all four: its force turns, but never at once.
TEST(GapMinima, forces_turn_gradually_over_the_kinks_of_the_deformed_master) {
  constexpr double kSlope = 0.01, kDepth = 1e-4, kStep = 1e-6,
                   kSteepest = 70 * kSlope;  // -, m, m, 1/m
  const model::Surface square =
      test::grid(2, 2, [](double u, double v) { return Vector3d(u - 0.5, v - 0.5, 0); });
  for (double side : {-1.0, 1.0})
    for (double y : {0.0, 1e-3, 0.008, 0.1}) {
      Two t{square, square, {}, {}};
      t.b = {square.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
      t.b.x_B.row(2) = side * kSlope * (square.X.row(0).cwiseAbs() + 0.7 * square.X.row(1).cwiseAbs());
      Pair pair(square, square, minima());
      const auto direction = [&](double x) {
        const double z = side * kSlope * (std::abs(x) + 0.7 * std::abs(y)) - kDepth;
        t.a = {square.X, Vector3d(x, y, z),
               Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix()};
        for (const ContactPoint& c : pair.detect(t.a, t.b))
          if (c.slave_side == 0 && c.n_slave() == 1 && c.slave_node == 4) return Vector3d(c.F_p.col(0));
        ADD_FAILURE() << "the node is lost at " << x << ", " << y;
        return Vector3d(0, 0, 0);
      };
      double turned = 0;
      for (double x = -0.03; x < 0.03; x += 7.3e-4) {
        const Vector3d n = direction(x);
        EXPECT_LT((direction(x + kStep) - n).norm(), kSteepest * kStep) << side << " " << x << " " << y;
        turned = std::max(turned, (n - direction(-0.03)).norm());
      }
      EXPECT_LT((direction(kStep / 2) - direction(-kStep / 2)).norm(), kSteepest * kStep) << side << " " << y;
      EXPECT_GT(turned, 1.5 * kSlope);
    }
}

// The smallest gap over points of all slave faces, each against all faces of the master.
double smallest_gap(const Two& t, int per_side) {
  const auto smooth = [](const model::Surface& s, const Topology& map) {
    return make_heights({s.face, map, s.X, 0}, ContactSurface::smooth, 0.5, {});
  };
  const Topology map_a = topology(t.slave.face, int(t.slave.X.cols())),
                 map_b = topology(t.master.face, int(t.master.X.cols()));
  const Heights h_a = smooth(t.slave, map_a), h_b = smooth(t.master, map_b);
  const Matrix3Xd x = (t.a.R_WB * t.a.x_B).colwise() + t.a.r_WB;
  const SurfaceView slave{t.slave.face, map_a, x, 0}, surface{t.master.face, map_b, t.b.x_B, 0};
  const MasterSide master{surface, h_b, 0.5, false};
  std::vector<int> faces(static_cast<std::size_t>(t.master.face.cols()));
  std::iota(faces.begin(), faces.end(), 0);
  double least = 1;
  for (int f = 0; f < t.slave.face.cols(); ++f)
    for (int i = 0; i < per_side * per_side; ++i) {
      SlavePoint point;
      point.face = f;
      const int row = i / per_side, column = i % per_side;
      point.at << 2.0 * column / (per_side - 1) - 1, 2.0 * row / (per_side - 1) - 1;
      const SlaveGeometry g = slave_geometry(slave, h_a, point);
      const auto w = find_projection(surface, {g.x, [&] { return g.n; }}, {1, -0.1, 1}, faces);
      if (w) least = std::min(least, open_point(master, *w, g.x, 0).gap.g);
    }
  return least;
}

TEST(GapMinima, have_the_smallest_gap_of_all_points_of_the_slave) {
  constexpr int kPerSide = 41;
  constexpr double kBetween = 2e-6;  // m, by which the gap falls between these points
  for (double r_y : {2.0, 3.0, 20.0, -6.0})
    for (double shift : {0.0, 0.11, 0.23}) {
      Two t = two(r_y, 1e-3);
      t.a.r_WB.x() += shift;
      Pair pair(t.slave, t.master, minima());
      double least = 1;
      for (const ContactPoint& c : pair.detect(t.a, t.b)) least = std::min(least, c.g_n);
      const double brute = smallest_gap(t, kPerSide);
      EXPECT_LT(least, brute + 1e-12) << r_y << " " << shift;
      EXPECT_GT(least, brute - kBetween) << r_y << " " << shift;
    }
}

// Cylinders along each other: the least gap is on sides of the slave, whose middle is beyond the master's
// end.
TEST(GapMinima, are_found_on_sides_that_leave_the_master) {
  constexpr double kRadius = 4, kMaster = 6, kGap = 1e-3, kFit = 1e-4;  // m
  for (double shift : {0.76, 0.77, 0.78}) {
    Two t{test::grid(2, 2,
                     [](double u, double v) {
                       const double x = u - 0.5;
                       return Vector3d(x, 0.4 * (v - 0.5), -0.5 * x * x / kRadius);
                     }),
          cap(7, kMaster, 1e6),
          {},
          {}};
    const double least = shift * shift / (2 * (kRadius + kMaster));
    t.a = {t.slave.X, Vector3d(shift, 0, kGap - least),
           Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix()};
    t.b = {t.master.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    Pair pair(t.slave, t.master, minima());
    double found = 1;
    for (const ContactPoint& c : pair.detect(t.a, t.b)) found = std::min(found, c.g_n);
    EXPECT_NEAR(found, kGap, kFit) << shift;
  }
}

}  // namespace
}  // namespace elastogear::contact::minima_test
