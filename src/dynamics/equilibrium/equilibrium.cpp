#include "dynamics/equilibrium/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/integrator/vec_view.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/pair.h"

namespace elastogear::dynamics {
namespace {

// The joint block of the matrix is C + sigma M: no coordinate is without resistance before contact holds it.
// The relative imbalance scales it down, so that Newton's method converges superlinearly in the end.
// docs/theory, Eq. (8.19).
constexpr double kResistance = 1;         // 1/s^2, sigma at full imbalance
constexpr double kFreeResistance = 1e-6;  // 1/s^2, while no bodies touch: they go as far as they may
constexpr double kDistancePerDepth =
    0.5;                       // that a surface may go in one iteration, as a share of the contact depth
constexpr double kTurn = 0.3;  // rad, that a body may
constexpr int kMostIterations = 300;    // contact that is far away is approached depth by depth
constexpr double kSmallestStep = 1e-3;  // of the first one
constexpr double kStepRoundoff = 1e-9;  // of a load step
constexpr int kMostRounds = 60;         // of equilibria, until gaps are closed
constexpr double kRoundoff = 1e-13;     // of coordinates in rad and m: smaller changes are none
constexpr double kClosed = 1e-6;        // of the depth, by which points that carry forces may be open
constexpr double kFall = 0.3;           // by which a round should lessen that
constexpr double kStiffer = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostSeeking = 12;            // evaluations in which forces need not be exact
constexpr double kLoose = 1e-3;             // of the last imbalance, by which forces of contact may err
constexpr double kLeastForceError = 1e-10;  // of the forces, which always may
constexpr double kHeldBySigma = 0.5;  // share of sigma in a coordinate's stiffness: nothing else holds it

// Do the bodies of each pair touch?
std::vector<bool> touching(Equilibrium& at, ConstVector U) {
  std::vector<bool> touch;
  for (const PairContacts& pair : at.problem.system.contacts(at.factor, U, at.zero).pair)
    touch.push_back(!pair.points.empty());
  return touch;
}

bool any_touch(Equilibrium& at, ConstVector U) {
  const std::vector<bool> touch = touching(at, U);
  return std::find(touch.begin(), touch.end(), true) != touch.end();
}

// Without load an overlap's forces vanish as it goes: what is left of them is small against what they were.
void remember_scale(Equilibrium& at) {
  Eigen::VectorXd& scale = at.problem.residual.scale;
  if (at.unloaded_scale.size() == scale.size()) scale = scale.cwiseMax(at.unloaded_scale);
  at.unloaded_scale = scale;
}

// Evaluates the forces; false where there are none. Those of contact are as exact as Newton's method needs
// them: in the end as all forces in balance are.
bool evaluate(Equilibrium& at, ConstVector U) {
  constexpr double kErrorShare = 0.1;  // of the imbalance, below which an error of forces does not count
  Problem& problem = at.problem;
  const bool seeks = at.n_to_seek > 0;
  if (seeks) --at.n_to_seek;
  double tolerance = seeks ? std::clamp(kLoose * at.last_imbalance, kLeastForceError, kLoose) : 0;
  while (true) {
    problem.system.begin_equilibrium_search(tolerance);
    if (!is_admissible(problem, at.factor, U, Eigen::VectorXd::Zero(U.size()))) return false;
    problem.residual = problem.system.residual(at.state(U));
    at.last_imbalance = imbalance(problem.residual);
    if (tolerance <= std::max(kLeastForceError, kErrorShare * at.last_imbalance)) return true;
    tolerance = kLeastForceError;
  }
}

PetscErrorCode function(SNES snes, Vec U, Vec F, void* ctx) {
  auto& at = *static_cast<Equilibrium*>(ctx);
  return guard(at.problem.pending, [&] {
    at.problem.pulse();
    const ReadView u(U);
    if (!evaluate(at, *u)) return check(SNESSetFunctionDomainError(snes));
    if (at.factor == 0) remember_scale(at);
    assign(F, at.problem.residual.F);
  });
}

PetscErrorCode jacobian(SNES, Vec U, Mat J, Mat P, void* ctx) {
  auto& at = *static_cast<Equilibrium*>(ctx);
  return guard(at.problem.pending, [&] {
    at.problem.pulse();
    const ReadView u(U);
    const double sigma = (any_touch(at, *u) ? kResistance : kFreeResistance) * imbalance(at.problem.residual);
    EffectiveMatrix A = at.problem.system.effective_matrix(at.state(*u), {0, 0});
    EffectiveMatrix resisting = at.problem.system.effective_matrix(at.state(*u), {0, sigma});
    at.resistance.clear();
    for (std::size_t b = 0; b < A.body.size(); ++b) {
      at.resistance.push_back((resisting.body[b].C - A.body[b].C).diagonal());
      A.body[b].C = std::move(resisting.body[b].C);
    }
    at.problem.solver.set(std::move(A));
    assemble(J, P);
  });
}

// Largest distance of a node, m.
double distance(const model::Surface& surface, const contact::SurfaceMotion& from,
                const contact::SurfaceMotion& to) {
  const contact::SurfaceState a = contact::surface_state(surface, from),
                              b = contact::surface_state(surface, to);
  const Eigen::Matrix3Xd moved = (b.R_WB * b.x_B - a.R_WB * a.x_B).colwise() + (b.r_WB - a.r_WB);
  return std::sqrt(moved.colwise().squaredNorm().maxCoeff());
}

// Largest change of a rotation, rad; places alone do not tell of whole turns.
double largest_turn(const System& system, const Eigen::VectorXd& change) {
  double largest = 0;
  for (const System::Body& body : system.bodies())
    for (Eigen::Index i = 0; i < body.n_open(); ++i)
      if (body::is_angle(body.eq.joint.type, body.open[static_cast<std::size_t>(i)]))
        largest = std::max(largest, std::abs(change[body.first + i]));
  return largest;
}

// How much too far a change of U goes: at most 1 when every body and surface stays within its limit.
double excess(Equilibrium& at, const Eigen::VectorXd& U, const Eigen::VectorXd& to) {
  System& system = at.problem.system;
  const Eigen::VectorXd V = Eigen::VectorXd::Zero(U.size());
  std::vector<contact::SurfaceMotion> before, after;
  double most = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    before.push_back(system.surface_motion(b, at.factor, U, V));
    after.push_back(system.surface_motion(b, at.factor, to, V));
    most = std::max(most, (after[b].R_WB - before[b].R_WB).norm() / std::sqrt(2.0) / kTurn);
  }
  for (std::size_t p = 0; p < system.pairs().size(); ++p)
    for (int side : {0, 1}) {
      const int b = system.pairs()[p].body[side];
      const double allowed = kDistancePerDepth * system.contact_settings(p).depth;
      if (system.detector(p).travel(side, before[b], after[b]) <= allowed) continue;
      most = std::max(most, distance(system.bodies()[b].eq.body->surface, before[b], after[b]) / allowed);
    }
  return most;
}

// Forces of contact have kinks, between which Newton's method may go round without an end; shorter steps end
// on one. They have small jumps, too, where contacts open and close: on one of them no state is in
// balance, and the one beside it is taken. Without load flanks in touch may press on each other by roundoff
// alone, all of which may stay.
double damping(Equilibrium& at, SNESLineSearch search, const Eigen::VectorXd& change) {
  constexpr int kPatience = 4, kInVain = 12;  // iterations in which the imbalance has hardly fallen
  constexpr double kStagnationRatio = 0.9;
  SNES snes = nullptr;
  PetscInt iteration = 0;
  PetscReal norm = 0;
  check(SNESLineSearchGetSNES(search, &snes));
  check(SNESGetIterationNumber(snes, &iteration));
  check(SNESGetFunctionNorm(snes, &norm));
  if (iteration == 0 || norm < kStagnationRatio * at.least_norm) {
    at.least_norm = norm;
    at.n_in_vain = 0;
  } else {
    ++at.n_in_vain;
    const bool by_roundoff = at.factor == 0 && change.norm() <= kRoundoff;
    if (at.n_in_vain >= kInVain) at.problem.slack = by_roundoff ? 1 : at.jump;
  }
  return at.n_in_vain < kPatience ? 1 : 0.5;
}

// Share of a change of U until pairs that are apart touch; 1 when they stay apart. Looked for from below:
// contact of bodies that penetrate each other deeply takes long to compute.
double until_touch(Equilibrium& at, const Eigen::VectorXd& U, const Eigen::VectorXd& change) {
  constexpr int kBisections = 8;
  constexpr double kLeast = 1e-6;
  if (change.norm() <= kRoundoff) return 1;
  const Eigen::VectorXd V = Eigen::VectorXd::Zero(U.size());
  const std::vector<bool> before = touching(at, U);
  if (std::find(before.begin(), before.end(), false) == before.end()) return 1;
  const auto meets = [&](double share) {
    const Eigen::VectorXd to = U - share * change;
    if (!is_admissible(at.problem, at.factor, to, V)) return true;
    const std::vector<bool> after = touching(at, to);
    for (std::size_t p = 0; p < after.size(); ++p)
      if (after[p] && !before[p]) return true;
    return false;
  };
  double apart = 0, met = kLeast;
  for (; !meets(met); met = std::min(1.0, 2 * met)) {
    if (met == 1) return 1;
    apart = met;
  }
  for (int i = 0; apart > 0 && i < kBisections; ++i) {
    const double share = (apart + met) / 2;
    (meets(share) ? met : apart) = share;
  }
  return met;
}

// Surfaces must not pass through each other unseen, and bodies that are apart not go deep into each other.
PetscErrorCode limit(SNESLineSearch search, Vec X, Vec Y, PetscBool* changed, void* ctx) {
  auto& at = *static_cast<Equilibrium*>(ctx);
  return guard(at.problem.pending, [&] {
    const ReadView x(X);
    Eigen::VectorXd y = *ReadView(Y);
    if (!y.allFinite()) return;
    double share = damping(at, search, y);
    share = std::min(share, kTurn / largest_turn(at.problem.system, y));
    y *= share;
    while (true) {
      const double too_far = excess(at, *x, *x - y);
      if (too_far <= 1) break;
      share = std::min(0.5, 1 / too_far);  // rotations are not linear in y: look again
      y *= share;
    }
    const double met = until_touch(at, *x, y);
    y *= met;
    *changed = share * met < 1 ? PETSC_TRUE : PETSC_FALSE;
    if (*changed) assign(Y, y);
  });
}

std::string coordinate_name(body::JointType type, Eigen::Index i) {
  constexpr const char* kFree[] = {
      "x", "y", "z", "the rotation about x", "the rotation about y", "the rotation about z"};
  if (body::has_rotation_vector(type)) return kFree[i + 6 - body::coordinate_count(type)];
  return body::is_angle(type, i) ? "the rotation about its axis" : "the displacement along its axis";
}

// Names of the coordinates that only sigma holds.
std::string free_coordinates(const Equilibrium& at) {
  std::string names;
  const System& system = at.problem.system;
  for (std::size_t b = 0; b < at.resistance.size(); ++b) {
    const System::Body& body = system.bodies()[b];
    for (Eigen::Index i = 0; i < body.n_open(); ++i) {
      const Eigen::VectorXd force = Eigen::VectorXd::Unit(system.size(), body.first + i);
      const double flexibility = at.problem.solver.solve(force)[body.first + i];
      if (!(std::abs(flexibility * at.resistance[b][i]) > kHeldBySigma)) continue;
      names += (names.empty() ? "" : ", ") + ("body '" + body.name + "': ") +
               coordinate_name(body.eq.joint.type, body.open[static_cast<std::size_t>(i)]);
    }
  }
  return names;
}

[[noreturn]] void fail_without_equilibrium(const Equilibrium& at) {
  const std::string free = free_coordinates(at);
  require(free.empty(), "no equilibrium at load factor ", at.factor,
          ": nothing holds (neither contact nor a spring) ", free);
  const std::vector<PairSetup>& pairs = at.problem.system.pairs();
  const bool has_penalty = std::any_of(pairs.begin(), pairs.end(), [](const PairSetup& pair) {
    return pair.settings.law == contact::ContactLaw::penalty;
  });
  fail("no equilibrium found at load factor ", at.factor, ": ", trouble_of(at),
       ". Try more load steps (-static_steps)", has_penalty ? ", a smaller -contact_stiffness," : "",
       " or -analysis relax");
}

// n_seeking: evaluations in which contact need not be more exact than the imbalance asks.
bool solve(Equilibrium& at, SNES snes, Vec U, RunSummary& summary, int n_seeking = 0) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  at.problem.trouble.clear();
  at.problem.slack = 0;
  at.n_to_seek = n_seeking;
  at.last_imbalance = 1;
  check(SNESSolve(snes, nullptr, U), at.problem.pending);
  at.problem.system.begin_equilibrium_search(0);
  check(SNESGetConvergedReason(snes, &reason));
  check(SNESGetIterationNumber(snes, &iterations));
  summary.newton_iterations += iterations;
  if (reason > 0 && at.problem.slack == at.jump)
    summary.unbalanced = std::max(summary.unbalanced, imbalance(at.problem.residual));
  return reason > 0;
}

}  // namespace

