#pragma once
// Structured, conforming hexahedral mesh of the worm.
//
// The axial section is swept along the helix. On each cylinder the grid lines are axial lines and helices:
// going once around, layer k becomes layer k + K with K = z1 (2 space + tooth). Beyond the thread that shift
// is taken back one layer at a time: the stack of helical layers ends in K steps of one layer, and at each
// step the step's riser is joined with the next edge of its tread, so that turn - K plain columns go on into
// the shaft (docs/theory, section 9).

#include "elastogear/gear/design.h"
#include "elastogear/gear/size.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// Element counts of the worm.
struct WormCounts {
  int tooth = 2;            ///< columns across the tooth, even
  int space = 1;            ///< columns across half a space
  int flank = 2;            ///< rows up the flank
  int fillet = 1;           ///< rows up the tooth's half of the fillet
  int ring = 2;             ///< rows from the bore to the root
  int turn = 24;            ///< sections per turn: a multiple of z1 (2 space + tooth), at least twice
  int shaft = 10;           ///< layers of each plain shaft end (each cone and seat gets at least one)
  int order = 1;            ///< of the cells: 1 (8 nodes) or 2 (20 nodes, midside nodes on the exact surface)
  double growth = 0;        ///< of rows from the root inwards, each to the one before; 0: nearly equal rows
  double tooth_growth = 0;  ///< of columns from the flank to the middle of the tooth; 0: equal ones
};

/// Counts of a size for a worm with z1 starts (sections per turn follow from it) and cells of an order: those
/// of 20 nodes are graded towards the fillets.
WormCounts worm_counts(Size size, int z1 = Design{}.z1, int order = 1);

/// The counts of a worm with z1 starts times a number > 0, as far as they are whole, with rows that grow as
/// before over the same depth. Layers of the shaft are its square root times as many.
WormCounts refined(WormCounts counts, int z1, double times);

/// Mesh in the worm frame. Face sets left, right, flanks, `thread_<i>_left`, `thread_<i>_right`; node sets
/// seats, seat_1, seat_2, root, `root_<i>` (nodes of the fillet surface); cell set body. Threads are
/// numbered 1..z1. Throws Error for designs that do not exist and counts that do not fit.
mesh::Mesh worm_mesh(const Design& design, const WormCounts& counts);

}  // namespace elastogear::gear
