#pragma once
// The one face, edge or vertex of the master surface that a slave node touches (docs/theory.md, section
// Winner).

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "elastogear/contact/closest_point.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {

struct SlaveNode {
  Eigen::Vector3d x;  ///< m
  std::function<Eigen::Vector3d()>
      normal;  ///< outward unit normal of the slave surface; asked for when inside
};

struct Limits {
  double depth = 0;         ///< m, largest distance to the surface
  double cos_angle = -0.1;  ///< n_slave . n_master must not exceed this
  double outside = 0;       ///< m, how far outside the surface a node is still taken
};

struct Winner {
  int face = 0;
  ClosestPoint point;
  Eigen::Vector3d n;  ///< outward, x_slave - x_c = g_n n
  double g_n = 0;     ///< m, < 0 inside
};

/// Nothing when the node is outside the master body (further than the limit), beyond an open end, deeper than
/// the limit, or when only faces that do not oppose it are near. `faces` must hold all master faces within
/// `depth` of the node; they ascend. `likely`, one of them or -1, is tried first: the search is quickest when
/// it is right.
std::optional<Winner> find_winner(const SurfaceView& master, const SlaveNode& slave, const Limits& limits,
                                  std::span<const int> faces, int likely = -1);

/// m, by how much node and master must approach each other before the node can touch: its distance when it is
/// outside, infinity when no face is within `reach`, else 0. `faces` must hold all that are; `reach`: at
/// least the depth limit and the largest approach that is of interest.
double clearance(const SurfaceView& master, const Eigen::Vector3d& x, double reach,
                 std::span<const int> faces);

}  // namespace elastogear::contact
