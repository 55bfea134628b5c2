// Patch test of contact: two elastic blocks under uniform pressure, pressed together on meshes that match and
// that do not. Exact are one pressure and one displacement all over the interface.
#include <gtest/gtest.h>

#include <cstdio>

#include "../figures.h"
#include "box_body.h"
#include "contact_bodies.h"

namespace elastogear::patch_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr const char* kCase = "patch test over faces";
const model::Material kSteel{2e11, 0.3, 8000};
constexpr double kPressed = 1e-4;  // m, the far end of the upper block
constexpr int kModes = 10;         // of a block with residual flexibility

// Of size 1 m, from x = x_held to the contact at x = 0; it may widen.
std::shared_ptr<const model::ElasticBody> block(double x_held, int cells, bool flexible) {
  const test::BoxSpec spec{
      .corner = {std::min(x_held, 0.), 0, 0},
      .cells = {3, cells, cells},
      .material = kSteel,
      .held = [=](const Vector3d& X, int d) { return d == 0 ? X.x() == x_held : X[d] == 0; }};
  return std::make_shared<model::ElasticBody>(flexible ? test::make_flexible_box(spec, kModes)
                                                       : test::make_box(spec, model::Basis::full));
}

struct Patch {
  int lower, upper;  // cells along an edge of the interface
  bool two_pass;
  contact::SlavePoints points = contact::SlavePoints::nodes;
  bool unilateral = false;  // on blocks with residual flexibility
};

struct PatchErrors {
  double pressure, displacement;  // largest deviation of a node from the exact value, relative
};

// Of the displacements of the lower block's interface: they are on x_max.
double displacement_error(const model::ElasticBody& lower, const Eigen::VectorXd& q, double exact) {
  double error = 0;
  for (int i = 0; i < lower.surface.X.cols(); ++i)
    if (lower.surface.X(0, i) == 0)
      error = std::max(error, std::abs(model::displacement(lower.surface.Phi, i, q).x() / exact - 1));
  return error;
}

PatchErrors patch_errors(const Patch& patch) {
  const auto lower = block(-1, patch.lower, patch.unilateral),
             upper = block(1, patch.upper, patch.unilateral);
  PairSetup pair{"upper:lower", {0, 1}, {}};
  pair.settings.stiffness = 20 * lower->surface.c_f[0];
  pair.settings.depth = 0.1;
  pair.settings.two_pass = patch.two_pass;
  pair.settings.points = patch.points;
  if (patch.unilateral) pair.settings.law = contact::ContactLaw::unilateral;
  BodySetup above{.name = "upper", .body = upper};
  above.joint.r_WB0 = {-kPressed, 0, 0};
  System system({above, {.name = "lower", .body = lower}}, {pair});
  const model::Snapshot state =
      test::state_at_rest(system, test::equilibrium(system, system.initial_position()));
  const double compliance = (patch.unilateral ? 1e-4 : 1) / pair.settings.stiffness;
  const double p = kPressed / (2 / kSteel.E + compliance);
  PatchErrors error{0, displacement_error(*lower, state.bodies[1].q, -p / kSteel.E)};
  for (const model::ContactRecord& c : state.pairs[0].contacts)
    error.pressure = std::max(error.pressure, std::abs(c.pressure / p - 1));
  return error;
}

TEST(PatchTest, is_passed_where_every_master_node_meets_a_slave_node) {
  constexpr double kNewton = 1e-8;
  for (const Patch& patch : {Patch{4, 4, false}, {4, 4, true}, {4, 8, false}}) {
    const PatchErrors error = patch_errors(patch);
    EXPECT_LT(error.pressure, kNewton);
    EXPECT_LT(error.displacement, kNewton);
  }
}

TEST(PatchTest, is_passed_on_any_meshes_by_contact_integrated_over_faces) {
  constexpr double kNewton = 1e-10;
  constexpr auto kFaces = contact::SlavePoints::faces;
  for (const Patch& patch :
       {Patch{4, 4, false, kFaces}, {4, 5, false, kFaces}, {5, 4, false, kFaces}, {8, 3, false, kFaces}}) {
    const PatchErrors error = patch_errors(patch);
    std::printf("%d under %d cells: pressure %.1e, displacement %.1e\n", patch.lower, patch.upper,
                error.pressure, error.displacement);
    test::figure({kCase, "pressure"}, error.pressure, kNewton);
    test::figure({kCase, "displacement"}, error.displacement, kNewton);
  }
}

TEST(PatchTest, is_passed_by_residual_flexibility_without_a_penalty) {
  constexpr double kSinglePrecision = 1e-6;  // of static responses in files; those of the test are in double
  constexpr auto kFaces = contact::SlavePoints::faces;
  for (const Patch& patch :
       {Patch{4, 5, false, kFaces, true}, {5, 4, false, kFaces, true}, {8, 3, false, kFaces, true}}) {
    const PatchErrors error = patch_errors(patch);
    std::printf("%d under %d cells, unilateral: pressure %.1e, displacement %.1e\n", patch.lower, patch.upper,
                error.pressure, error.displacement);
    test::figure({kCase, "pressure with residual flexibility"}, error.pressure, kSinglePrecision);
  }
}

// The table of docs/validation/contact.md, section Patch.
struct Stated {
  Patch patch;
  PatchErrors error;
};

TEST(PatchTest, is_missed_elsewhere_by_the_stated_errors) {
  constexpr double kLastDigit = 1e-3;
  for (const Stated& stated : {Stated{{4, 5, false}, {0.146, 0.054}},
                               {{5, 4, false}, {0.194, 0.085}},
                               {{8, 4, false}, {0.169, 0.263}},
                               {{4, 5, true}, {0.185, 0.012}},
                               {{8, 10, false}, {0.141, 0.021}},
                               {{8, 10, true}, {0.172, 0.004}}}) {
    const PatchErrors error = patch_errors(stated.patch);
    std::printf("%d under %d cells, %d passes: pressure %.1f %%, displacement %.1f %%\n", stated.patch.lower,
                stated.patch.upper, stated.patch.two_pass ? 2 : 1, 100 * error.pressure,
                100 * error.displacement);
    EXPECT_NEAR(error.pressure, stated.error.pressure, kLastDigit);
    EXPECT_NEAR(error.displacement, stated.error.displacement, kLastDigit);
  }
}

}  // namespace
}  // namespace elastogear::patch_test
