#pragma once
// The one face, edge or vertex of the master surface that a slave node touches (docs/theory, section
// 6.2).

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "contact/projection/closest_point.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {

struct FaceBounds;

struct SlaveNode {
  Eigen::Vector3d x;  ///< m
  std::function<Eigen::Vector3d()>
      normal;  ///< outward unit normal of the slave surface; asked for when inside
  /// All master faces within the depth limit, where `faces` of find_projection are only those that can be the
  /// nearest; asked for when the nearest does not oppose the node.
  std::function<std::span<const int>()> all_faces = {};
  Eigen::Vector3d undeformed_normal = Eigen::Vector3d::Zero();  ///< zero: not known
  const FaceBounds* bounds = nullptr;                           ///< of the master's faces; null: none
};

struct Limits {
  double depth = 0;         ///< m, largest distance to the surface
  double cos_angle = -0.1;  ///< n_slave . n_master must not exceed this
  double outside = 0;       ///< m, how far outside the surface a node is still taken
  double around = 0;        ///< m, from a slave node to master faces that points beside it may touch
};

struct Projection {
  int face = 0;
  ClosestPoint point;
  Eigen::Vector3d n;  ///< outward, x_slave - x_c = g_n n; of the surface where that vanishes
  double g_n = 0;     ///< m, < 0 inside
};

/// Is the way d (m) from the closest point to a point q (m) roundoff of positions? It then has no direction,
/// and the surface has its own normal there.
bool vanishes(const Eigen::Vector3d& d, const Eigen::Vector3d& q);

/// Nothing when the node is outside the master body (further than the limit), beyond a surface boundary,
/// deeper than the limit, or when only faces that do not oppose it are near. `faces` must hold all master
/// faces within `depth` of the node; they ascend. `likely`, if not null: one of them or -1, is tried first
/// and becomes the nearest. The search is quickest when it is right. `clearance`, if not null: becomes the
/// distance of a node that is outside by more than the limit, m, and otherwise stays.
std::optional<Projection> find_projection(const SurfaceView& master, const SlaveNode& slave,
                                          const Limits& limits, std::span<const int> faces,
                                          int* likely = nullptr, double* clearance = nullptr);

/// The foot point of q (m) on the face extended over its sides by at most a quarter of its length, from w on
/// it; nothing when there is none.
std::optional<Projection> extended_projection(const Face& face, const Eigen::Vector3d& q, Projection w);

struct Approach {
  double distance = 0;      ///< m, infinite when no face is within the reach
  double clearance = 0;     ///< m: before moving by as much a node that is outside cannot touch
  std::vector<int> faces;   ///< ascending: those that can be the nearest until it has moved by the limit
  std::vector<int> around;  ///< those within the distance `around` of Move, as long; none where that is 0
};

/// The same for a point near one whose nearest face is known: goes from that face to its neighbours as long
/// as they are nearer. It finds what find_projection finds where no other part of the master is as near.
std::optional<Projection> walk_to_projection(const SurfaceView& master, const Eigen::Vector3d& x,
                                             const Limits& limits, int start);

/// For moves of node and master towards each other by up to `limit`. The clearance of a node outside is its
/// distance, infinite when no face is within `reach` (>= depth limit + limit); otherwise 0. `faces` must hold
/// all that are.
struct Move {
  double reach = 0, limit = 0, around = 0;
  const FaceBounds* bounds = nullptr;  ///< of the master's faces; null: none
};
Approach approach(const SurfaceView& master, const Eigen::Vector3d& x, const Move& move,
                  std::span<const int> faces);

}  // namespace elastogear::contact
