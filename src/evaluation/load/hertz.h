#pragma once
// Flank pressure by H. Hertz under the forces of a run: what a mesh shows whose faces are wider than the
// patch of contact are means over the faces (docs/theory, sections 6.10 and 10.6).

#include <Eigen/Core>
#include <array>
#include <optional>

#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/face_stations.h"
#include "elastogear/model/hertz.h"

namespace elastogear::evaluation {

/// 1/m, the relative curvature Q of two flanks that touch, in the world: the gap is x'Q x / 2.
Eigen::Matrix3d relative_curvature(const std::array<const Gear*, 2>& gear, const FlankContact& contact,
                                   std::size_t step);

struct HertzPressure {
  Eigen::VectorXd largest;       ///< n_t, Pa; 0 where nothing bears
  Eigen::Index step = 0;         ///< of it
  model::HertzPatch patch = {};  ///< there
  double left_out = 0;           ///< -, share of the pairs of teeth of all times that it does not tell of
};
/// Of parallel axes, line contact under the line load of each pair of teeth; of crossed ones, point contact
/// under the force of each pair. It leaves out pairs on crossed axes that touch along lines, as those of
/// enveloping wheels do, or along more than half the face, and patches that reach beyond the end of a flank.
/// Nothing where that leaves none. over_face: along the second gear's axis; E_star: Pa.
std::optional<HertzPressure> hertz_pressure(const std::array<const Gear*, 2>& gear,
                                            const ContactHistory& contacts, const FaceStations& over_face,
                                            double E_star);

/// Sets the half width of each contact's patch, and on parallel axes the pressure: that of the line load at
/// its place along the face.
void take_hertz(const std::array<const Gear*, 2>& gear, const FaceStations& over_face, double E_star,
                ContactHistory& contacts);

}  // namespace elastogear::evaluation
