#pragma once
// Flanks on axes that cross touch at one point of each pair of teeth, which moves over both.

#include "elastogear/contact/tooth_contact.h"

namespace elastogear::contact {

/// See tooth_contacts.
std::vector<ToothContact> point_contacts(const ToothedPair& pair, const RelativePlacement& placement);
/// See change_of_potential; f: N.
double change_at_point(const ToothContact& contact, double f, const std::array<PotentialSlopes, 2>& slopes,
                       const Eigen::Matrix<double, 6, 1>& twist);

}  // namespace elastogear::contact
