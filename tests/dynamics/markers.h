#pragma once
// Markers on the end faces of test boxes.

#include <Eigen/LU>
#include <string>
#include <vector>

#include "elastogear/base/rotation.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::test {

/// Dense rows of one surface node.
inline Eigen::MatrixXd node_rows(const model::ElasticBody& body, int node) {
  return model::with_rows(body.surface.Phi, [&](const auto& rows) -> Eigen::MatrixXd {
    return Eigen::MatrixXd(rows.middleRows(3 * node, 3));
  });
}

/// The marker of the face group, named after it: least-squares motion of its nodes.
inline model::Marker end_marker(const model::ElasticBody& body, int group) {
  const model::Surface& surface = body.surface;
  std::vector<int> nodes;
  for (Eigen::Index f = 0; f < surface.face.cols(); ++f)
    for (int node : surface.face.col(f))
      if (surface.group[f] == group && std::find(nodes.begin(), nodes.end(), node) == nodes.end())
        nodes.push_back(node);
  model::Marker marker{surface.group_name[group], surface.X(Eigen::all, nodes).rowwise().mean()};
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Zero(6, body.n_q());
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (int node : nodes) {
    const Eigen::Matrix3d r = skew(surface.X.col(node) - marker.X);
    Phi.topRows<3>() += node_rows(body, node) / static_cast<double>(nodes.size());
    Phi.bottomRows<3>() += r * node_rows(body, node);
    J -= r * r;
  }
  Phi.bottomRows<3>() = J.inverse() * Phi.bottomRows<3>();
  if (body.basis == model::Basis::full)
    marker.Phi = model::SparseRows(Phi.sparseView());
  else
    marker.Phi = model::DenseRows(Phi);
  return marker;
}

inline void add_end_markers(model::ElasticBody& body) {
  for (int group : {0, 1}) body.markers.push_back(end_marker(body, group));
}

}  // namespace elastogear::test
