#include "elastogear/life/revolution.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::life {
namespace {

constexpr double kOnPosition = 1e-6;  // pitches
constexpr double kSamePlace = 1e-6;   // of the largest radius

// Finds points by their x coordinate first.
class Places {
 public:
  explicit Places(const Eigen::Matrix3Xd& X) : X_(X), by_x_(static_cast<std::size_t>(X.cols())) {
    std::iota(by_x_.begin(), by_x_.end(), 0);
    std::sort(by_x_.begin(), by_x_.end(), [&](int a, int b) { return X(0, a) < X(0, b); });
  }
  // The point nearest to x within the tolerance; -1: none.
  int nearest(const Eigen::Vector3d& x, double tolerance) const {
    auto at = std::lower_bound(by_x_.begin(), by_x_.end(), x[0] - tolerance,
                               [&](int i, double value) { return X_(0, i) < value; });
    int found = -1;
    double least = tolerance;
    for (; at != by_x_.end() && X_(0, *at) <= x[0] + tolerance; ++at)
      if (const double d = (X_.col(*at) - x).norm(); d <= least) {
        least = d;
        found = *at;
      }
    return found;
  }

 private:
  const Eigen::Matrix3Xd& X_;
  std::vector<int> by_x_;
};

// The largest difference between stresses that a pitch of roll and a pitch of the gear apart should be equal.
double difference_of_pitches(const Eigen::MatrixXd& stress, const Orbits& orbits, const Sweep& sweep,
                             int sense) {
  const auto z = static_cast<int>(orbits.node.rows()), n = sweep.per_pitch;
  double largest = 0;
  for (Eigen::Index orbit = 0; orbit < orbits.node.cols(); ++orbit)
    for (int tooth = 0; tooth < z; ++tooth) {
      const int before = orbits.node(tooth, orbit), behind = orbits.node((tooth - sense + z) % z, orbit);
      for (int k = 0; k + n < stress.cols(); ++k)
        largest = std::max(largest, std::abs(stress(behind, k + n) - stress(before, k)));
    }
  return largest;
}

Revolutions lay_pitches(const Eigen::MatrixXd& stress, const Orbits& orbits, const Sweep& sweep, int sense) {
  const auto z = static_cast<int>(orbits.node.rows()), n = sweep.per_pitch;
  Revolutions r;
  r.stress.resize(z * n, orbits.node.cols());
  for (Eigen::Index orbit = 0; orbit < orbits.node.cols(); ++orbit) {
    const auto column = orbits.node.col(orbit);
    r.node.push_back(column[0]);
    r.of.emplace_back(column.begin(), column.end());
    for (int j = 0; j < z; ++j)
      r.stress.col(orbit).segment(j * n, n) = stress.row(column[(sense * j % z + z) % z]).head(n).transpose();
  }
  return r;
}

Revolutions as_swept(const Eigen::MatrixXd& stress, const Sweep& sweep, int z) {
  Revolutions r;
  r.laid = false;
  r.count = sweep.pitches / z;
  r.stress = stress.transpose();
  for (int i = 0; i < stress.rows(); ++i) {
    r.node.push_back(i);
    r.of.push_back({i});
  }
  return r;
}

}  // namespace

Orbits find_orbits(const std::string& name, const Eigen::Matrix3Xd& X, int z, double tolerance) {
  const Places places(X);
  const Eigen::Matrix3d turn = rotation_matrix({0, 0, 2 * std::numbers::pi / z});
  std::vector<bool> taken(static_cast<std::size_t>(X.cols()), false);
  Orbits orbits;
  orbits.node.resize(z, (X.cols() + z - 1) / z);
  Eigen::Index count = 0;
  for (int first = 0; first < X.cols(); ++first) {
    if (taken[first]) continue;
    require(count < orbits.node.cols(), name, ": ", X.cols(), " nodes do not repeat over ", z, " teeth");
    Eigen::Vector3d x = X.col(first);
    for (int j = 0; j < z; ++j, x = turn * x) {
      const int node = places.nearest(x, tolerance);
      require(node >= 0 && !taken[node], name, ": no node of its own lies within ", tolerance, " m of (",
              x[0], ", ", x[1], ", ", x[2], ") m, where node ", first,
              " of the set goes when the gear turns by ", j, " of its ", z,
              " pitches; sweep over whole revolutions of this gear (sweep_pitches)");
      taken[node] = true;
      orbits.node(j, count) = node;
    }
    ++count;
  }
  return orbits;
}

Sweep find_sweep(const std::string& file, const Eigen::VectorXd& roll) {
  const Eigen::Index n = roll.size();
  require(n > 1, file, ": has ", n, " position; a life needs those of a sweep over a pitch: analysis: sweep");
  const double step = (roll[n - 1] - roll[0]) / static_cast<double>(n - 1);
  const double pitches = step * static_cast<double>(n), whole = std::round(pitches);
  for (Eigen::Index k = 0; k < n; ++k)
    require(std::abs(roll[k] - roll[0] - step * static_cast<double>(k)) < kOnPosition, file, ": position ", k,
            " at ", roll[k], " pitches is not evenly spaced between the others");
  const Eigen::Index per_pitch = whole < 1 ? 0 : n / static_cast<Eigen::Index>(whole);
  require(std::abs(pitches - whole) < kOnPosition * static_cast<double>(n) && whole >= 1 &&
              per_pitch * static_cast<Eigen::Index>(whole) == n,
          file, ": ", n, " positions go over ", pitches,
          " pitches; they must be evenly spaced over whole pitches, as many in each");
  return {static_cast<int>(whole), static_cast<int>(per_pitch)};
}

Revolutions over_revolutions(const std::string& name, const Eigen::MatrixXd& stress,
                             const Eigen::Matrix3Xd& X, const Sweep& sweep, int z, int sense) {
  if (sweep.pitches % z == 0) return as_swept(stress, sweep, z);
  const double tolerance = kSamePlace * X.topRows<2>().colwise().norm().maxCoeff();
  const Orbits orbits = find_orbits(name, X, z, tolerance);
  Revolutions r = lay_pitches(stress, orbits, sweep, sense);
  r.difference = difference_of_pitches(stress, orbits, sweep, sense);
  return r;
}

Eigen::MatrixXd signed_principal(const Eigen::MatrixXd& stress) {
  Eigen::MatrixXd principal(stress.rows() / 6, stress.cols());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  for (Eigen::Index t = 0; t < stress.cols(); ++t)
    for (Eigen::Index i = 0; i < principal.rows(); ++i) {
      const auto s = stress.col(t).segment<6>(6 * i);
      Eigen::Matrix3d sigma;
      sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
      solver.compute(sigma, Eigen::EigenvaluesOnly);
      const double least = solver.eigenvalues()[0], largest = solver.eigenvalues()[2];
      principal(i, t) = largest >= -least ? largest : least;
    }
  return principal;
}

Eigen::MatrixXd enlarged(const Eigen::MatrixXd& stress, const Eigen::MatrixXd& error) {
  return stress.binaryExpr(error, [](double s, double e) { return s + std::copysign(e, s); });
}

}  // namespace elastogear::life
