#include "contact/projection/projection.h"

#include <gtest/gtest.h>

#include <numeric>

#include "contact/projection/projection_kinematics.h"
#include "surfaces.h"

namespace elastogear::contact::projection_test {
namespace {

using test::Random;
constexpr double any_angle = 1.1;  // cosine that no pair of normals exceeds
constexpr double roundoff = 1e-12;

// A master with its topology, tried against all its faces.
struct Master {
  model::Surface surface;
  Topology map;
  double extension = 0.025;

  explicit Master(model::Surface s)
      : surface(std::move(s)), map(topology(surface.face, int(surface.X.cols()))) {}
  SurfaceView view() const { return {surface.face, map, surface.X, extension}; }
  std::optional<Projection> touch(const Eigen::Vector3d& q, const Eigen::Vector3d& n,
                                  const Limits& limits) const {
    std::vector<int> faces(surface.face.cols());
    std::iota(faces.begin(), faces.end(), 0);
    return find_projection(view(), {q, [&] { return n; }}, limits, faces);
  }
  std::optional<Projection> touch(const Eigen::Vector3d& q, double depth = 10) const {
    return touch(q, Eigen::Vector3d::UnitZ(), {depth, any_angle});
  }
};

TEST(Projection, decides_inside_and_outside_of_a_cube_and_gives_its_distance) {
  Random random(1);
  for (int n : {1, 3}) {
    const Master quads(test::cube(n, test::same)), triangles(test::triangulated(quads.surface));
    for (int trial = 0; trial < 2000; ++trial) {
      const Eigen::Vector3d q = random.vector(1.4);
      const double depth = 1 - q.cwiseAbs().maxCoeff();
      for (const Master* master : {&quads, &triangles}) {
        const auto w = master->touch(q);
        ASSERT_EQ(w.has_value(), depth > 0) << q.transpose();
        if (w) {
          EXPECT_NEAR(w->g_n, -depth, roundoff);
        }
      }
    }
  }
}

// A cube with a dent: its top pressed in to a pyramid, so that there are concave edges and a concave vertex.
TEST(Projection, decides_inside_and_outside_at_concave_edges_and_vertices) {
  Random random(2);
  model::Surface dented = test::cube(2, test::same);
  for (auto x : dented.X.colwise())
    if ((x - Eigen::Vector3d::UnitZ()).norm() < 0.1) x.z() = 0.2;
  const Master master(test::triangulated(dented));
  const Master quads(dented);
  int inside = 0, at_edge_or_vertex = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Eigen::Vector3d q = Eigen::Vector3d(0, 0, 0.4) + random.vector(0.55);
    double winding = 0;
    for (const auto& f : master.surface.face.colwise()) {
      const Eigen::Vector3d a = master.surface.X.col(f[0]) - q, b = master.surface.X.col(f[1]) - q,
                            c = master.surface.X.col(f[2]) - q;
      winding += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                   b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    const bool is_inside = winding > test::pi;  // 2 pi inside, 0 outside
    const auto w = master.touch(q);
    ASSERT_EQ(w.has_value(), is_inside) << q.transpose();
    if (!w) continue;
    EXPECT_NEAR((q - w->point.x - w->g_n * w->n).norm(), 0, roundoff);
    ++inside;
    if (w->point.feature != Feature::face) ++at_edge_or_vertex;
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(at_edge_or_vertex, 50);
}

// A node in the place of one of the master's, or on an edge, but for roundoff, which may point anywhere.
TEST(Projection, of_a_node_on_the_surface_has_the_normal_of_the_surface) {
  Random random(3);
  const Master roof(
      test::grid(4, 4, [](double u, double v) { return Eigen::Vector3d(u, v, 0.3 * u * (1 - u)); }));
  const SurfaceView view = roof.view();
  constexpr int kNode = 12, kNext = 13;  // in the middle
  for (int trial = 0; trial < 400; ++trial) {
    const Eigen::Vector3d x = roof.surface.X.col(kNode), next = roof.surface.X.col(kNext);
    const Eigen::Vector3d q = (trial % 2 == 0 ? x : 0.5 * (x + next)) + random.vector(2e-16);
    const auto w = roof.touch(q, -Eigen::Vector3d::UnitZ(), {1, any_angle, 0.1});
    ASSERT_TRUE(w) << q.transpose();
    EXPECT_GT(w->n.z(), 0.98);
    EXPECT_LT(std::abs(w->g_n), 1e-15);
    const ProjectionKinematics kinematics = projection_kinematics(face_of(view, w->face), *w, q);
    EXPECT_LT(kinematics.n_x.cwiseAbs().maxCoeff(), 100);  // 1/m, with faces of 0.25 m
  }
}

TEST(Projection, is_the_lower_face_on_a_tie_whatever_the_order) {
  const Master valley(
      test::grid(2, 1, [](double u, double v) { return Eigen::Vector3d(u, v, std::abs(u - 0.5)); }));
  const SlaveNode q{{0.5, 0.5, -0.1}, [] { return Eigen::Vector3d(0, 0, -1); }};
  const Limits limits{1, 0};
  for (const std::vector<int>& order : {std::vector<int>{0, 1}, {1, 0}}) {
    const auto w = find_projection(valley.view(), q, limits, order);
    ASSERT_TRUE(w);
    EXPECT_EQ(w->face, 0);
    EXPECT_EQ(w->point.feature, Feature::edge);
    EXPECT_NEAR(w->g_n, -0.1, roundoff);
  }
}

// What tests of |xi|, |eta| <= 1 alone make of the same nodes: accepted by how many faces.
int naive_count(const Master& master, const Eigen::Vector3d& q) {
  int count = 0;
  for (int f = 0; f < master.surface.face.cols(); ++f) {
    const ClosestPoint p = closest_point(face_of(master.view(), f), q);
    const bool is_inside = p.feature == Feature::face;
    if (is_inside && normal(face_of(master.view(), f), p.u, p.v).dot(q - p.x) < 0) ++count;
  }
  return count;
}

// Rows of slave nodes slide over a folded master, conforming with it at some positions.
TEST(Projection, is_one_per_node_on_ridges_and_in_valleys) {
  Master master(test::grid(8, 4, [](double u, double v) {
    return Eigen::Vector3d(8 * u, 4 * v,
                           std::lround(8 * u) % 2 ? 0.3 : 0.0);  // ridges at odd x, valleys at even x
  }));
  int lost = 0, twice = 0;
  for (int step = 0; step <= 16; ++step) {
    for (double x = 1; x <= 6; x += 1) {
      const double at = x + step / 16.0, height = 0.3 * (1 - std::abs(std::fmod(at, 2.0) - 1));
      const Eigen::Vector3d q(at, 2, height - 0.05);
      EXPECT_TRUE(master.touch(q, -Eigen::Vector3d::UnitZ(), {0.5, -0.1})) << q.transpose();
      const int n = naive_count(master, q);
      lost += n == 0;
      twice += n > 1;
    }
  }
  EXPECT_GT(lost, 0) << "the naive rule should drop nodes into valleys";
  EXPECT_GT(twice, 0) << "the naive rule should count nodes under ridges twice";
}

TEST(Projection, gap_is_continuous_over_edges) {
  Master master(test::grid(8, 1, [](double u, double v) {
    return Eigen::Vector3d(8 * u, v, std::lround(8 * u) % 2 ? 0.3 : 0.0);
  }));
  const double dx = 1e-3;
  double last = 0;
  for (double x = 1; x <= 7; x += dx) {
    const auto w = master.touch({x, 0.5, -0.2}, 5);
    ASSERT_TRUE(w);
    if (x > 1) {
      EXPECT_LE(std::abs(w->g_n - last), dx * (1 + roundoff));
    }  // slope of a distance <= 1
    last = w->g_n;
  }
}

TEST(Projection, beyond_an_open_end_is_none) {
  const Master master(test::plane(4, 4));
  const double reach = master.extension / 4;
  const auto touches = [&](double x, double y) { return master.touch({x, y, -0.01}, 1).has_value(); };
  EXPECT_TRUE(touches(0, 0) && touches(1, 1) && touches(0.5, 1));
  EXPECT_TRUE(touches(1 + 0.9 * reach, 0.5) && touches(1 + 0.9 * reach, 1 + 0.9 * reach));
  EXPECT_TRUE(touches(0.25, -0.9 * reach)) << "on the prolonged shared edge";
  EXPECT_FALSE(touches(1 + 1.1 * reach, 0.5) || touches(0.5, -1.1 * reach) || touches(0.25, -1.1 * reach));
}

TEST(Projection, on_the_far_side_of_a_thin_tooth_is_none) {
  const double thickness = 0.2;
  model::Surface tooth = test::plane(4, 4);  // upper side at z = 0, lower side at z = -thickness
  const model::Surface lower = test::flipped(test::plane(4, 4));
  tooth.X.conservativeResize(3, 50);
  tooth.X.rightCols(25) = lower.X.colwise() - thickness * Eigen::Vector3d::UnitZ();
  tooth.face.conservativeResize(4, 32);
  tooth.face.rightCols(16) = lower.face.array() + 25;
  const Master master(tooth);
  const Limits limits{0.5, std::cos(100 * test::pi / 180)};  // deeper than the tooth is thick
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(master.touch({0.4, 0.6, 0.01}, -up, limits)) << "close above the upper side";
  EXPECT_FALSE(master.touch({0.4, 0.6, 0.01}, up, limits)) << "behind the lower side, but outside";
  EXPECT_FALSE(master.touch({0.4, 0.6, 0.3 - thickness}, up, limits));
  const auto shallow = master.touch({0.4, 0.6, -0.01}, -up, limits);
  ASSERT_TRUE(shallow);
  EXPECT_NEAR(shallow->g_n, -0.01, roundoff);
  const auto deep = master.touch({0.4, 0.6, -0.15}, -up, limits);
  ASSERT_TRUE(deep) << "nearer to the lower side, but it came through the upper one";
  EXPECT_NEAR(deep->g_n, -0.15, roundoff);
}

// A sharp wedge whose lower side is cut in a fan: a plain sum of face normals would follow the many.
model::Surface wedge(int n_fan) {
  model::Surface s;
  s.X.resize(3, n_fan + 2);
  s.face.resize(4, n_fan + 1);
  s.X.col(0).setZero();
  for (int i = 0; i <= n_fan; ++i) s.X.col(i + 1) << 1, -0.5 + 1.0 * i / n_fan, -0.1;
  s.X.rightCols(n_fan + 1).row(2).setConstant(-0.1);
  s.face.col(0) << 0, 1, n_fan + 1, n_fan + 1;
  for (int i = 0; i < n_fan; ++i) s.face.col(i + 1) << 0, i + 2, i + 1, i + 1;
  for (int i = 1; i < n_fan; ++i) s.X(2, i + 1) -= 0.2 * i * (n_fan - i) / double(n_fan * n_fan);
  return s;
}

TEST(Projection, at_a_sharp_vertex_does_not_depend_on_the_number_of_faces_there) {
  const Eigen::Vector3d above(-0.02, 0, 0.1);  // in front of the tip, over the single upper face
  for (int n_fan : {2, 30}) EXPECT_FALSE(Master(wedge(n_fan)).touch(above)) << n_fan;
}

TEST(Projection, deeper_than_the_limit_is_none) {
  const Master master(test::plane(4, 4));
  EXPECT_TRUE(master.touch({0.4, 0.6, -0.099}, 0.1));
  EXPECT_FALSE(master.touch({0.4, 0.6, -0.101}, 0.1));
}

}  // namespace
}  // namespace elastogear::contact::projection_test
