#include "elastogear/recovery/boxes.h"

#include <algorithm>

#include "elastogear/base/sort_unique.h"

namespace elastogear::recovery {
namespace {

void append(Boxes& boxes, const contact::Kdop& dop, int level, int overlaps) {
  const contact::Polyhedron shape = contact::polyhedron(dop);
  const int first = static_cast<int>(boxes.points.size());
  boxes.points.insert(boxes.points.end(), shape.vertices.begin(), shape.vertices.end());
  for (std::vector<int> polygon : shape.faces) {
    for (int& vertex : polygon) vertex += first;
    boxes.polygons.push_back(std::move(polygon));
    boxes.level.push_back(level);
    boxes.overlaps.push_back(overlaps);
  }
}

std::vector<int> leaf_of_face(const contact::Bvh& tree) {
  std::vector<int> leaf((tree.n_nodes() + 1) / 2);
  for (int node = 0; node < tree.n_nodes(); ++node)
    if (tree.is_leaf(node)) leaf[tree.face(node)] = node;
  return leaf;
}

}  // namespace

contact::Bvh fitted_tree(const model::Surface& surface, const Eigen::Matrix3Xd& x, int k) {
  contact::Bvh tree = contact::build(surface.X, surface.face, k);
  contact::RefitMemory work;
  contact::refit(tree, x, surface.face, 0, work);
  return tree;
}

Boxes boxes_at_levels(const contact::Bvh& tree, const std::vector<int>& levels) {
  const int depth = contact::depth(tree);
  Boxes boxes;
  for (int level : levels)
    for (int node : contact::nodes_at_level(tree, std::min(level, depth)))
      append(boxes, contact::box(tree, node), std::min(level, depth), 0);
  return boxes;
}

Boxes overlapping_boxes(const contact::Bvh& tree, const contact::Bvh& other) {
  contact::DescentMemory work;
  std::vector<contact::NodePair> pairs;
  contact::overlapping_faces(tree, other, {}, work, pairs);
  std::vector<int> faces;
  for (const contact::NodePair& pair : pairs) faces.push_back(pair[0]);
  sort_unique(faces);
  const std::vector<int> leaf = leaf_of_face(tree);
  Boxes boxes;
  for (int face : faces) append(boxes, contact::box(tree, leaf[face]), contact::depth(tree), 1);
  return boxes;
}

}  // namespace elastogear::recovery
