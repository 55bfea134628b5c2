#pragma once
// From pairs of faces to the master faces that each slave node has to be tried against.

#include <span>
#include <vector>

#include "elastogear/contact/bvh.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// The slave faces of pairs of faces.
struct SlaveFaces {
  const std::vector<NodePair>& pairs;
  int entry;                       ///< of each pair that is the slave's
  const std::vector<bool>& tried;  ///< nodes that count; empty: all
};

/// Memory is kept between calls.
class Candidates {
 public:
  /// Nodes of slave faces whose distance to the box around a paired master face is at most `margin` (m).
  void collect(const SlaveFaces& faces, const SurfaceView& slave, const SurfaceView& master, double margin);

  /// Ascending, without duplicates; empty for nodes that are near no face.
  std::span<const int> operator[](int slave_node) const;
  /// Slave nodes that are near a face, ascending.
  const std::vector<int>& nodes() const { return nodes_; }

 private:
  void sort_by_node(int n_nodes);

  std::vector<std::array<int, 2>> near_;  // slave node, master face
  std::vector<int> begin_, end_, face_;   // per node: its range of face_
  std::vector<int> nodes_;
};

}  // namespace elastogear::contact
