#pragma once
// Plane tooth outlines: of the worm in its axial section, of gears in the transverse one.

#include <Eigen/Core>
#include <functional>

namespace elastogear::gear {

/// The half of one tooth on the positive side of its axis. A point is given by its radius and a lateral
/// coordinate c: axial position (worm, m) or angle (wheel, rad). Plane coordinates (m): x across, y along the
/// tooth axis.
struct Profile {
  bool polar = false;                   ///< wheel: x = r sin c, y = r cos c; worm: x = c, y = r
  bool inwards = false;                 ///< of an internal gear: x = r sin c, y = -r cos c
  double half_pitch = 0;                ///< middle of the space, c
  double r_inner = 0;                   ///< m, end of the section below the tooth: bore (worm), rim (wheel)
  double r_f = 0, r_form = 0, r_a = 0;  ///< m, root, end of the flank, tip
  std::function<double(double)> half_width;       ///< c of the flank at radius r
  std::function<Eigen::Vector2d(double)> fillet;  ///< plane point, t = 0 at the root land, 1 at the flank
  std::function<double(double)> shift = {};  ///< rad, of the points at radius r, which makes both sides those
                                             ///< of the tooth; 0 at r_inner; empty: none

  Eigen::Vector2d point(double c, double r) const;
  double lateral(const Eigen::Vector2d& x) const;  ///< c of a plane point
};

}  // namespace elastogear::gear
