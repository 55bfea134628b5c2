#pragma once
// The flanks of the worm drive as rigid contact surfaces, with their exact distances.

#include <vector>

#include "elastogear/contact/pair.h"
#include "elastogear/gear/flank.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::contact::test {

using gear::Flank;

/// The flanks of a toothing.
struct Flanks {
  gear::Toothing toothing;
  double half_width;  ///< m, of the flanks along z
  model::Surface surface;
  std::vector<Flank> flank;  ///< of each face
  TrueSurface exact;         ///< heights of the involute helicoid over the faces
};

struct WormDrive {
  gear::Design design;
  gear::Geometry geometry;
  Flanks worm, wheel;
};
/// n: how many times finer than size tiny the flanks are.
WormDrive worm_drive(int n);

/// Placed with the worm turned by phi_1 and the wheel by -phi_1 / ratio + ahead (rad).
SurfaceMotion worm_motion(const WormDrive& drive, double phi_1);
SurfaceMotion wheel_motion(const WormDrive& drive, double phi_1, double ahead);

/// How far the wheel is ahead (rad) when exact flanks enter each other by `depth` (m).
double pressed(const WormDrive& drive, double depth);

/// Exact distance of a point of the world from a flank of a body so placed, m, > 0 outside.
double distance(const Flanks& flanks, const SurfaceMotion& placed, const Flank& flank,
                const Eigen::Vector3d& x);
/// Whether the point's foot on the exact flank is at least `margin` (m) away from the flank's ends.
bool is_within(const Flanks& flanks, const SurfaceMotion& placed, const Flank& flank,
               const Eigen::Vector3d& x, double margin);

}  // namespace elastogear::contact::test
