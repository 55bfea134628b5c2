#pragma once
// What may touch as long as two surfaces move by no more than a skin: kept from one search to the next, so
// that the stages between neither search nor displace nodes that cannot touch.

#include <array>
#include <vector>

#include "elastogear/contact/candidates.h"
#include "elastogear/contact/coarse_search.h"
#include "elastogear/contact/pair.h"

namespace elastogear::contact {

struct Vicinity {
  SurfaceMotion found_at[2];             ///< of both surfaces when it was found
  std::array<Candidates, 2> candidates;  ///< by slave side; only those of the passes that are run
  std::array<std::vector<int>, 2> node;  ///< per surface: whose positions the fine search reads, ascending
};

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

/// Bound of the way that the ball's points have gone from one placement to the other, m.
double travel(const Ball& ball, const RelativeMotion& from, const RelativeMotion& to);

/// Nodes of the candidates of one pass, with all nodes of the faces around them: edges and vertices take
/// their normals from there. Added to `nodes` (by surface), without duplicates, ascending.
void add_nodes_to_place(const Candidates& candidates, int slave_side, const Topology* topology[2],
                        const Eigen::Matrix4Xi* face[2], std::array<std::vector<int>, 2>& nodes);

/// Adds the nodes of one face to an ascending list.
void add_face(const Eigen::Matrix4Xi& face, int number, std::vector<int>& nodes);

}  // namespace elastogear::contact
