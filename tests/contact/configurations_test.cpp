// Closest points and contacts of random and degenerate configurations against brute force. By default some
// thousand; ELASTOGEAR_CONFIGURATIONS in the environment asks for more.
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "contact/projection/closest_point.h"
#include "contact/projection/projection.h"
#include "surfaces.h"

namespace elastogear::contact::configurations_test {
namespace {

using Eigen::Vector3d;
using test::Random;

int configurations(int by_default) {
  const char* asked = std::getenv("ELASTOGEAR_CONFIGURATIONS");
  return asked ? std::atoi(asked) : by_default;
}

Face random_quadrilateral(Random& random) {
  const double warp = random.uniform(0, 2), stretch = random.uniform(0.05, 3);
  const Eigen::Matrix3d A = test::rotation(random.vector(3)) * Vector3d(stretch, 1, 1).asDiagonal();
  const double x[4] = {-1, 1, 1, -1}, y[4] = {-1, -1, 1, 1};
  Face face;
  for (int i = 0; i < 4; ++i) face.x[i] = A * (Vector3d(x[i], y[i], 0) + random.vector(warp));
  return face;
}

// A side of no length, a point, a line, crossed sides, a flat corner, a needle, or none of these.
void degenerate(Face& face, Random& random) {
  switch (random.integer(0, 11)) {
    case 0:
      face.x[1] = face.x[0];
      break;
    case 1:
      face.x.fill(face.x[0]);
      break;
    case 2:
      for (int i = 1; i < 4; ++i) face.x[i] = face.x[0] + i * (face.x[1] - face.x[0]);
      break;
    case 3:
      std::swap(face.x[0], face.x[1]);
      break;
    case 4:
      face.x[2] = 0.5 * (face.x[1] + face.x[3]) + random.vector(1e-9);
      break;
    case 5:
      face.x[3] = face.x[0] + random.vector(1e-7), face.x[2] = face.x[1] + random.vector(1e-7);
      break;
    default:
      break;
  }
}

Vector3d random_node(const Face& face, Random& random) {
  const int near = random.integer(0, 3);
  if (near == 0) return random.vector(6);
  if (near == 1) return face.x[random.integer(0, 3)] + random.vector(1e-6);
  const Eigen::Vector4d N = shape(4, random.uniform(-1, 1), random.uniform(-1, 1)).N;
  return combine(face, N) + random.vector(near == 2 ? 1e-3 : 1);
}

// Least distance to points of the face on a grid, then on ever finer grids around the nearest.
double sampled_distance(const Face& face, const Vector3d& q) {
  constexpr int kGrid = 16, kFiner = 6;
  double best = std::numeric_limits<double>::infinity();
  Eigen::Vector2d centre(0, 0);
  double reach = 1;
  for (int level = 0; level < kFiner; ++level, reach *= 2.0 / kGrid) {
    const Eigen::Vector2d about = centre;
    for (int i = 0; i <= kGrid; ++i)
      for (int j = 0; j <= kGrid; ++j) {
        const Eigen::Vector2d at = (about + reach * Eigen::Vector2d(2.0 * i / kGrid - 1, 2.0 * j / kGrid - 1))
                                       .cwiseMax(-1)
                                       .cwiseMin(1);
        const double d = (q - combine(face, shape(4, at[0], at[1]).N)).norm();
        if (d < best) best = d, centre = at;
      }
  }
  return best;
}

TEST(RandomConfigurations, closest_points_are_finite_and_none_is_nearer) {
  constexpr double kRoundoff = 1e-12;
  Random random(1);
  for (int trial = 0; trial < configurations(10000); ++trial) {
    Face face = random_quadrilateral(random);
    degenerate(face, random);
    const Vector3d q = random_node(face, random);
    const ClosestPoint p = closest_point(face, q);
    ASSERT_TRUE(p.x.allFinite() && p.N.allFinite() && std::isfinite(p.u) && std::isfinite(p.v)) << trial;
    ASSERT_LT((combine(face, p.N) - p.x).norm(), kRoundoff * (1 + p.x.norm())) << trial;
    ASSERT_NEAR(std::sqrt(p.distance2), (q - p.x).norm(), kRoundoff * (1 + q.norm())) << trial;
    ASSERT_LE(std::sqrt(p.distance2), sampled_distance(face, q) + kRoundoff * (1 + q.norm())) << trial;
  }
}

// Rough, folded and partly degenerate, of quadrilaterals and triangles.
model::Surface broken(int n, Random& random) {
  const double phase = random.uniform(0, 6), height = random.uniform(0, 0.2);
  model::Surface s = test::grid(n, n, [=](double u, double v) {
    return Vector3d(u, v, height * std::sin(9 * u + phase) * std::cos(7 * v - phase));
  });
  for (auto x : s.X.colwise()) x += random.vector(0.3 / n);
  for (int i = 0; i < n; ++i) {
    const int f = random.integer(0, n * n - 1), c = random.integer(0, 3), g = random.integer(0, n * n - 1);
    s.X.col(s.face(c, f)) = s.X.col(s.face((c + 1) % 4, f));
    s.face(3, g) = s.face(2, g);
  }
  return s;
}

// The search by trees against all faces; each slave node counts as a configuration.
TEST(RandomConfigurations, search_misses_no_contact_and_adds_none) {
  constexpr int n = 12;
  constexpr double kRoundoff = 1e-12;
  Random random(2);
  Settings settings;
  settings.surface = ContactSurface::facets;
  settings.stiffness = 1;
  settings.depth = 0.1;
  const Limits limits{settings.depth, std::cos(settings.normal_angle * test::pi / 180)};
  std::vector<int> all(n * n);
  std::iota(all.begin(), all.end(), 0);
  for (int node_count = 0; node_count < configurations(5000);) {
    const model::Surface a = test::flipped(broken(n, random)), b = broken(n, random);
    SurfaceState state = test::at(a, random.vector(0.02), random.vector(0.3));
    const auto found = Pair(a, b, settings).detect(state, test::at(b));
    state.x_B = (state.R_WB * state.x_B).colwise() + state.r_WB;
    const Topology map_a = topology(a.face, int(a.X.cols())), map_b = topology(b.face, int(b.X.cols()));
    const SurfaceView slave{a.face, map_a, state.x_B, 0}, master{b.face, map_b, b.X, settings.extension};
    auto next = found.begin();
    for (int node = 0; node < a.X.cols(); ++node, ++node_count) {
      const SlaveNode q{slave.x.col(node), [&] { return node_normal(slave, node); }};
      const auto w = find_projection(master, q, limits, all);
      if (!w) continue;
      ASSERT_TRUE(next != found.end() && next->slave_node == node) << node_count;
      ASSERT_NEAR(next->g_n, w->g_n, kRoundoff);
      ASSERT_TRUE(next->f.allFinite() && next->W.allFinite() && next->k.allFinite());
      ++next;
    }
    ASSERT_TRUE(next == found.end());
  }
}

}  // namespace
}  // namespace elastogear::contact::configurations_test
