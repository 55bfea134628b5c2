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
  /// m, by slave side, of each candidate: it cannot touch before the surfaces have moved by as much since.
  /// Empty: not known.
  std::array<std::vector<double>, 2> clearance;
  double limit = 0;                       ///< m, candidates of a larger clearance are left out
  std::array<std::vector<int>, 2> slave;  ///< by slave side: the candidates that stay, ascending
  std::array<std::vector<int>, 2> node;   ///< per surface: whose positions their fine search reads, ascending
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

/// Sets limit and slave.
void set_limit(Vicinity& vicinity, double limit);

/// Nodes of the slaves of one pass and of their candidate faces, with all nodes of the faces around them:
/// edges and vertices take their normals from there. Added to `node`, without duplicates, ascending.
void add_nodes_to_place(Vicinity& vicinity, int slave_side, const Topology* topology[2],
                        const Eigen::Matrix4Xi* face[2]);

/// Adds the nodes of one face to an ascending list.
void add_face(const Eigen::Matrix4Xi& face, int number, std::vector<int>& nodes);

}  // namespace elastogear::contact
