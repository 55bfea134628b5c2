#pragma once
// Does a field satisfy K u = lambda M u on the whole mesh? Element by element, without assembled matrices.

#include <Eigen/Core>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// A mesh with what its elements need.
struct MeshedBody {
  const mesh::Mesh& mesh;
  const std::vector<model::MaterialRegion>& regions;
  const std::vector<int>& region;    ///< of each cell, index into regions
  const std::vector<bool>& is_free;  ///< of each node
  model::Formulation formulation;
};

/// For each column of u (3 n_nodes x n, m) with its lambda (rad^2/s^2) the norm of the forces K u - lambda M
/// u left over at free nodes, over the norm of the sums of moduli of all the elements' stiffness and inertia
/// forces there: of the size of roundoff for an exact mode, however slow.
Eigen::VectorXd residual(const MeshedBody& body, const Eigen::MatrixXd& u, const Eigen::VectorXd& lambda);

}  // namespace elastogear::fem
