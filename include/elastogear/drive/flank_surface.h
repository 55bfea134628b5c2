#pragma once
// The exact flanks of gear data behind the faces of a meshed gear. Surfaces are in the frame of the gear
// data, whose z is the axis.

#include <optional>
#include <string>
#include <vector>

#include "elastogear/contact/true_surface.h"
#include "elastogear/drive/exact_flanks.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::drive {

/// The teeth of a body.
struct Teeth {
  gear::Toothing toothing;
  std::optional<gear::FlankDeviations> deviations = {};  ///< of the flanks; nothing: they are exact
  Layers layers = Layers::transverse;                    ///< of its mesh
};

/// m, how far a node may be from its flank: meshes are exact to 1e-9, and files may round to single
/// precision.
inline constexpr double kOnFlank = 1e-6;

/// A node of a flank.
struct OffNode {
  double distance = 0;  ///< m, from its flank
  int node = -1;        ///< mesh number; -1: no face belongs to a flank
  std::string group;    ///< face set of that flank, as tooth_01_left
};

/// The node of all flanks that is farthest from its flank. A body may have been meshed with its deviations or
/// without them.
OffNode farthest_node(const Teeth& teeth, const model::Surface& surface);

/// Heights of the flanks over the faces of a surface.
struct FlankHeights {
  std::vector<contact::ExactHeights> height = {};  ///< by face, empty ones where it belongs to no flank
  int n_faces = 0;                                 ///< that have some
  double error = 0;  ///< m, the most by which polynomials over the faces miss flanks with deviations; 0: none
};

/// Heights of all flanks (docs/theory, section 6.8). with_error: `error` is found, too.
FlankHeights flank_heights(const Teeth& teeth, const model::Surface& surface, bool with_error);

/// The exact flanks behind a surface.
struct FlankSurface {
  contact::TrueSurface surface;  ///< without deviations of nodes
  OffNode farthest;
  int n_faces = 0;   ///< that belong to flanks
  double error = 0;  ///< m, see FlankHeights
};

/// Throws Error where no face belongs to a flank, or a node is farther than kOnFlank from its own one.
FlankSurface flank_surface(const Teeth& teeth, const model::Surface& surface, bool with_error);

}  // namespace elastogear::drive
