#pragma once
// The search for the places where the gap between two smooth surfaces is least: along the sides of slave
// faces and within them (docs/theory.md, section 6.12).

#include <map>
#include <vector>

#include "contact/forces/slave_point.h"
#include "contact/reach.h"

namespace elastogear::contact {

/// The slave surface and what its points are held against.
struct GapField {
  const MasterSide& master;
  const SurfaceView& slave;  ///< without extensions
  const Heights& heights;    ///< of the slave's faces
  const Reach& reach;        ///< larger gaps are of no interest
  int slave_side = 0;
  double offset = 0;  ///< m, added to every gap
  bool whole = true;  ///< the whole surface; otherwise its boundary alone
};

/// At a slave node within the limits.
struct NodeGap {
  double g = 0;       ///< m
  Eigen::Vector3d n;  ///< its gradient
  int nearest = -1;   ///< face of the master
};

struct Minimum {
  SlavePoint point;
  SlaveGeometry geometry;
  OpenPoint open;
};

/// Minima along sides and within faces with a gap below the reach, by number; none that differ from the ends
/// of a side, or the sides of a face, by less than a millionth of its length. nodes: by their numbers.
std::vector<Minimum> gap_minima(const GapField& field, std::map<int, NodeGap> nodes);

}  // namespace elastogear::contact
