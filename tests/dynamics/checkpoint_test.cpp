// A run that goes on from a checkpoint equals the uninterrupted one to the bit.
#include <gmock/gmock.h>

#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::checkpoint_test {
using namespace dynamics;

namespace {

// Residual flexibility of the box, with one law of contact or the other, without a penalty also over faces;
// or impacts without both.
enum class Residual { none, penalty, unilateral, faces, impacts, relaxing };

// flexible: with residual flexibility, of few modes. relaxing: viscoelastic.
std::shared_ptr<const model::ElasticBody> soft_box(model::Basis basis, bool flexible, bool relaxing) {
  test::BoxSpec box{.size = {1, 1, 1}, .cells = {2, 2, 2}, .material = {100, 0.3, 1}};
  box.held = [](const auto& X, int) { return X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(flexible ? test::make_flexible_box(box, 5)
                                                            : test::make_box(box, basis));
  if (relaxing)
    body->relaxing = {
        {"", model::ModulusPart::both, Eigen::Vector2d(0.3, 0.2), Eigen::Vector2d(0.02, 1), body->K_r}};
  return body;
}

// A soft box, held at one end, flies and tumbles against a rigid wall.
System impact(model::Basis basis, Residual residual = Residual::none) {
  const auto wall = std::make_shared<model::ElasticBody>(
      test::make_rigid_box({.corner = {0, -1, -1}, .size = {1, 3, 3}, .material = {100, 0.3, 1}}));
  PairSetup pair{"box:wall", {0, 1}, {}};
  pair.settings.two_pass = residual != Residual::faces;
  if (residual == Residual::faces) pair.settings.points = contact::SlavePoints::faces;
  if (residual == Residual::impacts) pair.settings.law = contact::ContactLaw::unilateral;
  pair.settings.skin = 0.01;
  if (residual == Residual::none || residual == Residual::penalty)
    pair.settings.hysteresis = 0.1;  // which is a penalty's
  pair.settings.friction = {.mu = 0.3, .law = contact::FrictionLaw::stick};
  const body::JointType joint =
      basis == model::Basis::full ? body::JointType::spherical : body::JointType::free;
  BodySetup box{.name = "box",
                .body = soft_box(basis,
                                 residual == Residual::penalty || residual == Residual::unilateral ||
                                     residual == Residual::faces,
                                 residual == Residual::relaxing),
                .joint = {.type = joint},
                .omega0 = {0, 0.3, 0.2}};
  if (joint == body::JointType::free) box.velocity0 = {0.3, 0.1, 0};
  return System({box, {.name = "wall", .body = wall, .joint = {.r_WB0 = {1.001, 0, 0}}}}, {pair});
}

using Rows = std::vector<std::vector<double>>;

struct Recording {
  Rows rows;
  std::vector<std::vector<double>> states;
};

Observer into(Rows& rows) {
  return [&rows](const model::Snapshot& s) {
    std::vector<double> row{s.time, s.energy.work, s.energy.dissipated, s.energy.balance,
                            double(s.pairs[0].count)};
    for (const model::BodyState& body : s.bodies)
      for (const Eigen::VectorXd& x :
           {body.s, body.s_dot, body.s_ddot, body.q, body.q_dot, body.q_ddot, body.q_error})
        row.insert(row.end(), x.begin(), x.end());
    for (const model::ContactRecord& c : s.pairs[0].contacts)
      row.insert(row.end(), {double(c.face), c.xi, c.eta, c.g_n, c.f.x(), c.f.y(), c.f.z()});
    rows.push_back(row);
  };
}

const TimeSettings kSettings{.dt = 0.004, .end_time = 0.4, .rho_inf = 0.8};

Recording record(System system, const TimeSettings& settings = kSettings) {
  Recording recording;
  Checkpoints checkpoints{.every = 0};
  checkpoints.keep = [&](const auto& state) { recording.states.push_back(state); };
  simulate(system, settings, into(recording.rows), {}, checkpoints);
  return recording;
}

void expect_every_continuation_equal(model::Basis basis, const TimeSettings& settings = kSettings,
                                     Residual residual = Residual::none) {
  const Recording whole = record(impact(basis, residual), settings);
  ASSERT_GE(whole.states.size(), 70u);
  double contacts = 0;
  for (std::size_t k = 0; k < whole.states.size(); k += 7) {
    System system = impact(basis, residual);
    Rows rows;
    const Checkpoints checkpoints{.state = whole.states[k]};
    simulate(system, settings, into(rows), {}, checkpoints);
    const Rows expected(whole.rows.end() - static_cast<std::ptrdiff_t>(rows.size()), whole.rows.end());
    EXPECT_EQ(rows, expected) << "from checkpoint " << k;
    if (settings.output_dt == 0) {
      EXPECT_EQ(rows.size() + k + 2, whole.rows.size());  // the first state is that after the first step
    }
    for (const auto& row : rows) contacts += row[4];
  }
  EXPECT_GT(contacts, 10);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit) {
  expect_every_continuation_equal(model::Basis::modal);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_in_the_full_basis) {
  expect_every_continuation_equal(model::Basis::full);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_with_residual_flexibility) {
  expect_every_continuation_equal(model::Basis::modal, kSettings, Residual::penalty);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_without_a_penalty) {
  expect_every_continuation_equal(model::Basis::modal, kSettings, Residual::unilateral);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_over_faces_that_stick) {
  expect_every_continuation_equal(model::Basis::modal, kSettings, Residual::faces);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_with_impacts) {
  expect_every_continuation_equal(model::Basis::modal, kSettings, Residual::impacts);
}

TEST(Checkpoint, continuation_equals_the_whole_run_to_the_bit_where_materials_relax) {
  expect_every_continuation_equal(model::Basis::modal, kSettings, Residual::relaxing);
  TimeSettings settings = kSettings;
  settings.step_tolerance = 2e-7;
  settings.output_dt = 0.003;
  expect_every_continuation_equal(model::Basis::full, settings, Residual::relaxing);
}

TEST(Checkpoint, continuation_of_a_settling_run_equals_the_whole_one_to_the_bit) {
  TimeSettings settings = kSettings;
  settings.relax = true;
  expect_every_continuation_equal(model::Basis::modal, settings);
}

TEST(Checkpoint, continuation_with_step_control_and_interpolated_output_equals_the_whole_run_to_the_bit) {
  TimeSettings settings = kSettings;
  settings.step_tolerance = 1e-6;
  settings.output_dt = 0.003;
  expect_every_continuation_equal(model::Basis::modal, settings);
}

TEST(Checkpoint, continuation_with_steps_that_the_run_chooses_equals_the_whole_run_to_the_bit) {
  TimeSettings settings = kSettings;
  settings.dt = 0;
  settings.step_error = 2e-4;
  settings.output_dt = 0.003;
  expect_every_continuation_equal(model::Basis::modal, settings);
}

// In sums of steps as floating-point numbers the last one may end on time without being what is left.
TEST(Checkpoint, continuation_into_the_last_step_equals_the_whole_run_to_the_bit) {
  for (std::size_t n = 3; n < 20; ++n) {
    TimeSettings settings = kSettings;
    settings.dt = 0.005;
    settings.end_time = static_cast<double>(n) * settings.dt;
    const Recording whole = record(impact(model::Basis::modal), settings);
    System system = impact(model::Basis::modal);
    Rows rows;
    ASSERT_EQ(whole.rows.size(), n + 1);
    simulate(system, settings, into(rows), {}, {.state = whole.states[n - 2]});
    ASSERT_LE(rows.size(), 2u);
    EXPECT_EQ(rows.back(), whole.rows.back()) << n << " steps";
  }
}

TEST(Checkpoint, stop_ends_the_run_with_a_state_to_go_on_from) {
  System first = impact(model::Basis::modal), second = impact(model::Basis::modal);
  Rows rows;
  std::vector<double> state;
  Checkpoints checkpoints{.every = 1e9};
  checkpoints.keep = [&](const auto& s) { state = s; };
  checkpoints.stop = [&] { return rows.size() == 30; };
  checkpoints.patience = 1e9;
  const RunSummary summary = simulate(first, kSettings, into(rows), {}, checkpoints);
  EXPECT_FALSE(summary.complete);
  EXPECT_EQ(rows.size(), 31u);  // the step after which it was asked
  ASSERT_FALSE(state.empty());
  EXPECT_TRUE(simulate(second, kSettings, into(rows), {}, {.state = state}).complete);
  EXPECT_EQ(rows, record(impact(model::Basis::modal)).rows);
}

// Asked to stop at its n-th question, in a step or between two, a run ends there and loses nothing.
void expect_given_up_steps_lose_nothing(model::Basis basis, const std::vector<int>& questions) {
  const Rows whole = record(impact(basis)).rows;
  int resumed = 0;
  for (int n : questions) {
    System first = impact(basis), second = impact(basis);
    Rows rows;
    std::vector<double> state;
    int asked = 0;
    Checkpoints checkpoints{.every = 1e9, .patience = 0};
    checkpoints.keep = [&](const auto& s) { state = s; };
    checkpoints.stop = [&] { return ++asked >= n; };
    const RunSummary run = simulate(first, kSettings, into(rows), {}, checkpoints);
    EXPECT_FALSE(run.complete);
    EXPECT_EQ(asked, n) << "evaluated further";
    if (state.empty()) continue;  // before the first state was known
    EXPECT_TRUE(simulate(second, kSettings, into(rows), {}, {.state = state}).complete);
    EXPECT_EQ(rows, whole) << n;
    ++resumed;
  }
  EXPECT_GE(resumed, static_cast<int>(questions.size()) - 2);
}

TEST(Checkpoint, a_step_given_up_is_done_again_to_the_bit) {
  expect_given_up_steps_lose_nothing(model::Basis::modal,
                                     {1, 2, 6, 20, 21, 22, 23, 24, 25, 26, 27, 28, 300, 555});
  expect_given_up_steps_lose_nothing(model::Basis::full, {3, 30, 31, 32, 33, 34, 400, 401});
}

TEST(Checkpoint, of_another_system_is_refused) {
  const Recording whole = record(impact(model::Basis::modal));
  const auto rigid = std::make_shared<model::ElasticBody>(test::make_rigid_box({.material = {1, 0, 1}}));
  System other({{.name = "box", .body = rigid, .joint = {body::JointType::free}}}, {});
  EXPECT_THROW(simulate(other, kSettings, {}, {}, {.state = whole.states[3]}), Error);
}

// As a program leaves them that keeps other numbers: one fewer, wherever it is, or one more.
TEST(Checkpoint, of_another_program_is_refused) {
  const std::vector<double> state = record(impact(model::Basis::modal)).states[3];
  const auto message = [](const std::vector<double>& other) -> std::string {
    System same = impact(model::Basis::modal);
    try {
      simulate(same, kSettings, {}, {}, {.state = other});
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    std::vector<double> other = state;
    other.erase(other.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_THAT(message(other), testing::HasSubstr("another version of the program"))
        << i << " of " << state.size();
  }
  std::vector<double> more = state;
  more.push_back(0);
  EXPECT_THAT(message(more), testing::HasSubstr("another version of the program"));
}

}  // namespace
}  // namespace elastogear::checkpoint_test
