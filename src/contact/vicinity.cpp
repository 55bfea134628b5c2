#include "elastogear/contact/vicinity.h"

#include <algorithm>

namespace elastogear::contact {
namespace {

void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

void add_ring(int node, const Topology& topology, const Eigen::Matrix4Xi& face, std::vector<int>& nodes) {
  nodes.push_back(node);
  for (int corner : topology.node_corners[node])
    for (int neighbour : face.col(corner / 4)) nodes.push_back(neighbour);
}

}  // namespace

Ball enclosing_ball(const Eigen::Matrix3Xd& X) {
  const Eigen::Vector3d centre = 0.5 * (X.rowwise().minCoeff() + X.rowwise().maxCoeff());
  return {centre, std::sqrt((X.colwise() - centre).colwise().squaredNorm().maxCoeff())};
}

RelativeMotion relative_motion(const SurfaceMotion& a, const SurfaceMotion& b) {
  return {b.R_WB.transpose() * a.R_WB, b.R_WB.transpose() * (a.r_WB - b.r_WB)};
}

double travel(const Ball& ball, const RelativeMotion& from, const RelativeMotion& to) {
  const Eigen::Matrix3d dR =
      to.R - from.R;  // its largest stretch is its Frobenius norm over the square root of 2
  return (dR * ball.centre + to.r - from.r).norm() + dR.norm() / std::sqrt(2.0) * ball.radius;
}

std::span<const int> Nearby::faces(std::size_t i) const {
  const int begin = i == 0 ? 0 : end[i - 1];
  return std::span(face).subspan(begin, end[i] - begin);
}

Nearby everything(const Candidates& candidates) {
  Nearby all{candidates.nodes(), {}, {}};
  for (int node : all.slave) {
    const auto faces = candidates[node];
    all.face.insert(all.face.end(), faces.begin(), faces.end());
    all.end.push_back(static_cast<int>(all.face.size()));
  }
  return all;
}

std::vector<int> nodes_around(std::span<const int> faces, const Topology& topology,
                              const Eigen::Matrix4Xi& face) {
  std::vector<int> distinct(faces.begin(), faces.end()), corners;
  sort_unique(distinct);
  for (int f : distinct)
    for (int node : face.col(f)) corners.push_back(node);
  sort_unique(corners);
  return nodes_around_nodes(corners, topology, face);
}

std::vector<int> nodes_around_nodes(const std::vector<int>& nodes, const Topology& topology,
                                    const Eigen::Matrix4Xi& face) {
  std::vector<int> around;
  for (int node : nodes) add_ring(node, topology, face, around);
  sort_unique(around);
  return around;
}

}  // namespace elastogear::contact