std::string trouble_of(const Equilibrium& at) {
  return at.problem.trouble.empty() ? "Newton's method does not converge" : at.problem.trouble;
}

UniqueSNES make_snes(Equilibrium& at, UniqueMat& J) {
  UniqueSNES snes;
  check(SNESCreate(PETSC_COMM_SELF, snes.out()));
  make_matrix(at.problem, J);
  check(SNESSetFunction(snes, nullptr, function, &at));
  check(SNESSetJacobian(snes, J, J, jacobian, &at));
  set_solvers(at.problem, snes);
  check(SNESSetTolerances(snes, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, kMostIterations,
                          std::numeric_limits<PetscInt>::max()));
  SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes, &search));
  check(SNESLineSearchSetPreCheck(search, limit, &at));
  check(SNESSetFromOptions(snes));
  return snes;
}

// By how much points that carry forces may be open, as a share of the depth. Nodes beside a local minimum-gap
// point are open by nanometres, and the force is not theirs to bear.
double allowed_open(const System& system) {
  constexpr double kBesideMinima = 1e-2;
  const auto& pairs = system.pairs();
  const bool minima = std::any_of(pairs.begin(), pairs.end(), [](const PairSetup& pair) {
    return pair.settings.points == contact::SlavePoints::minima;
  });
  return minima ? kBesideMinima * kClosed : kClosed;
}

