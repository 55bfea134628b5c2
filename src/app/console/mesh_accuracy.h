#pragma once
// How far stresses, frequencies and stiffness on a mesh of a size are from those of the continuum.

#include <string>

#include "elastogear/gear/size.h"

namespace elastogear::app {

/// Prints two errors of the reference worm, or of its wheel, on the mesh of a size and order: that of the
/// largest von Mises stress at the root (docs/validation/recovery.md, section Roots), and the largest of the
/// first 20 frequencies, the worm held at its seats, the wheel at its bore (section 42).
void print_mesh_accuracy(bool is_worm, gear::Size size, int order);

/// The errors of the reference worm drive's mesh stiffness and of its flank pressure by H. Hertz under
/// contact without a penalty at the points of least gap, both gears of this size and order
/// (docs/validation/gears.md, section Meshes).
std::string drive_accuracy(gear::Size size, int order);

}  // namespace elastogear::app
