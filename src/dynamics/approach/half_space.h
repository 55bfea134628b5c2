#pragma once
// Pressures on a contact surface that are smooth to its mesh: their consistent nodal forces, and the normal
// displacements of an elastic half-space under them (J. Boussinesq).

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "elastogear/contact/load_spread.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// A pressure with the resultant 1 N that falls from a corner of the sides of cells, linearly along their
/// edges, to zero at their other corners. docs/theory, Eq. (6.36).
struct HatPressure {
  struct Part {  // of a side, small beside it
    Eigen::Vector3d x;
    double force, area, inverse_own;
    int number;
  };
  std::vector<Part> parts;  ///< x: m, centre of the pressure on it; N; m^2; 1/m, mean of 1/r within it
  struct Columns {          // numbers of all parts, one after the other
    Eigen::ArrayXd x[3], force, area;
  } columns{};
  Eigen::Vector3d x = Eigen::Vector3d::Zero();        ///< m, its centre
  double size = 0;                                    ///< m, from there to the farthest part
  std::vector<std::pair<int, double>> nodal_force{};  ///< local nodes and consistent forces on them, N
};

/// The sides are taken for plane and their edges for straight.
class HalfSpace {
 public:
  /// The surface must outlive this.
  explicit HalfSpace(const model::Surface& surface);

  /// The pressure of a corner, given by its local node. Kept when it has been asked for.
  const HatPressure& pressure(int corner);

  /// The corners of the sides at a local node, among whose pressures a force on it is spread, Eq. (4.13) with
  /// their centres for places. along: unit vector of a line, across which it is spread, Eq. (6.36a); 0: to
  /// all directions. Throws Error for a node at no side.
  contact::Spread spread(int node, const Eigen::Vector3d& along);

  /// 1/m: mean of 1/r between the pressures of two corners. The mean displacement of the one by the other is
  /// (1 - nu^2) / (pi E) times that, m/N. Kept when it has been asked for.
  double mean_inverse_distance(int i, int j);

 private:
  const model::Surface* surface_;
  std::vector<std::vector<int>> side_;     // local nodes: corners, then those between them
  std::vector<std::vector<int>> at_node_;  // numbers of sides
  std::unordered_map<int, HatPressure> pressure_;
  std::unordered_map<std::int64_t, double> known_;  // by i n + j, i <= j
};

}  // namespace elastogear::dynamics
