#pragma once
// The k-DOPs of a surface's tree as polyhedra, for pictures (the paper's Figs. 3 and 4).

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/bvh.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::recovery {

/// Polygons of many polyhedra; per polygon its tree level and whether its box is a leaf that overlaps a leaf
/// of the other body.
struct Boxes {
  std::vector<Eigen::Vector3d> points;  ///< m, world frame
  std::vector<std::vector<int>> polygons;
  std::vector<int> level;     ///< 0: root
  std::vector<int> overlaps;  ///< 0 or 1
};

/// Tree of a surface, fitted to its node positions x (3 x n_s, m, world frame).
contact::Bvh fitted_tree(const model::Surface& surface, const Eigen::Matrix3Xd& x, int k);

/// Boxes at the given levels; levels beyond the depth stand for the leaves.
Boxes boxes_at_levels(const contact::Bvh& tree, const std::vector<int>& levels);

/// Boxes of the leaves that overlap a leaf of the other tree.
Boxes overlapping_boxes(const contact::Bvh& tree, const contact::Bvh& other);

}  // namespace elastogear::recovery
