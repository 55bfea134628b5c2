// Where the time of one stage of the integrator goes at many active contacts: search, forces, tangent, linear
// solve, beside the bytes of the surface bases that they must read.
//
//   benchmark_stage WORM.h5 WHEEL.h5 [contacts]
//
// The bodies of examples/worm_gear; the wheel turns into the worm until so many contacts are active (default
// 100), and from there back and forth at 14 rad/s in stages of 0.5 us. CPU time of one thread,
// medians. Contact without a penalty is among them where both bodies have residual flexibility.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/integrator/problem.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/contact/pair.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/system.h"
#include "elastogear/io/body_file.h"

namespace {

using namespace elastogear;
using namespace elastogear::dynamics;

constexpr double kSpeed = 14, kStage = 0.5e-6;  // rad/s, s
constexpr double kVibration = 1e-13;            // m sqrt(kg), next to nothing, but all positions change
constexpr int kStages = 200, kThere = 10;       // stages in all, and before the wheel turns back

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Since the last call with this clock, s.
double lap(double& last) {
  const double t = now();
  return t - std::exchange(last, t);
}

std::shared_ptr<const model::ElasticBody> read(const char* path) {
  return std::make_shared<model::ElasticBody>(io::read_body(path, io::BodyUse::motion));
}

struct Laws {
  const char* name;
  contact::ContactLaw law;
  contact::ContactSurface surface;
  double mu, hysteresis;
};

System drive(const Laws& laws, const std::shared_ptr<const model::ElasticBody>& worm,
             const std::shared_ptr<const model::ElasticBody>& wheel) {
  const double quarter = std::numbers::pi / std::numbers::sqrt2;
  BodySetup held{.name = "worm", .body = worm};
  held.joint.r_WB0 = {0, 0.05, 0};
  held.joint.R_WB0 = rotation_matrix(Eigen::Vector3d(quarter, 0, quarter));
  BodySetup turning{.name = "wheel", .body = wheel};
  turning.joint.type = body::JointType::revolute;
  turning.rotation.s_0 = std::numbers::pi / 41;
  turning.rotation.s_dot_0 = kSpeed;
  PairSetup pair{"worm:wheel", {0, 1}, {}};
  pair.settings.two_pass = true;
  pair.settings.law = laws.law;
  pair.settings.surface = laws.surface;
  pair.settings.hysteresis = laws.hysteresis;
  pair.settings.friction = {.mu = laws.mu, .v_0 = 1e-3};
  return System({held, turning}, {pair});
}

// CPU time of each part of the stages, s. contacts: detection, positions of the touched nodes and, without a
// penalty, the forces.
struct Times {
  std::vector<double> detection, contacts, residual, matrix, factorisation, solve;
  double displaced = 0;  // nodes, sum over the stages
};

std::size_t contact_count(System& system, const Eigen::VectorXd& U, const Eigen::VectorXd& V) {
  return system.contacts(0, U, V).pair[0].points.size();
}

// The wheel's angle is the first entry after the worm's elastic coordinates.
Eigen::VectorXd touching(System& system, std::size_t contacts, Eigen::Index angle) {
  constexpr double kTurn = 1e-5;
  Eigen::VectorXd U = system.initial_position();
  for (int i = 0; i < 1000 && contact_count(system, U, system.initial_velocity()) < contacts; ++i)
    U[angle] += kTurn;
  return U;
}

contact::Pair detector(const System& system) {
  const model::ElasticBody &worm = *system.bodies()[0].eq.body, &wheel = *system.bodies()[1].eq.body;
  return {worm.surface, wheel.surface, system.pairs()[0].settings, {&worm.K_r, &wheel.K_r}};
}

Times run(System& system, Eigen::VectorXd U, Eigen::Index angle) {
  LowRankSolver solver(system.solver_bodies());
  contact::Pair pair = detector(system);
  const Eigen::VectorXd V = system.initial_velocity(), A = Eigen::VectorXd::Zero(system.size());
  const body::Shifts shift{1 / kStage, 1 / (kStage * kStage)};
  Times times;
  for (int i = 0; i < kStages; ++i) {
    // At random: displacements that are combinations of those of earlier stages need no rows of the basis.
    U.head(angle) = kVibration * Eigen::VectorXd::Random(angle);
    U.tail(U.size() - angle - 1) = kVibration * Eigen::VectorXd::Random(U.size() - angle - 1);
    U[angle] += (i / kThere % 2 == 0 ? -1 : 1) * kSpeed * kStage;
    const State x{i * kStage, U, V, A};
    const contact::SurfaceMotion worm = system.surface_motion(0, x.time, U, V),
                                 wheel = system.surface_motion(1, x.time, U, V);
    double clock = now();
    pair.detect(worm, wheel);
    times.detection.push_back(lap(clock));
    times.displaced += pair.n_displaced();
    system.contacts(x.time, U, V);
    times.contacts.push_back(lap(clock));
    const Residual r = system.residual(x);
    times.residual.push_back(lap(clock));
    EffectiveMatrix matrix = system.effective_matrix(x, shift);
    times.matrix.push_back(lap(clock));
    solver.set(std::move(matrix));
    times.factorisation.push_back(lap(clock));
    const Eigen::VectorXd step = solver.solve(r.F, left_of_step(unbalanced_at(TimeSettings{}.step_error)));
    times.solve.push_back(lap(clock));
    require(step.allFinite(), "the step is not finite");
  }
  return times;
}

// The median, which other programs disturb least.
void print(const char* what, std::vector<double> seconds) {
  const auto middle = seconds.begin() + kStages / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  std::printf("  %-34s %9.1f us\n", what, 1e6 * *middle);
}

// Of memory that is in no cache, B/s.
double read_speed() {
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(1 << 26);
  const double start = now(), sum = x.sum(), end = now();
  require(sum > 0, "no sum");
  return 8. * static_cast<double>(x.size()) / (end - start);
}

void run(int argc, char** argv) {
  require(argc > 2, "usage: benchmark_stage WORM.h5 WHEEL.h5 [contacts]");
  const auto worm = read(argv[1]), wheel = read(argv[2]);
  const std::size_t contacts = argc > 3 ? std::stoul(argv[3]) : 100;
  std::printf("one thread reads memory at %.1f GB/s\n", read_speed() / 1e9);
  using contact::ContactLaw, contact::ContactSurface;
  std::vector<Laws> all{
      {"penalty on facets", ContactLaw::penalty, ContactSurface::facets, 0, 0},
      {"penalty on smooth surfaces", ContactLaw::penalty, ContactSurface::smooth, 0, 0},
      {"the same with friction, damping", ContactLaw::penalty, ContactSurface::smooth, 0.1, 0.1}};
  if (!worm->flexibility.empty() && !wheel->flexibility.empty())
    all.push_back({"no penalty on smooth surfaces", ContactLaw::unilateral, ContactSurface::smooth, 0, 0});
  for (const Laws& laws : all) {
    System system = drive(laws, worm, wheel);
    const Eigen::Index angle = worm->n_q();
    const Eigen::VectorXd U = touching(system, contacts, angle);
    std::printf("%s: %zu contacts, %d and %d modes\n", laws.name,
                contact_count(system, U, system.initial_velocity()), static_cast<int>(worm->n_q()),
                static_cast<int>(wheel->n_q()));
    const Times times = run(system, U, angle);
    const double row = 24e-6 * static_cast<double>(worm->n_q());  // MB, of a node
    const ContactState& state = system.contacts(0, U, system.initial_velocity());
    std::printf("  rows of the %.0f nodes placed by detection: %.2f MB; of the touched: %.2f MB\n",
                times.displaced / kStages, row * times.displaced / kStages,
                row * static_cast<double>(state.force[0].node.size() + state.force[1].node.size()));
    print("detection: search, gaps, laws", times.detection);
    print("with positions of touched nodes", times.contacts);
    print("residual with generalised forces", times.residual);
    print("tangent", times.matrix);
    print("factorisation of the dense system", times.factorisation);
    print("solve", times.solve);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  try {
    run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
