#include "elastogear/contact/station_forces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

constexpr int kMostIterations = 200, kMostHalvings = 40;
constexpr double kConverged =
    1e-10;  // change of forces over the largest one; Newton's next would be its square
constexpr double kNearZero =
    1e-9;                          // forces that are held at zero while their gaps open, over the largest one
constexpr double kDescent = 1e-4;  // L. Armijo's share of the slope
constexpr double kRoundoff = 1e-13;  // of the potential, over its parts
constexpr const char* kRemedy = "take contact at minimum-gap points (-contact_points minima)";

void require_fitting(const StationProblem& problem) {
  const Eigen::Index n = problem.gap.size();
  require(problem.C.rows() == n && problem.C.cols() == n && std::ssize(problem.own) == n, "stations have ",
          problem.C.rows(), " x ", problem.C.cols(), " compliances, ", problem.own.size(), " laws and ", n,
          " gaps, must be n x n, n and n");
  require(problem.gap.allFinite() && problem.C.allFinite(),
          "gaps and compliances of stations must be finite");
  for (const StationLaw& law : problem.own)
    require((law.length > 0 || law.ellipse) && law.radius > 0 && law.compliance > 0,
            "a station has the length ", law.length, " m, the radius ", law.radius, " m and the compliance ",
            law.compliance, " 1/Pa, must be positive");
}

// N: what the deepest station would bear alone, with a pressure a tenth as wide as its strip, or with the
// whole gap taken by a point of contact; 0 where none is pressed.
double first_force(const StationProblem& problem) {
  double largest = 0;
  for (Eigen::Index i = 0; i < problem.gap.size(); ++i) {
    const StationLaw& law = problem.own[static_cast<std::size_t>(i)];
    const double width = 0.1 * law.length;
    const double f = law.ellipse ? std::pow(std::max(-problem.gap[i], 0.) / law.approach(1), 1.5)
                                 : width * width * law.length / (4 * law.compliance * law.radius);
    if (f > 0) largest = std::max(largest, -problem.gap[i] / (std::max(problem.C(i, i), 0.) + law.secant(f)));
  }
  return largest;
}

// The rows of the others are held at zero. Eq. (6.47).
std::vector<int> free_stations(const Eigen::VectorXd& f, const Eigen::VectorXd& gap, double near_zero) {
  std::vector<int> free;
  for (Eigen::Index i = 0; i < f.size(); ++i)
    if (f[i] > near_zero || gap[i] <= 0) free.push_back(static_cast<int>(i));
  return free;
}

// m/N: second derivatives of the potential among stations. Those without a force yet have the slope at
// `typical`.
Eigen::MatrixXd second_derivatives(const StationProblem& problem, const Eigen::VectorXd& f,
                                   const std::vector<int>& among, double typical) {
  Eigen::MatrixXd M = problem.C(among, among);
  for (std::size_t a = 0; a < among.size(); ++a) {
    const StationLaw& law = problem.own[static_cast<std::size_t>(among[a])];
    const double at = f[among[a]] > 0 ? f[among[a]] : typical;
    M(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a)) += law.slope(at);
  }
  return M;
}

Eigen::LLT<Eigen::MatrixXd> factor_of(const Eigen::MatrixXd& derivatives) {
  const Eigen::LLT<Eigen::MatrixXd> factor(derivatives);
  require(factor.info() == Eigen::Success, "the compliance of ", derivatives.rows(),
          " stations in contact is not positive definite: static responses of a flank are wrong or not "
          "symmetric; ",
          kRemedy);
  return factor;
}

// N: where Newton's method goes from f, with what is held at zero. Eq. (6.47).
Eigen::VectorXd newton_target(const StationProblem& problem, const Eigen::VectorXd& f,
                              const Eigen::VectorXd& gap, double typical) {
  const std::vector<int> free = free_stations(f, gap, kNearZero * f.maxCoeff());
  Eigen::VectorXd target = Eigen::VectorXd::Zero(f.size());
  if (free.empty()) return target;
  const Eigen::LLT<Eigen::MatrixXd> factor = factor_of(second_derivatives(problem, f, free, typical));
  const Eigen::VectorXd before = f(free), there = before - factor.solve(gap(free));
  target(free) = there;
  return target;
}

