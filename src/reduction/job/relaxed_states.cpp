#include "reduction/job/relaxed_states.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-2;           // of a response in the family; those of bodies err by less
constexpr double kInterpolationError = 1e-9;  // relative to the response: is interpolated already
constexpr double kLargestFactor = 3e4;        // of responses in single precision

// Series that differ, and which of them each part has.
struct Series {
  std::vector<const fem::RelaxingModuli*> of;
  std::vector<Index> of_part;
};

Series find_series(const std::vector<fem::RelaxingModuli>& parts) {
  Series series;
  for (const fem::RelaxingModuli& part : parts) {
    const auto at = std::find_if(series.of.begin(), series.of.end(), [&](const fem::RelaxingModuli* other) {
      return other->g == part.g && other->tau == part.tau;
    });
    series.of_part.push_back(at - series.of.begin());
    if (at == series.of.end()) series.of.push_back(&part);
  }
  return series;
}

// gamma of a series at s of the Laplace transform, 1/s. Eq. (2.21).
double relaxed_share(const fem::RelaxingModuli& series, double s) {
  double sum = 0;
  for (std::size_t i = 0; i < series.g.size(); ++i) sum += series.g[i] / (1 + series.tau[i] * s);
  return sum;
}

// n_series x n: gamma from s = infinity, where it is 0, to s = 0.
MatrixXd path(const Series& series) {
  constexpr double kBeyond = 100, kPerDecade = 5;
  double shortest = series.of.front()->tau.front(), longest = shortest;
  for (const fem::RelaxingModuli* one : series.of)
    for (double tau : one->tau) {
      shortest = std::min(shortest, tau);
      longest = std::max(longest, tau);
    }
  const double first = std::log10(kBeyond / shortest), last = -std::log10(kBeyond * longest);
  const auto n = static_cast<Index>(std::ceil(kPerDecade * (first - last)));
  MatrixXd gamma = MatrixXd::Zero(static_cast<Index>(series.of.size()), n + 3);
  for (Index k = 0; k <= n + 1; ++k) {
    const double s =
        k > n ? 0 : std::pow(10, first + (last - first) * static_cast<double>(k) / static_cast<double>(n));
    for (Index p = 0; p < gamma.rows(); ++p)
      gamma(p, k + 1) = relaxed_share(*series.of[static_cast<std::size_t>(p)], s);
  }
  return gamma;
}

void add_points(std::vector<VectorXd>& points, VectorXd& mu, Index at, int left, double step) {
  if (at == mu.size()) {
    points.push_back(mu);
    return;
  }
  for (int i = 0; i <= left; ++i) {
    mu[at] = i * step;
    add_points(points, mu, at + 1, left - i, step);
  }
}

// n x n_series: shares of energy mu >= 0 with a sum of at most 1; the first is 0.
MatrixXd energy_shares(Index n_series) {
  constexpr int kSteps[] = {0, 40, 20, 10, 6, 4, 4, 4, 3};
  const int steps = n_series < 9 ? kSteps[n_series] : 2;
  std::vector<VectorXd> points;
  VectorXd mu(n_series);
  add_points(points, mu, 0, steps, 1. / steps);
  MatrixXd all(static_cast<Index>(points.size()), n_series);
  for (std::size_t i = 0; i < points.size(); ++i) all.row(static_cast<Index>(i)) = points[i];
  return all;
}

// Empirical interpolation of the family of laws 1/(1 - mu.gamma) over the path from the instantaneous to the
// relaxed body: all laws at all points of the path, and which laws and points have been chosen.
struct Choice {
  MatrixXd gamma, mu, L;  // L: of each law at each point of the path
  std::vector<Index> law = {0}, point = {0};

  MatrixXd coefficients() const { return MatrixXd(L(law, point)).partialPivLu().inverse(); }
  // |f - interpolated f| over the largest f, of functions as rows.
  MatrixXd errors(const MatrixXd& f) const {
    const MatrixXd off = f(Eigen::all, point) * coefficients() * L(law, Eigen::all) - f;
    return f.rowwise().maxCoeff().cwiseInverse().asDiagonal() * off.cwiseAbs();
  }
  // Displacements, 1/(1 - mu.gamma), and stresses, (1 - gamma_p)/(1 - mu.gamma).
  double largest_error() const {
    double most = errors(L).maxCoeff();
    for (Index p = 0; p < gamma.rows(); ++p)
      most = std::max(most, errors(L * (1 - gamma.row(p).array()).matrix().asDiagonal()).maxCoeff());
    return most;
  }
};

// Adds the law that errs most, where it errs most; the first at s = 0. Returns whether there was one.
bool add_worst(Choice& choice) {
  const MatrixXd error = choice.errors(choice.L);
  Index law = 0, point = error.cols() - 1;
  const double most = choice.law.size() == 1 ? error.col(point).maxCoeff(&law) : error.maxCoeff(&law, &point);
  if (most < kInterpolationError) return false;
  choice.law.push_back(law);
  choice.point.push_back(point);
  if (choice.coefficients().cwiseAbs().maxCoeff() < kLargestFactor) return true;
  choice.law.pop_back();
  choice.point.pop_back();
  return false;
}

}  // namespace

RelaxedStates choose_relaxed_states(const std::vector<fem::RelaxingModuli>& parts, int n) {
  const auto n_p = static_cast<Index>(parts.size());
  if (parts.empty()) return {};
  const Series series = find_series(parts);
  Choice choice{path(series), energy_shares(static_cast<Index>(series.of.size())), {}};
  choice.L = (1 - (choice.mu * choice.gamma).array()).inverse();
  const int most = n > 0 ? std::min(n, kMostRelaxedStates) : kMostRelaxedStates;
  double error = choice.largest_error();
  while (static_cast<int>(choice.law.size()) <= most && (n > 0 || error > kTolerance) && add_worst(choice))
    error = choice.largest_error();
  const auto n_s = static_cast<Index>(choice.law.size()) - 1;
  RelaxedStates states{MatrixXd(n_p, n_s), MatrixXd::Zero(n_s, n_p), error};
  std::vector<bool> has_law(series.of.size(), false);
  for (Index p = 0; p < n_p; ++p) {
    const Index own = series.of_part[static_cast<std::size_t>(p)];
    for (Index k = 0; k < n_s; ++k) {
      states.share(p, k) = choice.gamma(own, choice.point[static_cast<std::size_t>(k) + 1]);
      if (!has_law[static_cast<std::size_t>(own)])
        states.law(k, p) = choice.mu(choice.law[static_cast<std::size_t>(k) + 1], own);
    }
    has_law[static_cast<std::size_t>(own)] = true;
  }
  return states;
}

}  // namespace elastogear::reduction
