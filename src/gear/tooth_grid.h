#pragma once
// The plane grid of one tooth: a tooth block on a strip that reaches from the inner end of the section to the
// root.

#include <Eigen/Core>
#include <vector>

#include "gear/profile.h"

namespace elastogear::gear {

struct ToothGridCounts {
  int tooth, space, flank, fillet, ring;
  int land = 0;       ///< columns of half a space beside the fillet; 0: its share of the length
  int order = 1;      ///< 2: with a point between any two, where a second-order mesh has its midside nodes
  double growth = 0;  ///< of the strip's rows, see graded_row
  double tooth_growth =
      0;  ///< the same of the columns across half a tooth, towards its middle; 0: equal ones
};

/// Grid of one tooth and the two half spaces beside it, symmetric about the tooth's axis. All counts are
/// those of its points: twice those of the cells where it has points between. Column q = 0 is the axis. Three
/// blocks (tooth, strip below it, strip below the space) meet in the middle of the fillet at 60 degrees.
struct ToothGrid {
  int half_tooth = 0;                  ///< columns from the axis to the flank
  int half_pitch = 0;                  ///< columns from the axis to the middle of the space
  int ring = 0, fillet = 0, rows = 0;  ///< rows of the strip; fillet rows and all rows of the tooth block
  int fillet_end = 0;                  ///< column where the fillet runs into the root land
  std::vector<Eigen::Vector2d>
      strip;  ///< (half_pitch + 1) x (ring + 1), column by column; row `ring` is the top
  std::vector<Eigen::Vector2d> tooth;  ///< (half_tooth + 1) x (rows + 1); row 0 is the strip's top

  /// Plane points of column q (negative on the other side of the axis).
  Eigen::Vector2d strip_point(int q, int row) const;
  Eigen::Vector2d tooth_point(int q, int row) const;
};

ToothGrid tooth_grid(const Profile& profile, const ToothGridCounts& counts);

/// Rows of the strip get thinner towards the root: position of row `row` of n as a part of the strip, 0 at
/// the inner end. Each row is `growth` times as thick as the next one outwards; 0: linearly thinner, the last
/// 0.4 times thinner than the mean of many. A row between two stands in their middle.
double graded_row(double row, int n, double growth);

}  // namespace elastogear::gear
