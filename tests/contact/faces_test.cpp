// Contact integrated over faces: weighted gaps, areas, and the balance of forces.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "contact/faces/second_order.h"
#include "contact/projection/closest_point.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/pair.h"
#include "elastogear/contact/topology.h"
#include "surfaces.h"

namespace elastogear::contact::faces_test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kStiffness = 1e9;  // Pa/m

Settings faces(ContactLaw law) {
  Settings s;
  s.law = law;
  s.points = SlavePoints::faces;
  s.surface = ContactSurface::facets;
  s.stiffness = kStiffness;
  s.depth = 0.5;
  return s;
}

Vector3d force_on_slave(const ContactPoint& c) { return slave_force(c); }

// Moment of the forces on all nodes, and its part on the slave's, about the origin.
struct Moments {
  Vector3d all = Vector3d::Zero(), on_slave = Vector3d::Zero();
};

Vector3d world(const SurfaceState& state, int node) { return state.r_WB + state.R_WB * state.x_B.col(node); }

Moments moments(const std::vector<ContactPoint>& contacts, const SurfaceState& slave,
                const SurfaceState& master) {
  Moments m;
  for (const ContactPoint& c : contacts)
    for (int i = 0; i < c.n_local(); ++i) {
      const bool on_slave = i < c.n_slave();
      const Vector3d x =
          on_slave ? world(slave, c.slave_nodes[i]) : world(master, c.master_nodes[i - c.n_slave()]);
      const Vector3d moment = x.cross(Vector3d(c.F.col(i)));
      m.all += moment;
      if (on_slave) m.on_slave += moment;
    }
  return m;
}

// ---- planes

struct Planes {
  model::Surface slave, master;
};

class OverPlanes : public testing::TestWithParam<Planes> {};

// A plane of 1 m upside down over another one of 1.2 m x 0.7 m, turned and shifted, which it overlaps in a
// quadrilateral of 1 m x 0.7 m at most: the part above the strip |y'| < 0.35 m of the turned master.
TEST_P(OverPlanes, uniform_pressure_acts_on_the_area_that_is_shared) {
  constexpr double kDepth = 1e-3, kTurn = 0.3;  // m, rad
  const auto& [slave, master] = GetParam();
  SurfaceState a = test::at(slave, {-0.5, 0.5, -kDepth}), b = test::at(master);
  a.R_WB = Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix();
  b.R_WB = Eigen::AngleAxisd(kTurn, Vector3d::UnitZ()).toRotationMatrix();
  b.r_WB = -(b.R_WB * Vector3d(1, 0.35, 0));  // its middle is at the origin; 2 m x 0.7 m
  Pair pair(slave, master, faces(ContactLaw::penalty));
  const std::vector<ContactPoint> contacts = pair.detect(a, b);
  // The strip |x sin - y cos| < 0.35 within the square |x|, |y| < 0.5: the square less two corner pieces.
  const double s = std::sin(kTurn), c = std::cos(kTurn);
  double area = 0;
  constexpr int kSlices = 20000;
  for (int i = 0; i < kSlices; ++i) {
    const double x = -0.5 + (i + 0.5) / kSlices, low = std::max(-0.5, (x * s - 0.35) / c),
                 high = std::min(0.5, (x * s + 0.35) / c);
    area += (high - low) / kSlices;
  }
  double shared = 0;
  Vector3d force = Vector3d::Zero();
  for (const ContactPoint& contact : contacts) {
    EXPECT_NEAR(contact.g_n, -kDepth, 1e-12);
    EXPECT_NEAR((contact.F.rowwise().sum()).norm(), 0, 1e-6);
    shared += contact.area;
    force += force_on_slave(contact);
  }
  EXPECT_NEAR(shared, area, 1e-7);
  EXPECT_NEAR(force.z(), kStiffness * kDepth * area, 1e-7 * kStiffness * kDepth);
  EXPECT_NEAR(force.head<2>().norm(), 0, 1e-6);
  const Moments moment = moments(contacts, a, b);
  EXPECT_NEAR(moment.all.norm(), 0, 1e-5);
  EXPECT_NEAR(moment.on_slave.norm(), 0, 2e-6 * kStiffness * kDepth) << "the shared part is symmetric";
}

