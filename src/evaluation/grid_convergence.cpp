#include "elastogear/evaluation/grid_convergence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

constexpr double kAssumed = 3, kObserved = 1.25;   // factors of safety with an assumed order, an observed one
constexpr double kLeastOrder = 1, kMostOrder = 4;  // other ones are those of meshes too coarse to tell

// Eq. (10.15)
double of_two_meshes(double change, double ratio, double order) {
  return kAssumed * std::abs(change) / (std::pow(ratio, order) - 1);
}

// Of the change on the way to the middle mesh over that on the way to the finest, at an order of convergence.
double ratio_of_changes(double order, double coarse, double fine) {
  return std::pow(fine, order) * (std::pow(coarse, order) - 1) / (std::pow(fine, order) - 1);
}

// Eq. (10.16) by bisection; its left side ascends with the order.
double observed_order(double changes, double coarse, double fine) {
  double low = kLeastOrder, high = kMostOrder;
  for (int i = 0; i < 50; ++i)
    (ratio_of_changes((low + high) / 2, coarse, fine) < changes ? low : high) = (low + high) / 2;
  return low;
}

double median(std::vector<double> values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  return values.size() % 2 == 1 ? *upper : (*upper + *std::max_element(values.begin(), upper)) / 2;
}

}  // namespace

double mesh_error(const std::vector<double>& value, const std::vector<double>& refinement, double order) {
  const std::size_t n = value.size();
  require(n >= 2 && refinement.size() == n, "an estimate of the error by meshes needs at least two of them");
  for (std::size_t i = 1; i < n; ++i)
    require(refinement[i] > refinement[i - 1], "a mesh of refinement ", refinement[i],
            " is not finer than one of ", refinement[i - 1]);
  const double fine = refinement[n - 1] / refinement[n - 2], change = value[n - 1] - value[n - 2];
  if (n == 2) return of_two_meshes(change, fine, order);
  const double coarse = refinement[n - 2] / refinement[n - 3], before = value[n - 2] - value[n - 3];
  const double changes = before / change;  // not finite without a change: no order is observed
  if (changes >= ratio_of_changes(kLeastOrder, coarse, fine) &&
      changes <= ratio_of_changes(kMostOrder, coarse, fine)) {
    const double observed = std::min(order, observed_order(changes, coarse, fine));
    return kObserved * std::abs(change) / (std::pow(fine, observed) - 1);
  }
  // Eq. (10.17)
  return std::max(of_two_meshes(change, fine, order),
                  of_two_meshes(before, coarse, order) / std::pow(fine, order));
}

double least_refinement(double error, double error_wanted, double refinement, double order) {
  return refinement * std::pow(kObserved / kAssumed * error / error_wanted, 1 / order);
}

// Eq. (10.18)
void raise_to_median(const std::vector<double>& figure, std::vector<double>& error) {
  require(figure.size() == error.size(), "there must be an error for each figure");
  std::vector<double> shares;
  for (std::size_t i = 0; i < figure.size(); ++i)
    if (const double share = error[i] / std::abs(figure[i]); std::isfinite(share)) shares.push_back(share);
  if (shares.empty()) return;
  const double least = median(std::move(shares));
  for (std::size_t i = 0; i < figure.size(); ++i) error[i] = std::max(error[i], least * std::abs(figure[i]));
}

}  // namespace elastogear::evaluation
