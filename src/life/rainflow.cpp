#include "elastogear/life/rainflow.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::life {
namespace {

// Begins and ends with the largest value, so that all that lies between closes cycles.
Eigen::VectorXd from_largest(const Eigen::VectorXd& history) {
  Eigen::Index first = 0;
  history.maxCoeff(&first);
  const Eigen::Index n = history.size(), tail = n - first;
  Eigen::VectorXd turned(n + 1);
  turned << history.tail(tail), history.head(first), history[first];
  return turned;
}

Cycle cycle(double a, double b, double count) { return {std::abs(a - b), (a + b) / 2, count}; }

// Counts what the newest point closes. points: those that are not discarded yet.
void count_closed(std::vector<double>& points, Ends ends, std::vector<Cycle>& cycles) {
  while (points.size() >= 3) {
    const std::size_t n = points.size();
    const double x = std::abs(points[n - 1] - points[n - 2]), y = std::abs(points[n - 2] - points[n - 3]);
    if (x < y) return;
    const bool holds_start = n == 3 && ends == Ends::open;
    cycles.push_back(cycle(points[n - 3], points[n - 2], holds_start ? 0.5 : 1));
    if (holds_start)
      points.erase(points.begin());
    else
      points.erase(points.end() - 3, points.end() - 1);
  }
}

}  // namespace

std::vector<double> turning_points(const Eigen::VectorXd& history) {
  std::vector<double> points;
  for (double value : history) {
    const std::size_t n = points.size();
    if (n > 0 && value == points[n - 1]) continue;
    if (n > 1 && (value > points[n - 1]) == (points[n - 1] > points[n - 2]))
      points.back() = value;
    else
      points.push_back(value);
  }
  return points;
}

std::vector<Cycle> rainflow(const Eigen::VectorXd& history, Ends ends) {
  require(history.allFinite(), "rainflow counting: a value of the history is not finite");
  if (history.size() == 0) return {};
  std::vector<Cycle> cycles;
  std::vector<double> points;
  for (double point : turning_points(ends == Ends::repeated ? from_largest(history) : history)) {
    points.push_back(point);
    count_closed(points, ends, cycles);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) cycles.push_back(cycle(points[i], points[i + 1], 0.5));
  return cycles;
}

}  // namespace elastogear::life