// Points of contact that vanish stay where they were found, in states that may be far from the equilibrium:
// the search goes on from there without them, until none stays or they stay where they should.
bool settle_points(Equilibrium& at, SNES snes, Vec U, RunSummary& summary) {
  constexpr int kMostReleases = 3;
  for (int round = 0; round < kMostReleases; ++round) {
    if (!at.problem.system.release_points()) return true;
    if (!solve(at, snes, U, summary)) return false;
  }
  return true;
}

// Equilibria from which to which the gaps of the augmented law close, faster where they hardly do: Eq.
// (6.31).
bool find_equilibrium(Equilibrium& at, SNES snes, Vec U, RunSummary& summary) {
  System& system = at.problem.system;
  if (!solve(at, snes, U, summary, at.begins_near ? kMostSeeking : 0) || !settle_points(at, snes, U, summary))
    return false;
  double before = kInfinity;
  for (int round = 0; system.any_augmented(); ++round) {
    const ReadView u(U);
    system.contacts(at.factor, *u, at.zero);
    const double left = system.unclosed();
    if (left <= allowed_open(system)) return true;
    if (round == kMostRounds) break;
    system.augment();
    if (left > kFall * before) system.stiffen(kStiffer);
    before = left;
    if (!solve(at, snes, U, summary)) return false;
  }
  return !system.any_augmented();
}

