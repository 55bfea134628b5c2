#include "elastogear/recovery/deviation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "elastogear/base/error.h"

namespace elastogear::recovery {
namespace {

constexpr double kTimeRoundoff = 1e-9;  // of the last time

StressMeasures measures(const StressVector& sigma) {
  StressMeasures m;
  m << sigma, von_mises(sigma), rankine(sigma);
  return m;
}

double integral(const Eigen::VectorXd& time, const Eigen::ArrayXd& values) {
  const Eigen::Index n = time.size() - 1;
  return 0.5 * ((time.tail(n) - time.head(n)).array() * (values.tail(n) + values.head(n))).sum();
}

Extremum extremum(const Eigen::VectorXd& time, const Eigen::VectorXd& values) {
  Eigen::Index at = 0;
  const double value = values.cwiseAbs().maxCoeff(&at);
  return {value, time[at]};
}

}  // namespace

StressDeviation stress_deviation(const Eigen::VectorXd& stress, const Eigen::VectorXd& reference) {
  require(stress.size() == reference.size() && stress.size() % 6 == 0, "stresses of ", stress.size(), " and ",
          reference.size(), " components cannot be compared");
  StressMeasures difference = StressMeasures::Zero(), own = difference;
  for (Eigen::Index i = 0; i < stress.size(); i += 6) {
    const StressMeasures a = measures(stress.segment<6>(i)), b = measures(reference.segment<6>(i));
    difference += (a - b).cwiseAbs2();
    own += b.cwiseAbs2();
  }
  return {(difference.array() / own.array()).sqrt(), (difference.array() / own[6]).sqrt()};
}

SignalDeviation signal_deviation(const Eigen::VectorXd& time, const Eigen::VectorXd& signal,
                                 const Eigen::VectorXd& reference) {
  require(time.size() > 1 && signal.size() == time.size() && reference.size() == time.size(), "signals of ",
          signal.size(), " and ", reference.size(), " values at ", time.size(),
          " times cannot be compared: two or more are needed");
  const Eigen::ArrayXd difference = (signal - reference).cwiseAbs2();
  return {std::sqrt(integral(time, difference) / integral(time, reference.cwiseAbs2())),
          extremum(time, signal), extremum(time, reference)};
}

Eigen::MatrixXd at_times(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                         const Eigen::VectorXd& wanted) {
  require(time.size() > 0 && values.cols() == time.size(), "a history of ", time.size(), " times and ",
          values.cols(), " columns");
  const double first = time[0], last = time[time.size() - 1], slack = kTimeRoundoff * std::abs(last);
  Eigen::MatrixXd result(values.rows(), wanted.size());
  for (Eigen::Index j = 0; j < wanted.size(); ++j) {
    const double t = wanted[j];
    require(t >= first - slack && t <= last + slack, "the time ", t, " s is outside of ", first, " .. ", last,
            " s");
    const Eigen::Index next = std::upper_bound(time.data(), time.data() + time.size(), t) - time.data();
    const Eigen::Index right = std::clamp<Eigen::Index>(next, 0, time.size() - 1);
    const Eigen::Index left = std::max<Eigen::Index>(right - 1, 0);
    const double share =
        right == left ? 0 : std::clamp((t - time[left]) / (time[right] - time[left]), 0., 1.);
    result.col(j) = (1 - share) * values.col(left) + share * values.col(right);
  }
  return result;
}

std::vector<int> match_numbers(const std::vector<int>& node, const std::vector<int>& reference) {
  std::unordered_map<int, int> place;
  for (std::size_t i = 0; i < node.size(); ++i) place[node[i]] = static_cast<int>(i);
  std::vector<int> match;
  for (const int number : reference) {
    const auto found = place.find(number);
    require(found != place.end(), "there is no node ", number);
    match.push_back(found->second);
  }
  return match;
}

std::vector<int> match_positions(const Eigen::Matrix3Xd& X, const Eigen::Matrix3Xd& reference,
                                 double tolerance) {
  require(X.cols() > 0 || reference.cols() == 0, "there are no nodes");
  std::vector<int> match;
  for (Eigen::Index i = 0; i < reference.cols(); ++i) {
    Eigen::Index nearest = 0;
    const double distance =
        std::sqrt((X.colwise() - reference.col(i)).colwise().squaredNorm().minCoeff(&nearest));
    require(distance <= tolerance, "there is no node at (", reference.col(i).transpose(),
            ") m; the nearest is ", distance, " m away, allowed are ", tolerance, " m");
    match.push_back(static_cast<int>(nearest));
  }
  return match;
}

}  // namespace elastogear::recovery
