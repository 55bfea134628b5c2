#include "elastogear/recovery/mode_acceleration.h"

#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::recovery {
namespace {

constexpr double kRoundoff = 1e-14;

// A quadrilateral 0 1 2 3 and a triangle 1 4 2.
model::Surface surface() {
  model::Surface s;
  s.X.resize(3, 5);
  s.X << 0, 1, 1, 0, 2,  //
      0, 0, 1, 1, 0.5,   //
      0, 0, 0, 0, 0;
  s.face.resize(4, 2);
  s.face << 0, 1,  //
      1, 4,        //
      2, 2,        //
      3, 2;
  return s;
}

Eigen::MatrixXd rotations(const std::vector<Eigen::Vector3d>& psi) {
  Eigen::MatrixXd R(9, psi.size());
  for (std::size_t t = 0; t < psi.size(); ++t)
    R.col(t) = Eigen::Matrix3d(rotation_matrix(psi[t]).transpose()).reshaped();  // row-major
  return R;
}

TEST(ContactForces, on_a_slave_node_are_turned_into_the_body_frame_and_summed_over_pairs) {
  const Eigen::Vector3d psi(0.3, -0.8, 0.5), f(1, 2, 3), g(-2, 0.5, 4);
  const PairContacts as_slave{1, {{}, {{1, 3, 0, 0, 0, -1e-6, f}}}},
      again{0, {{}, {{0, 3, 0, 0, 0, -1e-6, g}}}};
  const ForceHistory h = contact_forces({as_slave, again}, surface(), rotations({{0, 0, 0}, psi}));
  ASSERT_EQ(h.node, std::vector<int>{3});
  EXPECT_EQ(h.force.col(0).norm(), 0);
  EXPECT_NEAR((h.force.col(1) - rotation_matrix(psi).transpose() * (f + g)).norm(), 0, 10 * kRoundoff);
}

TEST(ContactForces, on_a_master_face_have_the_opposite_sum_and_moment_at_its_nodes) {
  const model::Surface s = surface();
  const Eigen::Vector3d f(1, 2, 3);
  const double xi = 0.25, eta = -0.5;
  for (int face : {0, 1}) {
    const PairContacts pair{0, {{{1, 0, face, xi, eta, -1e-6, f}}}};
    const ForceHistory h = contact_forces({pair}, s, rotations({{0, 0, 0}}));
    Eigen::Vector3d sum = f, at = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < h.node.size(); ++i) {
      sum += h.force.col(0).segment<3>(3 * i);
      at -= h.force(3 * i, 0) / f[0] * s.X.col(h.node[i]);
    }
    EXPECT_NEAR(sum.norm(), 0, 10 * kRoundoff);
    const Eigen::Vector3d quadrilateral(0.625, 0.25, 0),
        triangle(1 + 0.75 * 0.625, 0.25 + 0.75 * 0.625 * 0.5, 0);
    EXPECT_NEAR((at - (face == 0 ? quadrilateral : triangle)).norm(), 0, 10 * kRoundoff);
  }
}

TEST(ContactForces, refuse_records_of_another_surface) {
  const Eigen::Vector3d f(1, 2, 3);
  const Eigen::MatrixXd R = rotations({{0, 0, 0}});
  EXPECT_THROW(contact_forces({{0, {{{1, 0, 2, 0, 0, -1e-6, f}}}}}, surface(), R), Error);
  EXPECT_THROW(contact_forces({{0, {{{0, 5, 0, 0, 0, -1e-6, f}}}}}, surface(), R), Error);
}

TEST(DynamicPart, of_a_static_answer_is_zero) {
  model::ElasticBody body;
  body.surface = surface();
  const Eigen::MatrixXd Phi = Eigen::MatrixXd::Random(15, 4);
  body.surface.Phi = model::DenseRows(Phi);
  const Eigen::Vector4d stiffness(1, 4, 9, 30);
  body.K_r = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
  const ForceHistory forces{{1, 4}, Eigen::MatrixXd::Random(6, 3)};
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(15, 3);
  f.middleRows(3, 3) = forces.force.topRows(3);
  f.middleRows(12, 3) = forces.force.bottomRows(3);
  const Eigen::MatrixXd q = stiffness.cwiseInverse().asDiagonal() * (Phi.transpose() * f);
  EXPECT_LT(dynamic_part(body, q, forces).norm(), 10 * kRoundoff * q.norm());
}

}  // namespace
}  // namespace elastogear::recovery
