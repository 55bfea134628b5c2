#pragma once
// Reference results from CalculiX (program ccx), when it is installed.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::test {

bool calculix_is_installed();

struct CalculixModel {
  const mesh::Mesh& mesh;
  model::Material material;                  ///< of all cells
  std::vector<std::string> restrained_sets;  ///< "xmin", "zmin:z": see mesh/hold.h
  std::string element = "C3D8I";
};

/// The lowest n frequencies in Hz, ascending: writes a deck into a new temporary folder, runs ccx, reads its
/// .dat.
std::vector<double> calculix_frequencies(const CalculixModel& model, int n);

/// Nodal stress under forces at nodes (N), 6 x n_nodes, Pa, order xx yy zz xy yz xz: extrapolated from the
/// integration points and averaged over the cells, from ccx's .frd file (six digits).
Eigen::MatrixXd calculix_stress(const CalculixModel& model, const std::map<int, Eigen::Vector3d>& forces);

/// A free motion of the whole body, geometrically nonlinear, by Newmark's average acceleration.
struct CalculixMotion {
  Eigen::Matrix3Xd velocity;  ///< m/s, of the nodes at the start, which is without deformation
  double dt = 0;              ///< s
  int n_steps = 0;
  int print_every = 1;
};
/// Displacements (m, 3 x n_nodes each, seven digits) after every print_every-th step.
std::vector<Eigen::Matrix3Xd> calculix_motion(const CalculixModel& model, const CalculixMotion& motion);

/// The matrices that ccx stores by *FREQUENCY, SOLVER=MATRIXSTORAGE, in a folder that goes with this.
struct CalculixMatrices {
  std::string folder;

  explicit CalculixMatrices(const CalculixModel& model);
  ~CalculixMatrices();
  CalculixMatrices(const CalculixMatrices&) = delete;
  CalculixMatrices& operator=(const CalculixMatrices&) = delete;
  std::string stiffness() const { return folder + "/deck.sti"; }
  std::string mass() const { return folder + "/deck.mas"; }
  std::string dofs() const { return folder + "/deck.dof"; }
};

}  // namespace elastogear::test
