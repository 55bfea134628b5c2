#pragma once
// Binary tree of k-DOPs over the faces of a surface, in flat arrays. Built once in the reference
// configuration; boxes then follow the surface leaf-up (refit) or as rotated k-DOPs (realign.h).

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "elastogear/base/instructions.h"
#include "elastogear/contact/kdop.h"

namespace elastogear::contact {

/// Intervals of a box in memory: k/2 filled up to a multiple of four, so that four are compared at a time.
constexpr int padded_half(int k) { return (k / 2 + 3) / 4 * 4; }

/// Node 0 is the root; children come in pairs and after their parent.
struct Bvh {
  int k = 0;
  std::vector<int> child;  ///< per node: first of two neighbouring children, or -1 - face for a leaf
  /// 2 padded_half(k) per node: lo of the intervals, then -hi, both rounded outwards; -infinity in the
  /// padding
  std::vector<float> box;

  int n_nodes() const { return static_cast<int>(child.size()); }
  bool is_leaf(int node) const { return child[node] < 0; }
  int face(int leaf) const { return -1 - child[leaf]; }
};

/// One face per leaf, top-down by the surface-area heuristic over all k-DOP directions.
/// X: 3 x n (m); face: 4 x n_f node numbers, n_f > 0.
Bvh build(const Eigen::Matrix3Xd& X, const Eigen::Matrix4Xi& face, int k);

/// Scratch memory of refit(), kept between calls, and what its kernel may use; boxes do not depend on it.
struct RefitMemory {
  std::vector<float> points = {};
  Instructions instructions = best_instructions();
};

/// Recomputes all boxes from moved points, leaves first; every box is `margin` (m) wider than its faces.
void refit(Bvh& bvh, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, double margin,
           RefitMemory& work);

/// A node's box in double precision, and back (rounded outwards).
Kdop box(const Bvh& bvh, int node);
void set_box(Bvh& bvh, int node, const Kdop& dop);

using NodePair = std::array<int, 2>;

/// Scratch memory of a descent, kept between calls.
struct DescentMemory {
  std::vector<NodePair> front, next;
};

/// Pairs of faces (a, b) whose leaf boxes overlap, by simultaneous breadth-first descent; both trees in one
/// frame, same k. `visit_a`, when given, is called with the first of two siblings of `a` before their boxes
/// are read and may set them. The order of the pairs depends on the trees alone.
void overlapping_faces(const Bvh& a, const Bvh& b, const std::function<void(int)>& visit_a,
                       DescentMemory& work, std::vector<NodePair>& pairs);

/// Nodes at a depth below the root (level 0), with the leaves that ended above it: together they always hold
/// the whole surface. For pictures.
std::vector<int> nodes_at_level(const Bvh& bvh, int level);

/// Longest way from the root to a leaf.
int depth(const Bvh& bvh);

}  // namespace elastogear::contact