model::Surface strip(int n_u, int n_v) { return test::plane(n_u, n_v, 2, 0.7); }

INSTANTIATE_TEST_SUITE_P(
    Faces, OverPlanes,
    testing::Values(Planes{test::plane(4, 3), strip(7, 5)}, Planes{test::plane(9, 8), strip(4, 2)},
                    Planes{test::triangulated(test::plane(4, 3)), test::triangulated(strip(5, 4))},
                    Planes{test::plane(5, 4), test::triangulated(strip(3, 3))}));

// None of its corners is over such a master, so that it would not be seen.
TEST(Faces, larger_than_the_master_are_refused) {
  const model::Surface slave = test::plane(1, 1), master = test::plane(2, 2, 0.1, 0.1);
  EXPECT_THROW(Pair(slave, master, faces(ContactLaw::penalty)), Error);
  EXPECT_NO_THROW(Pair(master, slave, faces(ContactLaw::penalty)));
}

// ---- curved surfaces

// z = -(x^2 / 2 r_x + y^2 / 2 r_y) over a square of 1 m, seen from above.
model::Surface cap(int n, double r_x, double r_y) {
  return test::grid(n, n, [=](double u, double v) {
    const double x = u - 0.5, y = v - 0.5;
    return Vector3d(x, y, -0.5 * (x * x / r_x + y * y / r_y));
  });
}

struct Caps {
  model::Surface slave, master;
  SurfaceState a, b;
};

Caps caps(test::Random& random, double gap) {
  Caps t{cap(6, 4, 3), cap(7, 6, 5), {}, {}};
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(random.uniform(-1, 1), Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(test::pi, Vector3d::UnitX()))
                                .toRotationMatrix();
  t.a = {t.slave.X, Vector3d(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), gap), R};
  t.b = {t.master.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  return t;
}

// The distance of a point from the facets of the master; nothing beyond their boundary.
std::optional<double> gap_over(const SurfaceView& master, const Vector3d& x) {
  double nearest = std::numeric_limits<double>::infinity(), gap = 0;
  bool outside = true;
  for (int f = 0; f < master.face.cols(); ++f) {
    const Face face = face_of(master, f);
    const ClosestPoint p = closest_point(face, x);
    if (p.distance2 >= nearest) continue;
    nearest = p.distance2;
    const double side = (x - p.x).dot(normal(face, p.u, p.v));
    gap = std::copysign(std::sqrt(p.distance2), side);
    outside =
        p.feature == Feature::outside || (p.feature != Feature::face && master.topology.is_open(f, p.part));
  }
  if (outside) return {};
  return gap;
}

struct Weighted {
  double gap = 0, area = 0;  // m^3, m^2
};

// Weighted gaps of all slave nodes from 20 x 20 points on each face.
std::map<int, Weighted> sampled(const Caps& t) {
  constexpr int kPoints = 20;
  const Topology slave_topology = topology(t.slave.face, static_cast<int>(t.slave.X.cols())),
                 master_topology = topology(t.master.face, static_cast<int>(t.master.X.cols()));
  Matrix3Xd x(3, t.slave.X.cols());
  for (int i = 0; i < x.cols(); ++i) x.col(i) = world(t.a, i);
  const SurfaceView slave{t.slave.face, slave_topology, x, 0},
      master{t.master.face, master_topology, t.master.X, 0};
  std::map<int, Weighted> nodes;
  for (int f = 0; f < slave.face.cols(); ++f) {
    const Face face = face_of(slave, f);
    for (int p = 0; p < kPoints * kPoints; ++p) {
      const int column = p % kPoints, row = p / kPoints;
      const Shape s = shape(4, (2. * column + 1) / kPoints - 1, (2. * row + 1) / kPoints - 1);
      const auto gap = gap_over(master, combine(face, s.N));
      if (!gap) continue;
      const double area = 4. / (kPoints * kPoints) * combine(face, s.N_u).cross(combine(face, s.N_v)).norm();
      for (int i = 0; i < 4; ++i) {
        Weighted& node = nodes[slave.face(i, f)];
        node.gap += s.N[i] * area * *gap;
        node.area += s.N[i] * area;
      }
    }
  }
  return nodes;
}

