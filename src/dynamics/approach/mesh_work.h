#pragma once
// The work of the contact forces of a patch on the mesh's own local deformation, with that of smooth
// pressures on an elastic half-space in its place: docs/theory, Eq. (6.36).

#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dynamics/approach/half_space.h"
#include "dynamics/contact/residual_flexibility.h"

namespace elastogear::dynamics {

/// A patch by the number of its pair of surfaces and of its flank.
using PatchNumber = std::pair<std::size_t, int>;

class MeshWork {
 public:
  /// The surface must outlive this. compliance: 1/Pa, (1 - nu^2) / E.
  MeshWork(const model::Surface& surface, double compliance)
      : compliance_(compliance), half_space_(surface) {}

  /// J: f' F f - s' F s + p' H p of the forces f of a patch (x_B is not read), spread to the pressures p with
  /// the nodal forces s. Eq. (6.36). along: BRF, unit vector of a line, across which they are spread, Eq.
  /// (6.36a); 0: to all directions.
  double of(PatchNumber patch, const NodalForces& f, const Eigen::Vector3d& along,
            ResidualFlexibility& flexibility);

 private:
  // A symmetric matrix of functions of two nodes. A patch has the same nodes in many steps.
  struct Among {
    std::vector<int> node = {};
    Eigen::MatrixXd matrix = {};
  };
  const contact::Spread& spread(int node, const Eigen::Vector3d& along);

  double compliance_;
  HalfSpace half_space_;
  std::unordered_map<int, contact::Spread> spread_;  // of nodes to all directions
  contact::Spread across_line_;                      // the last one asked for
  std::map<PatchNumber, Among> F_, H_;               // m/N, of nodes; 1/m, of corners
};

}  // namespace elastogear::dynamics
