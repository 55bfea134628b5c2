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

void set_limit(Vicinity& vicinity, double limit) {
  vicinity.limit = limit;
  for (int side : {0, 1}) {
    const std::vector<int>& all = vicinity.candidates[side].nodes();
    const std::vector<double>& clearance = vicinity.clearance[side];
    vicinity.slave[side].clear();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (clearance.empty() || clearance[i] <= limit) vicinity.slave[side].push_back(all[i]);
  }
}

void add_nodes_to_place(Vicinity& vicinity, int slave_side, const Topology* topology[2],
                        const Eigen::Matrix4Xi* face[2]) {
  const int master = 1 - slave_side;
  const Candidates& candidates = vicinity.candidates[slave_side];
  auto& nodes = vicinity.node;
  std::vector<int> faces;
  for (int node : vicinity.slave[slave_side]) {
    add_ring(node, *topology[slave_side], *face[slave_side], nodes[slave_side]);
    const auto near = candidates[node];
    faces.insert(faces.end(), near.begin(), near.end());
  }
  sort_unique(faces);
  std::vector<int> corners;
  for (int f : faces)
    for (int node : face[master]->col(f)) corners.push_back(node);
  sort_unique(corners);
  for (int node : corners) add_ring(node, *topology[master], *face[master], nodes[master]);
  for (auto& list : nodes) sort_unique(list);
}

void add_face(const Eigen::Matrix4Xi& face, int number, std::vector<int>& nodes) {
  for (int node : face.col(number)) {
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
    if (at == nodes.end() || *at != node) nodes.insert(at, node);
  }
}

}  // namespace elastogear::contact