TEST(Faces, weighted_gaps_are_those_of_many_points_and_none_is_missed) {
  constexpr double kSampling = 4e-5;    // m, error of a gap by 400 points on each face
  constexpr double kAtBoundary = 2e-4;  // m, the same on faces that the master covers in part
  constexpr double kSliver = 1e-4;      // m^2, an area that 400 points are too few for
  test::Random random(7);
  int closed = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Caps t = caps(random, -random.uniform(0.005, 0.03));
    Pair pair(t.slave, t.master, faces(ContactLaw::penalty));
    std::map<int, ContactPoint> found;
    for (const ContactPoint& c : pair.detect(t.a, t.b)) found.emplace(c.slave_node, c);
    const Eigen::VectorXd area = node_areas(t.slave.X, t.slave.face);
    for (const auto& [node, weighted] : sampled(t)) {
      const double gap = weighted.gap / weighted.area;
      if (weighted.area < kSliver || gap > -kSampling) continue;
      ASSERT_TRUE(found.contains(node)) << "trial " << trial << ", node " << node << ", gap " << gap;
      const bool is_whole = weighted.area > 0.999 * area[node];
      EXPECT_NEAR(found.at(node).g_n, gap, is_whole ? kSampling : kAtBoundary);
      EXPECT_NEAR(found.at(node).area, weighted.area, 0.02 * weighted.area + kSliver);
      ++closed;
    }
  }
  EXPECT_GT(closed, 40);
}

TEST(Faces, gradients_are_the_derivatives_of_gaps_where_these_are_even) {
  const model::Surface slave = test::plane(3, 3), master = test::plane(4, 5, 1.2, 1.3);
  SurfaceState a = test::at(slave, {0.1, 1.15, -1e-3}), b = test::at(master);
  a.R_WB = Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix();
  Pair pair(slave, master, faces(ContactLaw::penalty));
  const std::vector<ContactPoint> contacts = pair.detect(a, b);
  ASSERT_EQ(contacts.size(), 16u);
  constexpr double kStep = 1e-7, kTolerance = 1e-5;
  for (std::size_t k = 0; k < contacts.size(); k += 5) {
    const ContactPoint& c = contacts[k];
    for (int i = 0; i < c.n_local(); ++i)
      for (int d = 0; d < 3; ++d) {
        double g[2];
        for (int sign : {0, 1}) {
          SurfaceState moved[2] = {a, b};
          SurfaceState& of = moved[i < c.n_slave() ? 0 : 1];
          const int node = i < c.n_slave() ? c.slave_nodes[i] : c.master_nodes[i - c.n_slave()];
          of.x_B.col(node) += of.R_WB.transpose() * (sign ? kStep : -kStep) * Vector3d::Unit(d);
          g[sign] = pair.detect(moved[0], moved[1])[k].g_n;
        }
        EXPECT_NEAR(c.g_x(d, i), (g[1] - g[0]) / (2 * kStep), kTolerance);
      }
  }
}

// ---- second-order sides

