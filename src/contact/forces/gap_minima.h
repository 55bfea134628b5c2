#pragma once
// The search for the places where the gap between two smooth surfaces is least: along the sides of slave
// faces and within them (docs/theory, section 6.12).

#include <map>
#include <vector>

#include "contact/forces/least_gap.h"

namespace elastogear::contact {

/// At a slave node within the limits.
struct NodeGap {
  double g = 0;       ///< m
  Eigen::Vector3d n;  ///< its gradient
  int nearest = -1;   ///< face of the master
};

/// Minima along sides and within faces with a gap below the reach, by number; none that differ from the ends
/// of a side, or the sides of a face, by less than a millionth of its length. nodes: by their numbers.
std::vector<Minimum> gap_minima(const GapField& field, std::map<int, NodeGap> nodes);

}  // namespace elastogear::contact
