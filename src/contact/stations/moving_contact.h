#pragma once
// Flanks on axes that cross touch at stations that move over the mate's flank: at one point of each pair of
// teeth, or along a line over the face of a hobbed wheel.

#include "elastogear/contact/tooth_contact.h"

namespace elastogear::contact {

/// Is a force possible at one of the places of two flanks, and none so deep that it lies in the tooth behind?
bool touches(const std::vector<NearestPlace>& places, double of_height);
/// The pair with n strips over the owner's face where it is hobbed, and with what stations do to each other.
void set_moving_stations(ToothedPair& pair, int n);
/// See tooth_contacts.
std::vector<ToothContact> moving_contacts(const ToothedPair& pair, const RelativePlacement& placement);

}  // namespace elastogear::contact
