#pragma once
// Normal displacements of an elastic half-space by pressures on a surface of faces (J. Boussinesq).

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// Pressures whose consistent nodal forces act on a surface, which is taken for plane where they do. The
/// pressure that is linear between nodes and has an even force f on each share of the area spreads f, and the
/// even pressure on these shares does, by h^2 / 6 and h^2 / 12 in the second moment along a side of length h,
/// where that of the consistent pressure is less than that of the nodes by h^2 / 6: it is extrapolated from
/// both. docs/theory.md, Eq. (6.36).
class HalfSpace {
 public:
  /// The surface must outlive this.
  explicit HalfSpace(const model::Surface& surface);

  /// 1/m: mean of 1/r between the pressure of a force on node i and that of one on node j. The displacement
  /// of i by 1 N on j is (1 - nu^2) / (pi E) times that. Kept when it has been asked for.
  double mean_inverse_distance(int i, int j);

 private:
  struct Sample {
    Eigen::Vector3d x;    // m, middle of a part of a face
    double linear, even;  // -, shares of the node's force
    double inverse_own;   // 1/m, mean of 1/r within the part
  };
  using Samples = std::vector<Sample>;
  const Samples& samples(int node);
  double integral(int i, int j);

  const model::Surface* surface_;
  std::vector<std::vector<int>> faces_;  // of each node
  std::unordered_map<int, Samples> samples_;
  std::unordered_map<std::int64_t, double> known_;  // by i n + j, i <= j
};

}  // namespace elastogear::dynamics
