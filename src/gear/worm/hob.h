#pragma once
// The hob that makes a wheel, and the surface that it leaves (docs/theory, section 9).
//
// The hob turns about an axis that stands a from the wheel's, swivelled by sigma about the centre line (+Y)
// against the worm's, while the wheel turns by z1/z2. All here is the space beside the left flank of the
// tooth on +Y, of a right-handed drive; right flanks are its image, turned by pi about the centre line.

#include <Eigen/Core>

#include "elastogear/gear/design.h"

namespace elastogear::gear {

struct Hob {
  Toothing thread = {};  ///< r_a: tip, r_form: where the flank ends and the tip's arc begins
  double a = 0;          ///< m, distance of the axes
  double sigma = 0;      ///< rad
  double travel = 0;     ///< m/rad, of the thread along the hob's axis per angle of the wheel
  double p_wheel = 0;    ///< m/rad, lead of the wheel's teeth / (2 pi), from which their angles count
  double rho = 0;        ///< m, radius of the tip's arc, axial section
  Eigen::Vector2d centre = {0, 0};  ///< m, of the arc: axial, from the thread's middle, and radial
  double throat = 0;  ///< m, radius of the wheel's tip in the axial section, about (0, a_worm); 0: none
  double a_worm = 0;  ///< m, centre distance of worm and wheel
  double tip = 0;     ///< m, largest tip radius of the wheel
};

/// The hob of a design whose pitch geometry is known. Throws Error for tips that are too round, hobs that do
/// not exist and outside diameters below the tip's in the middle.
Hob hob(const Design& design, const Geometry& geometry);

/// A point of the hob's axial section on the side of larger z, from the thread's middle, and its unit normal.
struct HobPoint {
  double axial = 0, r = 0;  // m
  double n_x = 0, n_r = 0;  // -
};
HobPoint flank_point(const Hob& hob, double r);
/// b: rad, angle of the normal; pi/2 at the tip.
HobPoint arc_point(const Hob& hob, double b);
/// rad, angle of the normal where flank and arc meet.
double arc_begin(const Hob& hob);

/// Where a point of the hob's section touches the wheel in its plane z.
struct Cut {
  double r = 0;                          ///< m, in the wheel
  double angle = 0;                      ///< rad, from the tooth's centre, z/p_wheel + angle_1
  double n_r = 0, n_theta = 0, n_z = 0;  ///< normal in the wheel, of any length; 0 for n_theta: none
  double travelled = 0;                  ///< m, of the thread along the hob's axis
  double denominator = 0;  ///< component of the hob's unit normal along the centre line; 0: it does not cut
};
Cut cut(const Hob& hob, const HobPoint& point, double z);

/// m, tip radius of the wheel in the plane z.
double tip_radius(const Hob& hob, double z);

/// m, smallest radius of the hob that is looked at for the wheel's flank in the plane z, just below what
/// makes its tip.
double innermost_radius(const Hob& hob, double z);

/// Half the tooth thickness of the wheel on its left flank; linear beyond its ends.
HalfAngle hobbed_half_angle(const Hob& hob, double r, double z);

}  // namespace elastogear::gear