// How large the parts of the potential are, J.
double size_of_potential(const StationProblem& problem, const Eigen::VectorXd& f) {
  double sum = f.dot(problem.gap.cwiseAbs()) + std::abs(f.dot(problem.C * f));
  for (Eigen::Index i = 0; i < f.size(); ++i) sum += problem.own[static_cast<std::size_t>(i)].energy(f[i]);
  return sum;
}

struct Advance {
  Eigen::VectorXd f;
  bool whole;  // not cut
};

// The largest part 1, 1/2, 1/4 ... of the way to the target that lowers the potential.
Advance advance(const StationProblem& problem, const Eigen::VectorXd& f, const Eigen::VectorXd& gap,
                const Eigen::VectorXd& target) {
  const double before = potential(problem, f), roundoff = kRoundoff * size_of_potential(problem, f);
  double part = 1;
  for (int halving = 0; halving <= kMostHalvings; ++halving, part /= 2) {
    Eigen::VectorXd next = (f + part * (target - f)).cwiseMax(0);
    if (potential(problem, next) <= before + kDescent * gap.dot(next - f) + roundoff)
      return {std::move(next), halving == 0};
  }
  fail("forces of stations do not lower their potential, the compliance is not positive definite; ", kRemedy);
}

// Eq. (6.48).
void set_tangent(const StationProblem& problem, StationForces& forces) {
  for (Eigen::Index i = 0; i < forces.f.size(); ++i)
    if (forces.f[i] > 0) forces.active.push_back(static_cast<int>(i));
  const auto n = std::ssize(forces.active);
  if (n == 0) return;
  const Eigen::LLT<Eigen::MatrixXd> factor =
      factor_of(second_derivatives(problem, forces.f, forces.active, 0));
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(n, n));
  forces.stiffness = (inverse + inverse.transpose()) / 2;
}

}  // namespace

double potential(const StationProblem& problem, const Eigen::VectorXd& f) {
  double sum = f.dot(problem.gap + problem.C * f / 2);
  for (Eigen::Index i = 0; i < f.size(); ++i) sum += problem.own[static_cast<std::size_t>(i)].energy(f[i]);
  return sum;
}

Eigen::VectorXd loaded_gaps(const StationProblem& problem, const Eigen::VectorXd& f) {
  Eigen::VectorXd gap = problem.gap + problem.C * f;
  for (Eigen::Index i = 0; i < f.size(); ++i)
    gap[i] += problem.own[static_cast<std::size_t>(i)].approach(f[i]);
  return gap;
}

StationForces station_forces(const StationProblem& problem) {
  require_fitting(problem);
  StationForces forces;
  forces.f = Eigen::VectorXd::Zero(problem.gap.size());
  double typical = first_force(problem);
  bool converged = typical == 0;
  while (!converged) {
    require(++forces.iterations <= kMostIterations, "forces of stations are not found in ", kMostIterations,
            " iterations, the compliance is not positive definite; ", kRemedy);
    const Eigen::VectorXd gap = loaded_gaps(problem, forces.f);
    const Eigen::VectorXd target = newton_target(problem, forces.f, gap, typical);
    Advance to = advance(problem, forces.f, gap, target);
    const double change = (to.f - forces.f).lpNorm<Eigen::Infinity>();
    forces.f = std::move(to.f);
    typical = std::max(forces.f.maxCoeff(), std::numeric_limits<double>::min());
    converged = to.whole && change <= kConverged * typical;
  }
  forces.potential = potential(problem, forces.f);
  set_tangent(problem, forces);
  return forces;
}

}  // namespace elastogear::contact
