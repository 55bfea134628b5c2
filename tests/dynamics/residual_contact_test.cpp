// Bodies of few modes with residual flexibility against the same bodies in the full basis.
#include <gtest/gtest.h>

#include "box_body.h"
#include "dynamics/contact/residual_flexibility.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::residual_contact_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr double kSinglePrecision = 2e-6;  // of stored answers
constexpr double kBalanced = 1e-7;         // of the forces
constexpr int kModes = 6;

enum class Kind { modal, flexible, full };

std::shared_ptr<model::ElasticBody> block(Kind kind, const Eigen::Vector3i& cells, double x_held) {
  const test::BoxSpec spec{
      .size = {1, 1, 1}, .cells = cells, .material = {1e4, 0.3, 1}, .held = [=](const Vector3d& X, int) {
        return std::abs(X.x() - x_held) < 1e-9;
      }};
  return std::make_shared<model::ElasticBody>(kind == Kind::flexible ? test::make_flexible_box(spec, kModes)
                                              : kind == Kind::full
                                                  ? test::make_box(spec, model::Basis::full)
                                                  : test::make_box(spec, model::Basis::modal, kModes));
}

// A block on a slide meets another one, beside it by a third of its width and tilted, so that only a part
// touches.
System blocks(Kind kind, double force, double speed, double stiffness,
              const contact::FrictionSettings& friction = {}) {
  std::vector<BodySetup> setups{{.name = "ram", .body = block(kind, {2, 3, 2}, 0)},
                                {.name = "wall", .body = block(kind, {2, 2, 2}, 1)}};
  setups[0].joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  setups[0].translation.load = constant_signal(force);
  setups[0].translation.s_dot_0 = speed;
  setups[1].joint.r_WB0 = {1.001, 0.25, 0.1};
  PairSetup pair{"ram:wall", {0, 1}, {}};
  pair.settings.stiffness = stiffness;
  pair.settings.depth = 0.05;
  pair.settings.two_pass = true;
  pair.settings.friction = friction;
  if (force != 0) scale_by_load_factor(setups[0], std::numeric_limits<double>::infinity());
  return System(setups, {pair});
}

model::Snapshot equilibrium(System system) {
  model::Snapshot last;
  solve_static(system, {4}, [&](const model::Snapshot& snapshot) { last = snapshot; });
  return last;
}

model::Snapshot equilibrium(Kind kind) { return equilibrium(blocks(kind, 300, 0, 1e5)); }

std::vector<model::Snapshot> impact(Kind kind) {
  System system = blocks(kind, 0, 0.5, 5e3);
  std::vector<model::Snapshot> history;
  simulate(system, {.dt = 2e-4, .end_time = 0.08}, [&](const model::Snapshot& s) { history.push_back(s); });
  return history;
}

double peak_force(const std::vector<model::Snapshot>& history) {
  double peak = 0;
  for (const model::Snapshot& s : history) peak = std::max(peak, s.pairs[0].force.norm());
  return peak;
}

TEST(ResidualContact, equilibrium_is_that_of_the_full_basis) {
  const model::Snapshot modal = equilibrium(Kind::modal), flexible = equilibrium(Kind::flexible),
                        full = equilibrium(Kind::full);
  ASSERT_GE(full.pairs[0].count, 4);
  ASSERT_EQ(flexible.pairs[0].count, full.pairs[0].count);
  EXPECT_NEAR(flexible.bodies[0].s[0], full.bodies[0].s[0], kSinglePrecision * full.bodies[0].s[0]);
  EXPECT_LT(modal.bodies[0].s[0], 0.9 * full.bodies[0].s[0]);  // too stiff
  for (std::size_t i = 0; i < full.pairs[0].contacts.size(); ++i) {
    const Vector3d f = full.pairs[0].contacts[i].f;
    EXPECT_LT((flexible.pairs[0].contacts[i].f - f).norm(),
              10 * kSinglePrecision * full.pairs[0].force.norm());
  }
}

// Friction and the free boundaries of the surfaces give forces and couples beside those of the facets.
TEST(ResidualContact, forces_at_the_nodes_are_those_that_bend_the_bodies) {
  for (Kind kind : {Kind::modal, Kind::flexible, Kind::full})
    for (double mu : {0.0, 0.3}) {
      const model::Snapshot rest = equilibrium(
          blocks(kind, 300, 0, 1e5, {.mu = mu, .law = contact::FrictionLaw::stick, .stiffness = 0.5}));
      for (std::size_t b : {0u, 1u}) {
        const auto body = block(kind, {2, b == 0 ? 3 : 2, 2}, b == 0 ? 0 : 1);
        const model::ContactForces& contact = rest.bodies[b].contact;
        Eigen::VectorXd h = Eigen::VectorXd::Zero(body->n_q());
        for (std::size_t i = 0; i < contact.node.size(); ++i)
          model::add_force(body->surface.Phi, contact.node[i], contact.f_B.col(static_cast<Eigen::Index>(i)),
                           h);
        EXPECT_LT((body->K_r * rest.bodies[b].q - h).norm(), kBalanced * h.norm()) << mu;
      }
    }
}

