#pragma once
// The compliance among the stations of two bodies in contact, right below their meshes (docs/theory,
// section 6.18).

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "elastogear/contact/load_table.h"
#include "elastogear/contact/strip_kernel.h"

namespace elastogear::contact {

/// Where n stations press on each other: of one pair of teeth after the other.
struct StationLine {
  int pair;     ///< number of the pair of teeth
  Strip along;  ///< m, along the line of contact
};

/// The loads of n stations on one body.
struct BodyLoads {
  std::vector<int> node;       ///< those that bear them
  Eigen::MatrixXd weight;      ///< n x nodes: consistent nodal forces of 1 N. Eq. (6.43)
  Eigen::Matrix3Xd direction;  ///< 3 x n, unit vectors of the forces on this body
  Eigen::MatrixXd smooth;      ///< n x n, 1/m: half-space below them, within pairs. Eq. (6.46)
  double compliance;           ///< 1/Pa, (1 - nu^2) / (pi E)
  FreeEnds ends;               ///< of its face, along the line of contact
};

/// m/N, n x n, symmetric: mean static response of a body to the loads. Eq. (6.39).
Eigen::MatrixXd body_compliance(const BodyLoads& loads, const NodalResponse& response);

/// m/N, n x n, symmetric: what the half-spaces of a body add below the mesh. q: m, half width of the
/// pressures of all stations. Eq. (6.39).
Eigen::MatrixXd local_compliance(const std::vector<StationLine>& stations, const BodyLoads& loads, double q);

}  // namespace elastogear::contact