LoadPath::LoadPath(const System& system, int steps)
    : U(vector(system.initial_position())),
      good(system.initial_position()),
      first_step(1.0 / steps),
      step(1.0 / steps),
      least_step(kSmallestStep / steps) {}

bool advance(Equilibrium& at, SNES snes, LoadPath& path, RunSummary& summary) {
  const bool last = path.reached + (1 + kStepRoundoff) * path.step >= 1;
  at.factor = path.reached < 0 ? 0 : last ? 1 : path.reached + path.step;
  if (!find_equilibrium(at, snes, path.U, summary)) {
    ++summary.rejected_steps;
    path.step /= 2;
    if (path.reached < 0 || path.step < path.least_step) fail_without_equilibrium(at);
    assign(path.U, path.good);
    if (!path.pairs.empty()) at.problem.system.set_forces(path.pairs);
    return false;
  }
  ++summary.steps;
  path.reached = at.factor;
  path.step = std::min(2 * path.step, path.first_step);
  path.good = *ReadView(path.U);
  path.pairs = at.problem.system.contacts(at.factor, path.good, at.zero).pair;
  return true;
}

void request_stop(Equilibrium& at, const std::function<bool()>& stop) {
  if (!stop) return;
  at.problem.pulse = [stop] {
    if (stop()) throw Interrupted();
  };
  at.problem.solver.on_solve(at.problem.pulse);
}

}  // namespace elastogear::dynamics