TEST(ResidualContact, stored_energy_of_an_equilibrium_is_that_of_the_full_basis) {
  const model::Energies flexible = equilibrium(Kind::flexible).energy, full = equilibrium(Kind::full).energy;
  EXPECT_NEAR(flexible.elastic, full.elastic, 10 * kSinglePrecision * full.elastic);
  EXPECT_NEAR(flexible.contact, full.contact, 10 * kSinglePrecision * full.contact);
}

TEST(ResidualContact, impact_keeps_the_energy_and_nears_that_of_the_full_basis) {
  const auto modal = impact(Kind::modal), flexible = impact(Kind::flexible), full = impact(Kind::full);
  double largest = 0, stored = 0;
  for (const model::Snapshot& s : flexible) {
    largest = std::max(largest, std::abs(s.energy.balance));
    stored = std::max(stored, s.energy.elastic + s.energy.contact);
  }
  EXPECT_LT(largest, 1e-4 * stored);
  const double off = std::abs(peak_force(flexible) - peak_force(full)),
               off_modal = std::abs(peak_force(modal) - peak_force(full));
  EXPECT_LT(off, 0.5 * off_modal);
  EXPECT_LT(off, 0.03 * peak_force(full));
}

// At gap 0 roundoff of positions makes forces on the penalty stiffness, to which no static response fits.
TEST(ResidualContact, bodies_that_touch_at_the_start_begin_at_any_angle) {
  for (const Vector3d& angle : {Vector3d(0, 0, 0), Vector3d(0.3, 0.4, 0.5), Vector3d(-1, 0.2, 0.7)}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle.norm(), angle.stableNormalized()).toRotationMatrix();
    std::vector<BodySetup> setups{{.name = "ram", .body = block(Kind::flexible, {2, 2, 2}, 0)},
                                  {.name = "wall", .body = block(Kind::flexible, {2, 2, 2}, 1)}};
    setups[0].joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
    setups[0].translation.load = constant_signal(10);
    setups[1].joint.r_WB0 = R * Vector3d(1, 0, 0);
    for (BodySetup& setup : setups) setup.joint.R_WB0 = R;
    PairSetup pair{"ram:wall", {0, 1}, {}};
    pair.settings.stiffness = 1e5;
    System system(setups, {pair});
    model::Snapshot last;
    simulate(system, {.end_time = 0.02}, [&](const model::Snapshot& snapshot) { last = snapshot; });
    EXPECT_EQ(last.time, 0.02) << angle.transpose();
    EXPECT_GT(last.pairs[0].force.dot(R.col(0)), 1) << angle.transpose();
    EXPECT_LT(std::abs(last.energy.balance), 1e-2 * last.energy.elastic) << angle.transpose();
  }
}

TEST(ResidualContact, nodes_without_answers_are_as_stiff_as_the_modes) {
  const auto body = block(Kind::flexible, {2, 3, 2}, 0);
  constexpr int kKnown = 21, kOther = 15;  // surface nodes at the free end
  model::Flexibility& f = body->flexibility;
  f.node = {kKnown};
  f.surface = model::no_images(1);
  f.F = f.F.block(3 * kKnown, 3 * kKnown, 3, 3).eval();
  model::set_self(f);
  ResidualFlexibility R(*body);
  R.set_forces({{kKnown}, {}, Eigen::Matrix3Xd::Ones(3, 1)});
  const Vector3d one = R.displacement(kKnown);
  EXPECT_GT(one.norm(), 0);
  EXPECT_TRUE(R.displacement(kOther).isZero(0));
  R.set_forces({{kOther, kKnown}, {}, Eigen::Matrix3Xd::Ones(3, 2)});
  EXPECT_EQ(R.displacement(kKnown), one);
}

TEST(ResidualContact, bound_holds_for_every_node) {
  const auto body = block(Kind::flexible, {2, 3, 2}, 0);
  ResidualFlexibility R(*body);
  std::srand(3);
  const NodalForces forces{{1, 5, 9, 20}, {}, Eigen::Matrix3Xd::Random(3, 4)};
  R.set_forces(forces);
  for (int node = 0; node < 24; ++node) EXPECT_LE(R.displacement(node).norm(), R.bound(forces));
}

TEST(ResidualContact, bound_of_forces_that_cancel_is_less_than_the_sum_of_their_bounds) {
  const auto body = block(Kind::flexible, {2, 3, 2}, 0);
  constexpr int kNode = 15, kNeighbour = 21;  // surface nodes at the free end
  ResidualFlexibility R(*body);
  const Vector3d f(1, 0, 0);
  const double one = R.bound({{kNode}, {}, f}), other = R.bound({{kNeighbour}, {}, -f});
  Eigen::Matrix3Xd both(3, 2);
  both << f, -f;
  EXPECT_LT(R.bound({{kNode, kNeighbour}, {}, both}), one + other);
}

TEST(ResidualContact, a_dashpot_that_jumps_at_touch_is_refused) {
  PairSetup pair{"ram:wall", {0, 1}, {}};
  pair.settings.damping = 1;
  EXPECT_THROW(System({{.name = "ram", .body = block(Kind::flexible, {2, 2, 2}, 0)},
                       {.name = "wall", .body = block(Kind::modal, {2, 2, 2}, 1)}},
                      {pair}),
               Error);
}

}  // namespace
}  // namespace elastogear::residual_contact_test
