#include "contact/search/candidates.h"

#include <algorithm>

namespace elastogear::contact {

void Candidates::collect(const SlaveFaces& faces, const SurfaceView& slave, const SurfaceView& master,
                         double margin) {
  near_.clear();
  for (const NodePair& pair : faces.pairs) {
    const int f = pair[1 - faces.entry], slave_face = pair[faces.entry];
    // A node is within the margin of the boxes of all faces around it, of which the first one finds it.
    const auto finds = [&](int node) {
      return slave.topology.node_corners[node][0] / 4 == slave_face &&
             (faces.tried.empty() || faces.tried[node]);
    };
    const int sides = side_count(slave.face, slave_face);
    if (std::none_of(&slave.face(0, slave_face), &slave.face(0, slave_face) + sides, finds)) continue;
    const Eigen::Matrix<double, 3, 4> corners = master.x(Eigen::all, master.face.col(f));
    const Eigen::Vector3d lo = corners.rowwise().minCoeff().array() - margin;
    const Eigen::Vector3d hi = corners.rowwise().maxCoeff().array() + margin;
    for (int i = 0; i < sides; ++i) {
      const int node = slave.face(i, slave_face);
      if (!finds(node)) continue;
      const auto q = slave.x.col(node).array();
      if ((q >= lo.array()).all() && (q <= hi.array()).all()) near_.push_back({node, f});
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
