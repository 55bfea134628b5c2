#pragma once
// Coarse search: pairs of faces of two moving surfaces that may be closer than a margin.

#include <Eigen/Core>
#include <vector>

#include "contact/search/realign.h"
#include "elastogear/contact/bvh.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Placement of both surfaces. The common frame is that of surface b.
struct Configuration {
  Eigen::Matrix3Xd x[2];                            ///< 3 x n, m, both surfaces in the common frame
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< frame of a to common frame
  Eigen::Vector3d r = Eigen::Vector3d::Zero();      ///< m, origin of a's frame in the common frame
};

/// Two trees with their scratch memory.
class CoarseSearch {
 public:
  /// X, face of a and b in their own frames; must outlive the search.
  CoarseSearch(const model::Surface& a, const model::Surface& b, int k, Update update);

  /// All pairs (face of a, face of b) closer than `margin` (m), and some more. Valid until the next call. The
  /// boxes follow x, with Update::realign the undeformed surfaces: there `margin` must cover the deformation.
  const std::vector<NodePair>& face_pairs(const Configuration& configuration, double margin);

  const Bvh& tree(int side) const { return tree_[side]; }

 private:
  void refit_both(const Configuration& configuration, double margin);
  void realign_pair(int first, const Realignment& motion, double margin);

  const model::Surface* surface_[2];
  Update update_;
  Bvh tree_[2];               // boxes in the common frame
  std::vector<Kdop> rest_;    // a's boxes in its own frame, for realignment
  std::vector<int> visited_;  // per node of a: the call in which its box was realigned last
  int call_ = 0;
  RefitMemory refit_;
  DescentMemory work_;
  std::vector<NodePair> pairs_;
};

}  // namespace elastogear::contact
