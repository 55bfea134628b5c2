#include "contact/search/candidates.h"

#include <algorithm>

namespace elastogear::contact {
namespace {

// Corners of the boxes around the faces of a surface, m, 3 x n_f each.
struct Boxes {
  Eigen::Matrix3Xd low, high;
};

Boxes boxes_around(const SurfaceView& surface, double margin) {
  const Eigen::Index n = surface.face.cols();
  Boxes boxes{Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n)};
  for (Eigen::Index f = 0; f < n; ++f) {
    Eigen::Array3d low = surface.x.col(surface.face(0, f)), high = low;
    for (int i = 1; i < 4; ++i) {
      const auto corner = surface.x.col(surface.face(i, f)).array();
      low = low.min(corner);
      high = high.max(corner);
    }
    boxes.low.col(f) = low - margin;
    boxes.high.col(f) = high + margin;
  }
  return boxes;
}

// The corners of each face, as bits, whose nodes it finds: a node is within the margin of the boxes of all
// faces around it, of which the first one finds it.
std::vector<unsigned char> corners_found(const SurfaceView& slave, const std::vector<bool>& tried) {
  std::vector<unsigned char> found(static_cast<std::size_t>(slave.face.cols()), 0);
  for (int node = 0; node < slave.topology.node_corners.size(); ++node) {
    const auto corners = slave.topology.node_corners[node];
    if (corners.empty() || !(tried.empty() || tried[node])) continue;
    found[corners[0] / 4] |= static_cast<unsigned char>(1U << (corners[0] % 4));
  }
  return found;
}

}  // namespace

void Candidates::collect(const SlaveFaces& faces, const SurfaceView& slave, const SurfaceView& master,
                         double margin) {
  const Boxes boxes = boxes_around(master, margin);
  const std::vector<unsigned char> found = corners_found(slave, faces.tried);
  near_.clear();
  for (const NodePair& pair : faces.pairs) {
    const int f = pair[1 - faces.entry], slave_face = pair[faces.entry];
    for (int i = 0; i < 4; ++i) {
      if (!(found[slave_face] >> i & 1)) continue;
      const int node = slave.face(i, slave_face);
      const auto q = slave.x.col(node).array();
      if ((q >= boxes.low.col(f).array()).all() && (q <= boxes.high.col(f).array()).all())
        near_.push_back({node, f});
    }
  }
  sort_by_node(static_cast<int>(slave.x.cols()));
}

// Counting sort by node, then each node's faces without duplicates.
void Candidates::sort_by_node(int n_nodes) {
  end_.assign(n_nodes, 0);
  for (const auto& entry : near_) ++end_[entry[0]];
  begin_.resize(n_nodes);
  int sum = 0;
  for (int i = 0; i < n_nodes; ++i) {
    begin_[i] = sum;
    sum += end_[i];
    end_[i] = begin_[i];
  }
  face_.resize(near_.size());
  for (const auto& [node, f] : near_) face_[end_[node]++] = f;
  nodes_.clear();
  for (int i = 0; i < n_nodes; ++i) {
    const auto first = face_.begin() + begin_[i], last = face_.begin() + end_[i];
    if (first != last) nodes_.push_back(i);
    if (last - first < 2) continue;
    std::sort(first, last);
    end_[i] = static_cast<int>(std::unique(first, last) - face_.begin());
  }
}

std::span<const int> Candidates::operator[](int slave_node) const {
  return std::span(face_).subspan(begin_[slave_node], end_[slave_node] - begin_[slave_node]);
}

}  // namespace elastogear::contact
