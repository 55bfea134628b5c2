#include "contact/forces/tangent.h"

#include <gtest/gtest.h>

#include "surfaces.h"

namespace elastogear::contact::tangent_test {
namespace {

using test::Random;
using Vector15 = Eigen::Matrix<double, 15, 1>;
using Matrix15 = Eigen::Matrix<double, 15, 15>;
constexpr double c_p = 3;
constexpr double truncation = 1e-6;  // of a central difference with steps of 1e-5

struct Local {
  Eigen::Vector3d q;
  Face face;
};

Vector15 coordinates(const Local& local) {
  Vector15 x;
  x << local.q, local.face.x[0], local.face.x[1], local.face.x[2], local.face.x[3];
  return x;
}

Local moved(Local local, const Vector15& x) {
  local.q = x.head<3>();
  for (int i = 0; i < 4; ++i) local.face.x[i] = x.segment<3>(3 + 3 * i);
  return local;
}

// The slave node lies behind the face; on an edge or vertex it lies in the normal cone of a concave one.
Projection projection(const Local& local) {
  Projection w{0, closest_point(local.face, local.q), {}, 0};
  const Eigen::Vector3d d = local.q - w.point.x;
  w.g_n = -d.norm();
  w.n = d / w.g_n;
  return w;
}

Vector15 force(const Local& local) {
  const Projection w = projection(local);
  Vector15 F;
  F.head<3>() = -c_p * w.g_n * w.n;
  for (int i = 0; i < 4; ++i) F.segment<3>(3 + 3 * i) = c_p * w.g_n * w.point.N[i] * w.n;
  return F;
}

Matrix15 difference_quotient(const Local& local) {
  const double h = 1e-5;
  const Vector15 x = coordinates(local);
  Matrix15 K;
  for (int j = 0; j < 15; ++j)
    K.col(j) =
        (force(moved(local, x + h * Vector15::Unit(j))) - force(moved(local, x - h * Vector15::Unit(j)))) /
        (2 * h);
  return K;
}

void expect_consistent(const Local& local, Feature feature) {
  const Projection w = projection(local);
  ASSERT_EQ(w.point.feature, feature);
  const Tangent t = contact_tangent(local.face, w, {-c_p * w.g_n, c_p}, true);
  EXPECT_LE(t.W.cols(), 5);
  EXPECT_EQ(Eigen::MatrixXd(t.k), Eigen::MatrixXd(t.k.transpose()));
  const Matrix15 K = -t.W * t.k * t.W.transpose();
  EXPECT_LT((K - difference_quotient(local)).norm(), truncation * K.norm());
}

Local behind(Random& random, int sides, double warp, double depth) {
  Local local;
  local.face.sides = sides;
  const double x[4] = {-1, 1, 1, -1}, y[4] = {-1, -1, 1, 1};
  const Eigen::Matrix3d R = test::rotation(random.vector(3));
  for (int i = 0; i < 4; ++i)
    local.face.x[i] = R * (Eigen::Vector3d(x[i], 0.8 * y[i], 0) + random.vector(warp));
  if (sides == 3) local.face.x[3] = local.face.x[2];
  const double u = sides == 3 ? 0.3 : random.uniform(-0.8, 0.8),
               v = sides == 3 ? 0.2 : random.uniform(-0.8, 0.8);
  local.q = combine(local.face, shape(sides, u, v).N) - depth * normal(local.face, u, v);
  return local;
}

TEST(Tangent, equals_the_difference_quotient_on_plane_faces) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) expect_consistent(behind(random, 4, 0, 0.1), Feature::face);
}

TEST(Tangent, equals_the_difference_quotient_on_warped_faces) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) expect_consistent(behind(random, 4, 0.3, 0.1), Feature::face);
}

TEST(Tangent, equals_the_difference_quotient_on_triangles) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) expect_consistent(behind(random, 3, 0.2, 0.1), Feature::face);
}

TEST(Tangent, equals_the_difference_quotient_at_edges) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    Local local = behind(random, trial % 2 ? 3 : 4, 0.1, 0);
    const Eigen::Vector3d a = local.face.x[0], b = local.face.x[1], n = normal(local.face, 0, 0);
    const Eigen::Vector3d out = (b - a).cross(n).normalized();
    local.q = 0.6 * a + 0.4 * b - 0.2 * n + 0.3 * out;
    expect_consistent(local, Feature::edge);
  }
}

TEST(Tangent, equals_the_difference_quotient_at_vertices) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Local local = behind(random, trial % 2 ? 3 : 4, 0.1, 0);
    const Eigen::Vector3d out =
        2 * local.face.x[0] - local.face.x[1] - (trial % 2 ? local.face.x[2] : local.face.x[3]);
    local.q = local.face.x[0] + 0.2 * out.normalized() - 0.1 * normal(local.face, 0, 0);
    expect_consistent(local, Feature::vertex);
  }
}

TEST(Tangent, normal_part_has_rank_one_and_misses_the_geometric_part) {
  Random random(6);
  const Local local = behind(random, 4, 0.3, 0.1);
  const Projection w = projection(local);
  const Tangent t = contact_tangent(local.face, w, {-c_p * w.g_n, c_p}, false);
  EXPECT_EQ(t.W.cols(), 1);
  const Matrix15 K = -t.W * t.k * t.W.transpose(), exact = difference_quotient(local);
  EXPECT_GT((K - exact).norm(), 100 * truncation * K.norm());
  EXPECT_LT((K - exact).norm(), K.norm());
}

TEST(Tangent, annihilates_translations) {
  Random random(7);
  const Local local = behind(random, 4, 0.3, 0.1);
  const Projection w = projection(local);
  const Tangent t = contact_tangent(local.face, w, {-c_p * w.g_n, c_p}, true);
  const Eigen::Matrix<double, 15, 3> translations = Eigen::Matrix3d::Identity().replicate<5, 1>();
  EXPECT_LT((t.W * t.k * t.W.transpose() * translations).norm(), 1e-13);
}

}  // namespace
}  // namespace elastogear::contact::tangent_test
