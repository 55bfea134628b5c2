#pragma once
// Rainflow counting of stress histories (ASTM E1049-85, sections 5.4.4 and 5.4.5; docs/life.md).

#include <Eigen/Core>
#include <vector>

namespace elastogear::life {

/// A counted cycle or half cycle.
struct Cycle {
  double range = 0;  ///< as the history: largest less smallest value
  double mean = 0;   ///< of these two
  double count = 1;  ///< 1, or 0.5 of a half cycle
};

/// How a history goes on at its ends.
enum class Ends {
  open,      ///< it is all there is: what closes no cycle counts half (5.4.4)
  repeated,  ///< it begins anew: every cycle closes (5.4.5, simplified rainflow counting)
};

/// The values where the history turns, its ends included; values that lie on the way are left out.
std::vector<double> turning_points(const Eigen::VectorXd& history);

/// Cycles in the order in which they are counted. Error when a value is not finite.
std::vector<Cycle> rainflow(const Eigen::VectorXd& history, Ends ends);

}  // namespace elastogear::life
