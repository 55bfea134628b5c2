#pragma once
// Positions of the worm's nodes.

#include <vector>

#include "elastogear/gear/worm.h"
#include "gear/tooth_grid.h"
#include "gear/worm/helix.h"

namespace elastogear::gear {

/// Cylinder coordinates; phi is counted from tooth 1's centre at z = 0.
struct Polar {
  double phi, z, r;
};

/// A ring of the plain shaft: z is counted outwards on either end.
struct Ring {
  double z, r;
};

struct WormGrid {
  Design design;
  Geometry geometry;
  WormCounts n;
  ToothGrid tooth_grid;
  ToothGrid points;  // the same with n.order points from node to node
  Helix helix;
  int columns = 0;      // layers per axial pitch
  int half_thread = 0;  // sections from the middle of a thread to its end
  double layer = 0;     // m, axial pitch / columns
  std::vector<HelixNode> treads;
  std::vector<Ring> shaft[2];
};

/// Checks design and counts.
WormGrid worm_grid(const Design& design, const WormCounts& counts);

/// Mean of two places, of which the angle of the second may count other turns.
Polar middle(const Polar& a, const Polar& b);

/// Node of the helical core: row 0 on the bore, row n.ring on the surface or under the tooth.
Polar core_position(const WormGrid& grid, HelixNode node, int row);

/// Midside node between two nodes of the core in the rows row_a and row_b, whose edge is in one cell.
Polar core_midside(const WormGrid& grid, HelixNode a, int row_a, HelixNode b, int row_b);

/// Node of a thread's tooth block, or with halves a midside node; J counts sections from the thread's middle.
Polar tooth_position(const WormGrid& grid, int thread, double J, double q, double row);

/// Node of the plain shaft on the -z (end 0) or +z (end 1) side; column 0 .. treads - 1, ring 0 on the
/// treads.
Polar shaft_position(const WormGrid& grid, int end, int ring, int column, int row);

}  // namespace elastogear::gear
