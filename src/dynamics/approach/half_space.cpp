#include "dynamics/approach/half_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"
#include "elastogear/contact/topology.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Mean of 1/r between two points of a rectangle with the sides a and b.
double mean_within(double a, double b) {
  const double integral = 2. / 3 *
                          (3 * a * a * b * std::asinh(b / a) + 3 * a * b * b * std::asinh(a / b) + a * a * a +
                           b * b * b - std::pow(a * a + b * b, 1.5));
  return integral / (a * a * b * b);
}

// The sides of cells that the surface's faces are parts of, each once: corners, then the nodes between them.
std::vector<std::vector<int>> sides_of(const model::Surface& surface) {
  std::map<std::vector<int>, std::vector<int>> sides;  // by their nodes in order
  for (Index f = 0; f < surface.face.cols(); ++f) {
    std::vector<int> side;
    for (Index i = 0; i < surface.side.rows() && surface.side.cols() > 0; ++i)
      if (surface.side(i, f) >= 0) side.push_back(surface.side(i, f));
    if (side.empty()) {
      side.assign(surface.face.col(f).begin(), surface.face.col(f).end());
      if (side[3] == side[2]) side.pop_back();
    }
    std::vector<int> key = side;
    std::sort(key.begin(), key.end());
    sides.try_emplace(std::move(key), std::move(side));
  }
  std::vector<std::vector<int>> result;
  for (auto& [key, side] : sides) result.push_back(std::move(side));
  return result;
}

int corners_of(const std::vector<int>& side) {
  const auto n = static_cast<int>(side.size());
  return n > 4 ? n / 2 : n;
}

// A side by its corners; a triangle is a quadrilateral with a side of no length.
struct Plane {
  Eigen::Matrix<double, 3, 4> X;
  int corners;

  Plane(const Eigen::Matrix3Xd& nodes, const std::vector<int>& side) : corners(corners_of(side)) {
    for (int c = 0; c < 4; ++c)
      X.col(c) = nodes.col(side[static_cast<std::size_t>(std::min(c, corners - 1))]);
  }
  // Linear functions of the corners, of a triangle the third and fourth added up.
  Eigen::Vector4d linear(const contact::Shape& shape) const {
    Eigen::Vector4d N = shape.N;
    if (corners == 3) N[2] += std::exchange(N[3], 0);
    return N;
  }
  double area(const contact::Shape& shape) const {  // per that of (u, v)
    return (X * shape.N_u).cross(X * shape.N_v).norm();
  }
};

// Into how many parts the sides of a face are cut, so that these are about as long as wide.
std::pair<int, int> cuts(const Plane& plane) {
  constexpr int kLeast = 4, kMost = 16;
  const auto& X = plane.X;
  const double u = (X.col(1) - X.col(0) + X.col(2) - X.col(3)).norm(),
               v = (X.col(3) - X.col(0) + X.col(2) - X.col(1)).norm(), least = std::min(u, v);
  const auto n = [&](double length) {
    return std::clamp(static_cast<int>(std::lround(kLeast * length / least)), kLeast, kMost);
  };
  return {n(u), n(v)};
}

// Interpolation functions of a side's nodes from the linear ones of its corners.
std::vector<double> functions(const std::vector<int>& side, const Eigen::Vector4d& linear, int corners) {
  std::vector<double> N(side.size());
  for (int i = 0; i < corners; ++i) N[static_cast<std::size_t>(i)] = linear[i];
  for (int i = 0; i < static_cast<int>(side.size()) - corners; ++i) {
    const int j = (i + 1) % corners;
    const double both = corners == 4 ? linear[i] + linear[j] : 1,
                 between = both > 0 ? 4 * linear[i] * linear[j] / both : 0;
    N[static_cast<std::size_t>(corners) + static_cast<std::size_t>(i)] = between;
    N[static_cast<std::size_t>(i)] -= between / 2;
    N[static_cast<std::size_t>(j)] -= between / 2;
  }
  return N;
}

// Adds the parts of one side, whose forces are yet areas times the pressure, and the forces on its nodes.
void add_side(const Plane& plane, const std::vector<int>& side, int corner, int number, HatPressure& hat,
              std::map<int, double>& nodal_force) {
  const double point = 1 / std::sqrt(3.);  // of Gauss's rule
  const auto [n_u, n_v] = cuts(plane);
  const auto at = static_cast<Index>(std::find(side.begin(), side.end(), corner) - side.begin());
  for (int i = 0; i < n_u; ++i)
    for (int j = 0; j < n_v; ++j) {
      HatPressure::Part part{Vector3d::Zero(), 0, 0, 0, number++};
      const double u = (2 * i + 1.) / n_u - 1, v = (2 * j + 1.) / n_v - 1;
      for (int g = 0; g < 4; ++g) {
        const contact::Shape shape =
            contact::shape(4, u + (g % 2 == 0 ? -point : point) / n_u, v + (g < 2 ? -point : point) / n_v);
        const Eigen::Vector4d N = plane.linear(shape);
        const double area = plane.area(shape) / (n_u * n_v), force = N[at] * area;
        part.x += force * (plane.X * shape.N);
        part.force += force;
        part.area += area;
        const std::vector<double> of_node = functions(side, N, plane.corners);
        for (std::size_t k = 0; k < side.size(); ++k) nodal_force[side[k]] += of_node[k] * force;
      }
      part.x /= part.force;
      const contact::Shape middle = contact::shape(4, u, v);
      part.inverse_own =
          mean_within(2 * (plane.X * middle.N_u).norm() / n_u, 2 * (plane.X * middle.N_v).norm() / n_v);
      hat.parts.push_back(part);
    }
}

