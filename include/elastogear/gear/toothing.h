#pragma once
// Teeth: all that flanks, fillets and meshes of one gear need to know.
//
// Body frame: the gear's axis is z. Flanks are
//   theta = z/p + s psi(r, s z) + theta_tooth,
// s = +1: `left`, counter-clockwise seen from +z (on a right-handed worm the side of smaller z); s = -1:
// `right`. On helicoids psi does not depend on z; involute helicoids are known in closed form. A tooth is its
// own image when turned by pi about the radial axis through its centre at z = 0. The teeth of an internal
// gear stand inwards. ISO 21771 counts them below 0; here z > 0, and the standard's sign z/|z| stands in the
// formulas.

#include <Eigen/Core>
#include <functional>

namespace elastogear::gear {

/// Half the tooth thickness as an angle, and its derivatives by r and by z.
struct HalfAngle {
  double psi = 0;  ///< rad
  double d_r = 0;  ///< rad/m
  double d_z = 0;  ///< rad/m
};

/// Where the flanks end in one transverse plane.
struct FlankEnds {
  double r_form = 0, r_a = 0;  ///< m
};

/// The toothing of one gear or worm.
struct Toothing {
  int z = 0;              ///< -, teeth or starts
  bool internal = false;  ///< teeth inside a ring: r_a < r_form < r_f
  double r = 0;           ///< m, pitch radius
  double r_a = 0;         ///< m, tip radius
  double r_f = 0;         ///< m, root radius
  double r_b = 0;         ///< m, base radius; 0: the flanks are no involutes
  double r_form = 0;      ///< m, radius where the flank ends and the fillet begins
  bool undercut = false;  ///< whether the fillet cuts the involute at r_form, as a protuberance always does
  double r_start = 0;     ///< m, radius on the path of contact that is nearest to the root
  double alpha_t = 0;     ///< rad, transverse pressure angle
  double beta_b = 0;      ///< rad, base helix angle
  double p = 0;      ///< m/rad, axial advance per radian: lead / (2 pi); < 0 left-handed, infinite for spurs
  double psi_b = 0;  ///< rad, half the tooth thickness as an angle, at the base circle
  double theta_1 = 0;                                            ///< rad, angle of tooth 1's centre at z = 0
  std::function<HalfAngle(double r, double z)> half_angle = {};  ///< of flanks that are no involutes
  std::function<FlankEnds(double z)> ends = {};  ///< of hobbed flanks, the same at -z; others: r_form, r_a
  double half_face = 0;                          ///< m, of hobbed flanks, up to which z their ends are known
  double crease = 0;  ///< m, z beside the middle plane, where these are not smooth either; 0: nowhere

  double sign() const { return internal ? -1 : 1; }  ///< z/|z| of ISO 21771
};

/// The involute function inv(alpha) = tan(alpha) - alpha.
double involute(double alpha);

/// Angle of tooth i (0-based) at z = 0, rad.
double tooth_angle(const Toothing& toothing, int i);

/// Half the tooth thickness as an angle at radius r and at s z; of involutes inside the base circle that of
/// the base circle. It shrinks outwards, that of an internal gear grows; Eq. (9.2).
HalfAngle half_angle(const Toothing& toothing, double r, double z = 0);
inline double psi(const Toothing& toothing, double r, double z = 0) { return half_angle(toothing, r, z).psi; }

/// Thickness of a tooth normal to its helix on the cylinder of radius r, along that cylinder, m.
double normal_thickness(const Toothing& toothing, double r);

/// Signed normal distance of point x (body frame, m) to the flank of a tooth on side s = +1 (left) or -1
/// (right), > 0 outside the tooth: with F = s (theta - z/p - theta_tooth) - psi(r, s z) it is F/|grad F|.
/// That is exact on the flank of any form, with its gradient, and everywhere for involutes, where it is
/// r_b cos(beta_b) F; otherwise its error is of second order in the distance. The angle is taken nearest to
/// the tooth's centre. Inside the base cylinder, where an involute has no points, psi(r_b) is used.
double flank_distance(const Toothing& toothing, int tooth, int side, const Eigen::Vector3d& x);

}  // namespace elastogear::gear
