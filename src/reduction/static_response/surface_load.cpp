#include "elastogear/reduction/surface_load.h"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>
#include <set>

#include "elastogear/base/error.h"

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

Eigen::Vector3d centre_of(const model::Surface& surface, const Eigen::RowVectorXd& weight) {
  return surface.X * weight.transpose() / weight.sum();
}

// The node nearest to the centre of the area.
Eigen::Index central_node(const model::Surface& surface, const Eigen::Matrix3Xd& areas) {
  const Eigen::RowVectorXd weight = areas.colwise().norm();
  const Eigen::Vector3d centre = centre_of(surface, weight);
  Eigen::Index nearest = -1;
  double least = 0;
  for (Eigen::Index i = 0; i < areas.cols(); ++i) {
    const double distance = (surface.X.col(i) - centre).norm();
    if (weight(i) > 0 && (nearest < 0 || distance < least)) nearest = i, least = distance;
  }
  return nearest;
}

// The kinds of smooth_loads on one group, 3 n_s x 7.
Eigen::Matrix<double, Eigen::Dynamic, 7> group_loads(const model::Surface& surface, int group) {
  const Eigen::Matrix3Xd areas = group_areas(surface, group);
  const Eigen::RowVectorXd weight = areas.colwise().norm();
  const Eigen::Matrix3Xd offset = surface.X.colwise() - centre_of(surface, weight);
  Eigen::Matrix<double, Eigen::Dynamic, 7> loads(areas.size(), 7);
  loads.col(0) = -areas.reshaped();
  for (int d = 0; d < 3; ++d) {
    loads.col(1 + d) = (Eigen::Vector3d::Unit(d) * weight).reshaped();
    loads.col(4 + d) = -(areas * offset.row(d).asDiagonal()).reshaped();
  }
  return loads;
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

Eigen::MatrixXd smooth_loads(const model::Surface& surface, int most) {
  const int n_groups = static_cast<int>(surface.group_name.size());
  require(n_groups <= most, "modes = ", most, ": the loads on the surface, one for each of its ", n_groups,
          " areas, need a column each; take more modes or name fewer face sets by the option loaded");
  const int n_kinds = 7 * n_groups <= most ? 7 : 4 * n_groups <= most ? 4 : 1;
  Eigen::MatrixXd loads(surface.X.size(), n_kinds * n_groups);
  for (int group = 0; group < n_groups; ++group) {
    const auto of_group = group_loads(surface, group);
    for (int kind = 0; kind < n_kinds; ++kind) loads.col(kind * n_groups + group) = of_group.col(kind);
  }
  return loads;
}

}  // namespace elastogear::reduction