HatPressure::Columns columns(const std::vector<HatPressure::Part>& parts) {
  const Index n = std::ssize(parts);
  HatPressure::Columns all{
      {Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd(n)}, Eigen::ArrayXd(n), Eigen::ArrayXd(n)};
  for (Index i = 0; const HatPressure::Part& part : parts) {
    for (int k = 0; k < 3; ++k) all.x[k][i] = part.x[k];
    all.force[i] = part.force;
    all.area[i++] = part.area;
  }
  return all;
}

// Position of the part with this number, which ascend; that of the first one after it where there is none.
Index find_part(const std::vector<HatPressure::Part>& parts, int number) {
  const auto before = [](const HatPressure::Part& part, int n) { return part.number < n; };
  return std::lower_bound(parts.begin(), parts.end(), number, before) - parts.begin();
}

// Mean of 1/r between two pressures. Eq. (6.36b).
double mean_between(const HatPressure& a, const HatPressure& b) {
  const HatPressure::Columns& q = b.columns;
  Eigen::ArrayXd inverse(q.force.size());
  double sum = 0;
  for (const HatPressure::Part& p : a.parts) {
    inverse = ((q.x[0] - p.x[0]).square() + (q.x[1] - p.x[1]).square() + (q.x[2] - p.x[2]).square())
                  .sqrt()
                  .inverse();
    inverse += (q.area + p.area) * (1. / 24) * inverse.cube();
    const Index own = find_part(b.parts, p.number);
    if (own < inverse.size() && b.parts[static_cast<std::size_t>(own)].number == p.number)
      inverse[own] = p.inverse_own;
    sum += p.force * (q.force * inverse).sum();
  }
  return sum;
}

}  // namespace

HalfSpace::HalfSpace(const model::Surface& surface)
    : surface_(&surface), side_(sides_of(surface)), at_node_(surface.node.size()) {
  for (std::size_t s = 0; s < side_.size(); ++s)
    for (int node : side_[s]) at_node_[static_cast<std::size_t>(node)].push_back(static_cast<int>(s));
}

const HatPressure& HalfSpace::pressure(int corner) {
  constexpr int kMostParts = 256;  // of a side
  const auto [found, is_new] = pressure_.try_emplace(corner);
  HatPressure& hat = found->second;
  if (!is_new) return hat;
  std::map<int, double> nodal_force;
  for (int s : at_node_[static_cast<std::size_t>(corner)]) {
    const std::vector<int>& side = side_[static_cast<std::size_t>(s)];
    add_side(Plane(surface_->X, side), side, corner, kMostParts * s, hat, nodal_force);
  }
  double all = 0;
  for (const HatPressure::Part& part : hat.parts) all += part.force;
  for (HatPressure::Part& part : hat.parts) hat.x += (part.force /= all) * part.x;
  for (const HatPressure::Part& part : hat.parts) hat.size = std::max(hat.size, (part.x - hat.x).norm());
  hat.columns = columns(hat.parts);
  for (const auto& [node, force] : nodal_force) hat.nodal_force.emplace_back(node, force / all);
  return hat;
}

contact::Spread HalfSpace::spread(int node, const Vector3d& along) {
  std::set<int> corners;
  for (int s : at_node_[static_cast<std::size_t>(node)]) {
    const std::vector<int>& side = side_[static_cast<std::size_t>(s)];
    corners.insert(side.begin(), side.begin() + corners_of(side));
  }
  require(
      !corners.empty(), "node ", surface_->node[static_cast<std::size_t>(node)],
      " of the mesh (counted from 0) bears a contact force and belongs to no face of the contact surface");
  contact::Spread result{{corners.begin(), corners.end()}, {}};
  Eigen::Matrix3Xd away(3, std::ssize(result.node));
  for (Index i = 0; i < away.cols(); ++i)
    away.col(i) = pressure(result.node[static_cast<std::size_t>(i)]).x - surface_->X.col(node);
  result.weight = contact::spread_weights(away, along);
  return result;
}

double HalfSpace::mean_inverse_distance(int i, int j) {
  constexpr double kFar = 4;  // distance over the size of a pressure, from which it acts as a force
  if (i > j) std::swap(i, j);
  const auto n = static_cast<std::int64_t>(surface_->node.size());
  const auto [at, is_new] = known_.try_emplace(i * n + j, 0);
  if (!is_new) return at->second;
  const HatPressure &a = pressure(i), &b = pressure(j);
  const double away = (a.x - b.x).norm();
  return at->second = away > kFar * std::max(a.size, b.size) ? 1 / away : mean_between(a, b);
}

}  // namespace elastogear::dynamics
