#include "app/gear/section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace elastogear::app {
namespace {

using Edge = std::pair<int, int>;  // of the mesh, by its nodes in ascending order: a corner of an outline

// The outline's corner before and after each one.
using Chain = std::multimap<Edge, Edge>;

Edge edge_of(int a, int b) { return std::minmax(a, b); }

// Corners of the section of one face, two for each piece of outline that it adds.
std::vector<Edge> crossed_edges(const mesh::Face& face, const Eigen::VectorXd& distance) {
  std::vector<Edge> crossed;
  for (int i = 0; i < 4; ++i) {
    const int a = face[i], b = face[(i + 1) % 4];
    if (a != b && (distance[a] > 0) != (distance[b] > 0)) crossed.push_back(edge_of(a, b));
  }
  return crossed;
}

Chain chain(const mesh::Mesh& mesh, const Eigen::VectorXd& distance) {
  Chain neighbour;
  for (const mesh::Face& face : mesh::boundary_faces(mesh)) {
    const std::vector<Edge> crossed = crossed_edges(face, distance);
    for (std::size_t i = 0; i + 1 < crossed.size(); i += 2) {
      neighbour.emplace(crossed[i], crossed[i + 1]);
      neighbour.emplace(crossed[i + 1], crossed[i]);
    }
  }
  return neighbour;
}

// Takes one outline out of the chain, from its first corner on.
std::vector<Edge> take_outline(Chain& neighbour) {
  std::vector<Edge> outline{neighbour.begin()->first};
  while (true) {
    const auto next = neighbour.find(outline.back());
    if (next == neighbour.end()) return outline;
    const Edge from = next->first, to = next->second;
    neighbour.erase(next);
    const auto [first, last] = neighbour.equal_range(to);
    const auto back = std::find_if(first, last, [&](const auto& entry) { return entry.second == from; });
    if (back != last) neighbour.erase(back);
    outline.push_back(to);
  }
}

}  // namespace

std::vector<std::vector<Eigen::Vector2d>> section(const mesh::Mesh& mesh, const Plane& plane) {
  constexpr double kBeside = 1e-6;  // of the size of the mesh
  const double size = (mesh.X.rowwise().maxCoeff() - mesh.X.rowwise().minCoeff()).norm();
  const Eigen::Vector3d n = plane.e_1.cross(plane.e_2);
  const Eigen::VectorXd distance =
      (n.transpose() * (mesh.X.colwise() - plane.point)).transpose().array() - kBeside * size;
  Chain neighbour = chain(mesh, distance);
  std::vector<std::vector<Eigen::Vector2d>> outlines;
  while (!neighbour.empty()) {
    std::vector<Eigen::Vector2d> points;
    for (const Edge& edge : take_outline(neighbour)) {
      const double share = distance[edge.first] / (distance[edge.first] - distance[edge.second]);
      const Eigen::Vector3d x =
          (1 - share) * mesh.X.col(edge.first) + share * mesh.X.col(edge.second) - plane.point;
      points.emplace_back(x.dot(plane.e_1), x.dot(plane.e_2));
    }
    outlines.push_back(std::move(points));
  }
  return outlines;
}

}  // namespace elastogear::app
