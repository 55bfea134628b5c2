// A node that slides over sides at which the deformed faces of the master make a valley rests on all of them.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cstdio>

#include "../contact/surfaces.h"
#include "box_body.h"
#include "contact_bodies.h"

namespace elastogear::valley_test {
using namespace dynamics;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kDepth = 0.03;  // m, at y = 0.5 m; to either side are faces 0.5 m wide
constexpr double kReach = 0.01;  // m, of the tip into the bottom

// A block of 2 x 2 faces with static responses, held at the other end.
std::shared_ptr<const model::ElasticBody> block() {
  return std::make_shared<model::ElasticBody>(
      test::make_flexible_box({.cells = {2, 2, 2},
                               .material = {1e4, 0.3, 1},
                               .held = [](const Vector3d& X, int) { return X.x() > 1 - 1e-9; }},
                              40));
}

// A rigid pyramid whose tip, at its origin, points to +x.
std::shared_ptr<const model::ElasticBody> tip() {
  return test::rigid_with(contact::test::grid(2, 2, [](double u, double v) {
    const bool is_tip = u == 0.5 && v == 0.5;
    return Vector3d(is_tip ? 0 : -0.1, 0.1 * (u - 0.5), 0.1 * (v - 0.5));
  }));
}

enum class Shape { valley, hollow };  // along y = 0.5 m, or where all four faces meet

// The coordinates that come nearest to a displacement by kDepth into the block there.
VectorXd pressed_in(const model::ElasticBody& body, Shape shape) {
  const model::Surface& surface = body.surface;
  const auto& Phi = std::get<model::DenseRows>(surface.Phi);
  VectorXd u = VectorXd::Zero(3 * surface.X.cols());
  for (Eigen::Index i = 0; i < surface.X.cols(); ++i)
    if (surface.X(0, i) == 0 && surface.X(1, i) == 0.5 && (shape == Shape::valley || surface.X(2, i) == 0.5))
      u[3 * i] = kDepth;
  return Eigen::MatrixXd(Phi).completeOrthogonalDecomposition().solve(u);
}

struct Press {
  std::shared_ptr<const model::ElasticBody> wall = block();
  VectorXd U;
  std::unique_ptr<System> system;

  Press(Shape shape, double z) {
    BodySetup pointed{.name = "tip", .body = tip()}, blunt{.name = "wall", .body = wall};
    pointed.joint = {
        .type = body::JointType::prismatic, .axis = {0, 1, 0}, .r_WB0 = {kDepth + kReach, 0.5, z}};
    PairSetup pair{"tip:wall", {0, 1}, {}};
    pair.settings.law = contact::ContactLaw::unilateral;
    pair.settings.surface = contact::ContactSurface::smooth;
    pair.settings.depth = 0.1;
    system = std::make_unique<System>(std::vector{pointed, blunt}, std::vector{pair});
    U = system->initial_position();
    U.tail(wall->n_q()) = pressed_in(*wall, shape);
  }

  // Force on the wall where the tip is y beside the bottom of the valley; nothing where none is found.
  std::optional<Vector3d> force(double y) {
    U[0] = y;
    const ContactState& state = system->contacts(0, U, VectorXd::Zero(U.size()));
    if (!state.balanced) return {};
    return Vector3d(state.force[1].f_B.rowwise().sum());
  }
};

// Normals on both sides differ by 7 degrees and push the tip from each to the other: none holds it alone.
void expect_to_pass(Shape shape, double z) {
  constexpr int kSteps = 200;
  constexpr double kWay = 0.02, kSmooth = 0.01;  // m to either side; -, of the force from place to place
  Press press(shape, z);
  const Vector3d bottom = press.force(0).value_or(Vector3d::Zero());
  ASSERT_GT(bottom.x(), 0);
  EXPECT_LT(std::abs(bottom.y()), 1e-3 * bottom.x());
  std::optional<Vector3d> before;
  double most = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const auto f = press.force(kWay * i / kSteps);
    ASSERT_TRUE(f) << "at " << kWay * i / kSteps << " m the forces do not settle";
    if (before) most = std::max(most, (*f - *before).norm() / f->norm());
    before = f;
  }
  std::printf("force %.4g N at the bottom, largest change %.2g\n", bottom.norm(), most);
  EXPECT_LT(most, kSmooth);
}

TEST(Valley, forces_settle_on_a_node_that_passes_from_one_side_to_the_other) {
  expect_to_pass(Shape::valley, 0.25);
}

TEST(Valley, forces_settle_on_a_node_that_passes_where_four_faces_meet) {
  for (double z : {0.5, 0.502, 0.51}) expect_to_pass(Shape::hollow, z);
}

}  // namespace
}  // namespace elastogear::valley_test
