#pragma once
// The nodes and faces that may touch as long as two surfaces move by no more than a skin. They are kept from
// one search to the next, so that the stages between neither search nor displace nodes that cannot touch.

#include <array>
#include <span>
#include <vector>

#include "contact/search/candidates.h"
#include "contact/search/coarse_search.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Slave nodes and for each the master faces that it is tried against.
struct Neighbours {
  std::vector<int> slave;  ///< ascending
  std::vector<int> end;    ///< of each one's range of face
  std::vector<int> face;   ///< ascending within a range
  /// The same for the faces that points beside the node may touch; none where these are not asked for.
  std::vector<int> around_end = {}, around = {};

  std::span<const int> faces(std::size_t i) const;
  std::span<const int> faces_around(std::size_t i) const;
  void add(int node, std::span<const int> faces, std::span<const int> around);
};

struct NeighbourList {
  SurfaceMotion found_at[2];             ///< of both surfaces when the candidates were found
  std::array<Candidates, 2> candidates;  ///< by slave side; only those of the passes that are run
  SurfaceMotion measured_at[2];          ///< when their clearance was measured
  double limit = 0;                      ///< m, relative motion since for which `within` is sufficient
  double near_limit = 0;                 ///< m, and the same for `near`, which is a part of it
  int uses = 0;                          ///< of `within` since
  double path = 0;                       ///< m, of the surfaces from the search to measured_at, step by step
  std::array<std::vector<double>, 2> apart_until;  ///< by slave side and node: the path without touch, m
  std::array<Neighbours, 2> within, near;          ///< by slave side: the candidates that can touch
};

/// The relative motion, m, for which the next measurement of clearance serves: at first a share of the skin,
/// twice as much when the last one has served few stages only, half as much after many. A motion much longer
/// than that since it, as from position to position of a sweep, says nothing of the stages that follow.
double next_limit(const NeighbourList& neighbours, double distance, double skin);

/// Ball around the undeformed nodes of a surface in its own frame.
struct Ball {
  Eigen::Vector3d centre;
  double radius = 0;
};
Ball enclosing_ball(const Eigen::Matrix3Xd& X);

/// Motion of a in the frame of b: x -> R x + r.
struct RelativeMotion {
  Eigen::Matrix3d R;
  Eigen::Vector3d r;
};
RelativeMotion relative_motion(const SurfaceMotion& a, const SurfaceMotion& b);

/// Bound of the distance that the ball's points have gone from one placement to the other, m.
double travel(const Ball& ball, const RelativeMotion& from, const RelativeMotion& to);

/// Corners of the 24-DOP around the undeformed nodes of a surface, m, in its own frame.
Eigen::Matrix3Xd corners_around(const Eigen::Matrix3Xd& X);
/// The same bound for points that are within `beyond` (m) of their hull. A long body that spins about its
/// axis moves them far less than the ball around it.
double travel(const Eigen::Matrix3Xd& corners, double beyond, const RelativeMotion& from,
              const RelativeMotion& to);

/// All candidates, with all faces they are near.
Neighbours everything(const Candidates& candidates);
/// Candidates or neighbours without the nodes whose entry of apart_until exceeds `path`.
Neighbours not_apart(const Candidates& candidates, const std::vector<double>& apart_until, double path);
Neighbours not_apart(const Neighbours& neighbours, const std::vector<double>& apart_until, double path);

}  // namespace elastogear::contact
