#pragma once
// Stations over the face of two gears in mesh, to which what bears there is shared out (docs/theory,
// section 10.3).

#include <Eigen/Core>
#include <array>

#include "elastogear/evaluation/motion.h"

namespace elastogear::evaluation {

/// n stations over the face, each of which stands for a part of it.
struct FaceStations {
  Eigen::VectorXd z;      ///< n, m, ascending
  Eigen::VectorXd ends;   ///< n + 1, m, of the parts
  bool of_parts = false;  ///< does all that stands in a part count there? Else linear functions share it out

  Eigen::Index n() const { return z.size(); }
  Eigen::VectorXd widths() const { return ends.tail(n()) - ends.head(n()); }  ///< n, m
};
/// At least two places, between which linear functions share out. Parts end half way between them, and at the
/// first and the last one: their widths are the integrals of the functions.
FaceStations at_layers(const Eigen::VectorXd& z);
/// In the middle of n even parts.
FaceStations at_strips(double begin, double end, int n);

/// Along the axis of gear `along` (0 or 1) in its body frame. On parallel axes they cover what the faces of
/// both gears have in common. Where contact has so many strips they are these. Else they stand at the ends
/// and, between them, at the layers of the gear whose nodes come into contact. A layer that the end cuts off
/// by less than half of its distance to the next one is none. On crossed axes they cover the face of that
/// gear: the strips of the one that owns them, else its layers. Where there are no layers 17 even ones take
/// their place.
FaceStations stations(const std::array<const Gear*, 2>& gear, int slave_side, int strips, int along);

/// What stands at one place goes to the station of its part, or to the two stations around it.
struct StationShare {
  std::array<Eigen::Index, 2> station;
  std::array<double, 2> share;  ///< >= 0, their sum is 1
};
/// What lies beyond the ends counts at the end.
StationShare share_out(const FaceStations& stations, double z);

}  // namespace elastogear::evaluation