// Displacements a + b . c + c' Q c of a side with its mid nodes in the middle of straight edges.
TEST(Faces, displacements_of_parts_are_those_of_their_second_order_side) {
  test::Random random(3);
  const double square[8][2] = {{0, 0}, {2, 0.2}, {2.5, 1.7}, {-0.1, 1.5}};
  const double triangle[8][2] = {{0, 0}, {2, 0.2}, {0.3, 1.7}};
  const std::vector<Eigen::Vector4i> parts_of_square{
      {0, 4, 7, 7}, {1, 5, 4, 4}, {2, 6, 5, 5}, {3, 7, 6, 6}, {4, 5, 6, 7}},
      parts_of_triangle{{0, 3, 5, 5}, {1, 4, 3, 3}, {2, 5, 4, 4}, {3, 4, 5, 5}};
  for (int corners : {3, 4}) {
    Matrix3Xd x = Matrix3Xd::Zero(3, 2 * corners);
    SecondOrderSide side = SecondOrderSide::Constant(-1);
    for (int i = 0; i < corners; ++i)
      x.col(i).head<2>() = Eigen::Vector2d(corners == 3 ? triangle[i] : square[i]);
    for (int i = 0; i < corners; ++i) x.col(corners + i) = 0.5 * (x.col(i) + x.col((i + 1) % corners));
    for (int i = 0; i < 2 * corners; ++i) side[i] = i;
    const double slope = random.uniform(-1, 1), bend = random.uniform(-1, 1);
    // Straight-sided triangles hold all quadratic fields; of quadrilaterals only linear ones are sure.
    const auto field = [&](const Vector3d& at) {
      return 0.3 + slope * at.x() - at.y() + (corners == 3 ? bend * at.x() * at.y() + at.y() * at.y() : 0);
    };
    for (const Eigen::Vector4i& part : corners == 3 ? parts_of_triangle : parts_of_square) {
      Face face;
      face.sides = part[2] == part[3] ? 3 : 4;
      for (int k = 0; k < 4; ++k) face.x[k] = x.col(part[k]);
      const Eigen::Vector2d at = face.sides == 3 ? Eigen::Vector2d(0.3, 0.45) : Eigen::Vector2d(0.2, -0.6);
      const SideWeights w =
          side_weights(side, face, part, at, [&](int node) { return Vector3d(x.col(node)); });
      ASSERT_EQ(w.n, 2 * corners);
      const Eigen::Vector4d N = shape(face.sides, at[0], at[1]).N;
      double u = 0, sum = 0;
      for (int k = 0; k < face.sides; ++k) u += N[k] * field(face.x[k]);
      for (int i = 0; i < w.n; ++i) u += w.d[i] * field(x.col(w.node[i])), sum += w.d[i];
      EXPECT_NEAR(sum, 0, 1e-14);
      EXPECT_NEAR(u, field(combine(face, N)), 1e-13);
    }
  }
}

TEST(Faces, friction_opposes_the_sliding_and_fades_below_its_speed) {
  constexpr double kMu = 0.2, kFade = 1e-2, kSpeed = 2e-2;  // -, m/s, m/s
  model::Surface slave = test::plane(3, 3), master = test::plane(4, 5, 1.2, 1.3);
  for (model::Surface* s : {&slave, &master}) s->Phi = model::DenseRows(3 * s->X.cols(), 0);
  SurfaceMotion a{Eigen::VectorXd(0),
                  {0.1, 1.15, -1e-3},
                  Eigen::AngleAxisd(test::pi, Vector3d::UnitX()).toRotationMatrix()};
  SurfaceMotion b{Eigen::VectorXd(0), Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  a.v_WB_B = {kSpeed, 0, 0};
  Settings settings = faces(ContactLaw::penalty);
  settings.friction = {.mu = kMu, .v_0 = kFade};
  Pair pair(slave, master, settings);
  const std::vector<ContactPoint> contacts = pair.detect(a, b);
  Vector3d force = Vector3d::Zero();
  double power = 0;
  for (const ContactPoint& c : contacts) {
    force += force_on_slave(c);
    power += c.friction_power;
    EXPECT_NEAR(c.F.rowwise().sum().norm(), 0, 1e-6);
  }
  const double share = kSpeed / std::hypot(kSpeed, kFade);
  EXPECT_NEAR(force.z(), kStiffness * 1e-3, 1e-3);
  EXPECT_NEAR(force.x(), -kMu * share * force.z(), 1e-6 * force.z());
  EXPECT_NEAR(power, -force.x() * kSpeed, 1e-6 * power);
}

}  // namespace
}  // namespace elastogear::contact::faces_test
