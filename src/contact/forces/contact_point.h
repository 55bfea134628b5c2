#pragma once
// From a slave node's projection to its contact point: gap, force, tangent.

#include "contact/forces/law.h"
#include "contact/projection/heights.h"

namespace elastogear::contact {

/// The data of the master surface that a pass needs beside the projection.
struct MasterSide {
  const SurfaceView& surface;
  const Heights& heights;
  double feature_angle = 0;  ///< rad
};

bool on_extension(const Projection& projection);

/// Contact point of the frictionless, undamped penalty on facets, whose F derives from a potential, W = V:
/// docs/theory.md, Eqs. (6.4) and (6.5). Not for points on an extended side. p: N, of a unilateral law.
ContactPoint potential_contact(const MasterSide& master, const Projection& projection, const Law& law,
                               double p, bool full_tangent);

/// Contact point for any law; nothing when the gap is open, unless the law is unilateral. Surfaces with
/// heights are met on the face itself where the closest point is on an edge or vertex across which normals
/// turn by less than the feature angle. velocity: m/s, of a node of the slave (side 0) or master (1). stuck:
/// of this slave node after the last step, or null.
struct SlaveContact {
  Projection projection;
  int slave_node;
  Eigen::Vector3d x_slave;
  std::function<Eigen::Vector3d(int side, int node)> velocity;
  const StickPoint* stuck;
  double p = 0;  // N, of a unilateral law
};
std::optional<ContactPoint> general_contact(const MasterSide& master, const SlaveContact& touch,
                                            const Law& law);

}  // namespace elastogear::contact
