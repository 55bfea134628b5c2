#include "contact/search/neighbour_list.h"

#include <algorithm>
#include <cmath>

#include "elastogear/contact/kdop.h"

namespace elastogear::contact {
namespace {

constexpr double kFirstLimit = 0.125;        // of the skin
constexpr int kFewUses = 8, kManyUses = 64;  // stages
constexpr double kJump = 4;                  // limits

}  // namespace

double next_limit(const NeighbourList& neighbours, double distance, double skin) {
  if (neighbours.limit == 0) return kFirstLimit * skin;
  if (distance > kJump * neighbours.limit) return neighbours.limit;
  if (neighbours.uses < kFewUses) return std::min(2 * neighbours.limit, skin);
  return neighbours.uses > kManyUses ? neighbours.limit / 2 : neighbours.limit;
}

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

Eigen::Matrix3Xd corners_around(const Eigen::Matrix3Xd& X) {
  constexpr int kDirections = 24;
  const std::vector<Eigen::Vector3d> vertices = polyhedron(tight_kdop(kDirections, X)).vertices;
  Eigen::Matrix3Xd corners(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) corners.col(static_cast<Eigen::Index>(i)) = vertices[i];
  return corners;
}

// The way of a point is a convex function of its place: of all points of the hull a corner goes farthest.
double travel(const Eigen::Matrix3Xd& corners, double beyond, const RelativeMotion& from,
              const RelativeMotion& to) {
  const Eigen::Matrix3d dR = to.R - from.R;
  const double farthest2 = ((dR * corners).colwise() + (to.r - from.r)).colwise().squaredNorm().maxCoeff();
  return std::sqrt(farthest2) + dR.norm() / std::sqrt(2.0) * beyond;
}

std::span<const int> Neighbours::faces(std::size_t i) const {
  const int begin = i == 0 ? 0 : end[i - 1];
  return std::span(face).subspan(begin, end[i] - begin);
}

std::span<const int> Neighbours::faces_around(std::size_t i) const {
  const int begin = i == 0 ? 0 : around_end[i - 1];
  return std::span(around).subspan(begin, around_end[i] - begin);
}

void Neighbours::add(int node, std::span<const int> faces, std::span<const int> beside) {
  slave.push_back(node);
  face.insert(face.end(), faces.begin(), faces.end());
  end.push_back(static_cast<int>(face.size()));
  around.insert(around.end(), beside.begin(), beside.end());
  around_end.push_back(static_cast<int>(around.size()));
}

Neighbours everything(const Candidates& candidates) {
  const int n = candidates.nodes().empty() ? 0 : candidates.nodes().back() + 1;
  return not_apart(candidates, std::vector<double>(n, 0), 0);
}

Neighbours not_apart(const Candidates& candidates, const std::vector<double>& apart_until, double path) {
  Neighbours near;
  for (int node : candidates.nodes())
    if (apart_until[node] <= path) near.add(node, candidates[node], {});
  return near;
}

Neighbours not_apart(const Neighbours& neighbours, const std::vector<double>& apart_until, double path) {
  Neighbours near;
  for (std::size_t i = 0; i < neighbours.slave.size(); ++i)
    if (apart_until[neighbours.slave[i]] <= path)
      near.add(neighbours.slave[i], neighbours.faces(i), neighbours.faces_around(i));
  return near;
}

}  // namespace elastogear::contact
