#pragma once
// Valleys of a smooth master: faces that are deformed make kinks with each other at the sides that they
// share, and a slave point in a concave one rests on more than one face (docs/theory, section 6.11).

#include <vector>

#include "contact/forces/contact_point.h"

namespace elastogear::contact {

/// A face beside the one that a slave point is over, which holds it as well.
struct FaceOfValley {
  Projection projection;  ///< of the point, on that face prolonged
  double share = 0;       ///< of the stiffness of the contact
  int place = 0;          ///< 0-3: beyond the side of that number, 4-7: at the corner of that number
};

struct Valley {
  double share = 1;  ///< of the stiffness that is left to the face that the point is over
  std::vector<FaceOfValley> beside = {};
};

/// The faces that hold a slave point at x (m) beside that of its projection: those that make a concave kink
/// with it at a side within a twentieth of its length, half of the stiffness each at the side. All shares add
/// up to 1.
Valley valley_at(const MasterSide& master, const Projection& projection, const Eigen::Vector3d& x);

}  // namespace elastogear::contact
