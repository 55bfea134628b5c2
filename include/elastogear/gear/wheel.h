#pragma once
// Structured, conforming hexahedral mesh of the wheel: the transverse section of one tooth, extruded along
// the helix and repeated around.

#include "elastogear/gear/design.h"
#include "elastogear/gear/size.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// Element counts of one sector of the wheel.
struct WheelCounts {
  int tooth = 2;            ///< columns across the tooth, even
  int space = 1;            ///< columns across half a space
  int flank = 2;            ///< rows up the flank
  int fillet = 1;           ///< rows up the tooth's half of the fillet
  int rim = 1;              ///< rows from the rim radius to the root
  int ring = 1;             ///< rows across the ring
  int web = 1;              ///< rows across the web
  int hub = 1;              ///< rows across the hub
  int web_layers = 2;       ///< axial layers across the web's width, or the face where there is no web
  int face_layers = 1;      ///< axial layers of the face on each side of the web
  int hub_layers = 1;       ///< axial layers of the hub on each side beyond the face
  int order = 1;            ///< of the cells: 1 (8 nodes) or 2 (20 nodes, midside nodes on the exact surface)
  double growth = 0;        ///< of rows from the root inwards, each to the one before; 0: nearly equal rows
  double tooth_growth = 0;  ///< of columns from the flank to the middle of the tooth; 0: equal ones
  double web_growth = 0;    ///< of rows of hub, web and ring away from the corners of the web; 0: equal ones
};

/// Counts of a size for cells of an order: those of 20 nodes are graded towards the fillets.
WheelCounts wheel_counts(Size size, int order = 1);

/// The counts times a number > 0, as far as they are whole, with rows that grow as before over the same
/// depth. Layers, and rows of ring, web and hub, are its square root times as many: those of the counts of
/// 20-node hexahedra change stresses at the roots less than rows of the tooth do (docs/validation/gears.md).
WheelCounts refined(WheelCounts counts, double times);

/// Mesh in the wheel frame. Face sets left, right, flanks, `tooth_<ii>_left`, `tooth_<ii>_right`; node sets
/// bore, root, `root_<ii>` (nodes of the fillet surface); cell sets body and rim (from the rim radius on),
/// disjoint. Teeth are numbered 01..z2 with as many digits as z2 has. Nodes and cells are numbered sector by
/// sector: with n = n_nodes/z2, node i n + j is node j turned by 2 pi i/z2; midside nodes come last in each
/// sector. Throws Error for designs that do not exist and counts that are not positive.
mesh::Mesh wheel_mesh(const Design& design, const WheelCounts& counts);

}  // namespace elastogear::gear
