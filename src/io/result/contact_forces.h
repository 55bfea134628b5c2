#pragma once
// Contact forces at the nodes of bodies in result files. Private to module io.

#include <string>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::io {

/// Group of a body, beside its coordinates. Results of an older version than the first lack it.
constexpr const char* kForces = "/contact_forces";
constexpr int kFirstWithForces = 3;

/// Force on one node at one time.
struct NodalForce {
  Eigen::Index step;
  int node;             ///< local number in the body's surface
  Eigen::Vector3d f_B;  ///< N, body frame
};

/// Forces on a body of a result of version 1 or 2, which holds contact points only: f on the slave node, and
/// -N_i f on the nodes of the face, docs/theory, Eqs. (6.1) and (6.4). The couples of smoothed surfaces
/// and the forces at their free boundaries are not in such a file. Error when a point names a face that the
/// surface does not have.
std::vector<NodalForce> forces_of_points(const std::string& path, const std::string& body,
                                         const model::Surface& surface);

}  // namespace elastogear::io
