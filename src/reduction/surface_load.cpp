#include "elastogear/reduction/surface_load.h"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>
#include <set>

namespace elastogear::reduction {
namespace {

using Corners = Eigen::Matrix<double, 3, 4>;

// Integral of N_i n dA over one bilinear face, column i; 2 x 2 Gauss points are exact. A triangle, whose
// third corner counts twice, needs no rule of its own.
Corners corner_areas(const Corners& X) {
  const double g = 1 / std::sqrt(3.0);
  const Eigen::Array4d xi_i(-1, 1, 1, -1), eta_i(-1, -1, 1, 1);
  Corners areas = Corners::Zero();
  for (double xi : {-g, g})
    for (double eta : {-g, g}) {
      const Eigen::Vector4d N = (1 + xi * xi_i) * (1 + eta * eta_i) / 4;
      const Eigen::Vector3d x_xi = X * (xi_i * (1 + eta * eta_i) / 4).matrix();
      const Eigen::Vector3d x_eta = X * (eta_i * (1 + xi * xi_i) / 4).matrix();
      areas += x_xi.cross(x_eta) * N.transpose();
    }
  return areas;
}

// Outward unit pressure's nodal forces, 3 x n_s, times 1 Pa.
Eigen::Matrix3Xd group_areas(const model::Surface& surface, int group) {
  Eigen::Matrix3Xd areas = Eigen::Matrix3Xd::Zero(3, surface.X.cols());
  for (Eigen::Index i = 0; i < surface.face.cols(); ++i) {
    if (surface.group[static_cast<std::size_t>(i)] != group) continue;
    const Corners at = corner_areas(surface.X(Eigen::all, surface.face.col(i)));
    for (int k = 0; k < 4; ++k) areas.col(surface.face(k, i)) += at.col(k);
  }
  return areas;
}

// The node nearest to the centre of the area.
Eigen::Index central_node(const model::Surface& surface, const Eigen::Matrix3Xd& areas) {
  const Eigen::RowVectorXd weight = areas.colwise().norm();
  const Eigen::Vector3d centre = surface.X * weight.transpose() / weight.sum();
  Eigen::Index nearest = -1;
  double least = 0;
  for (Eigen::Index i = 0; i < areas.cols(); ++i) {
    const double distance = (surface.X.col(i) - centre).norm();
    if (weight(i) > 0 && (nearest < 0 || distance < least)) nearest = i, least = distance;
  }
  return nearest;
}

std::string without_digits(const std::string& name) {
  std::string pattern;
  for (char c : name)
    if (!std::isdigit(static_cast<unsigned char>(c))) pattern += c;
  return pattern;
}

}  // namespace

std::vector<SurfaceLoad> representative_loads(const model::Surface& surface) {
  std::vector<SurfaceLoad> loads;
  std::set<std::string> patterns;
  for (int group = 0; group < static_cast<int>(surface.group_name.size()); ++group) {
    const std::string& name = surface.group_name[group];
    if (patterns.size() == kMostGroups) break;
    if (!patterns.insert(without_digits(name)).second) continue;
    const Eigen::Matrix3Xd areas = group_areas(surface, group);
    const Eigen::Index node = central_node(surface, areas);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(areas.size());
    force.segment<3>(3 * node) = -areas.col(node).normalized();
    loads.push_back({name + " pressure", -areas.reshaped()});
    loads.push_back({name + " force", force});
  }
  return loads;
}

}  // namespace elastogear::reduction
