#pragma once
// Meshes that repeat around an axis: found and verified node by node and cell by cell, whatever the
// numbering.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// A turn by 2 pi / n_sectors about a line.
struct Turn {
  int n_sectors = 1;                                ///< Z
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, on the line
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector along it
};

/// A mesh that a turn maps onto itself. An orbit is what the turn makes of one node or one cell: of a node
/// off the axis Z nodes, of a node on it that node alone.
struct Repetition {
  Turn turn;
  std::vector<int> orbit;         ///< of each node, 0..n_orbits-1; -1: in no cell
  std::vector<int> sector_index;  ///< of each node: how often its orbit's first node was turned to come here
  std::vector<bool> on_axis;      ///< of each orbit
  std::vector<int> cell;          ///< one of each orbit of cells
  std::vector<int> cell_count;    ///< cells in that orbit: Z, or a divisor of it when they enclose the axis
};

/// Labels of cells and nodes that a turn must keep besides the geometry.
struct Labels {
  const std::vector<int>& cell;   ///< of each cell, e.g. its material
  const std::vector<bool>& node;  ///< of each node, e.g. whether it is free
};

struct RepetitionSearch {
  std::optional<Repetition> found;
  std::string reason;  ///< why not, in the words of the most successful trial
};

/// The turn with the largest Z >= 2 about one of the mesh's axes (the coordinate directions and the principal
/// directions through the nodes' centroid) that maps every node to a node (within 1e-6 of the shortest edge
/// there), every cell to a cell of the same type with the same faces, and labels to themselves. Nodes in no
/// cell do not count. Coincident nodes are a reason for not finding any.
RepetitionSearch find_repetition(const Mesh& mesh, const Labels& labels);

}  // namespace elastogear::mesh
