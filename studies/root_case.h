#pragma once
// Static loads on flanks and the stresses at roots, which studies share.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace root_stress {

/// A body with a load on one flank.
struct Case {
  elastogear::mesh::Mesh mesh;
  std::vector<std::string> held;
  std::string flank;      ///< face set that is loaded
  std::vector<int> root;  ///< nodes at which the largest stress is looked for
  std::function<double(const Eigen::Vector3d& X)> intensity;  ///< of the load, over the flank
  bool plane = false;                                         ///< nothing depends on z
  double load = 1000;                                         ///< N
};

/// Six tetrahedra for each hexahedron of 8 nodes, around its diagonal 0-6, which structured meshes cut alike
/// from both sides.
elastogear::mesh::Mesh tetrahedra(const elastogear::mesh::Mesh& hexahedra);

/// Leaves the first of n_teeth equal sectors of cells and `beside` ones on either side of it, with the loaded
/// faces there. They are held where they are cut from the whole, node set "cut".
void cut_teeth(Case& c, int n_teeth, int beside);

/// 1 in the middle, 0 from half_width on, with smooth slopes.
double bump(double x, double middle, double half_width);

/// Nodes of a face set, ascending.
std::vector<int> nodes_of(const elastogear::mesh::Mesh& mesh, const std::string& face_set);

/// 3 x n, N, at these nodes, ascending: pressure in proportion to the intensity on the loaded flank, by the
/// shape functions of the cells' sides, with the resultant of the case.
Eigen::Matrix3Xd nodal_forces(const Case& c, const std::vector<int>& node);

struct Largest {
  double von_mises = 0, principal = 0;  ///< Pa
};
Largest largest(const Eigen::MatrixXd& sigma);

/// Stresses at nodes and the estimated error of the von Mises stress that is recovered there.
struct Solution {
  std::vector<int> node;                ///< n, of the mesh
  Eigen::Matrix3Xd X;                   ///< m
  Eigen::MatrixXd averaged, recovered;  ///< 6 x n, Pa
  Eigen::VectorXd error;                ///< n, Pa
};
/// At the root's nodes that are not on a flank, and on the loaded flank, where means are taken.
struct Solutions {
  Solution root, flank;
};
Solutions solve(const Case& c);

void print(const std::string& kind, const elastogear::mesh::Mesh& mesh, const Solution& s);

/// Errors of both stresses beside given ones at the same points, 6 x n, as shares of `scale` (Pa): the
/// largest and the root mean square.
void print_errors(const Solution& s, const Eigen::MatrixXd& exact, double scale);

/// How well estimates tell the errors of von Mises stresses beside given ones at the same points, 6 x n,
/// where they are a tenth of `scale` (Pa) or more: number of nodes, share of them at which the error is below
/// twice the estimate, median of estimate over error. Of means the estimate is the difference of both
/// recoveries. All of estimate over error are added to ratios.csv: the kind of mesh, what, the ratio.
void print_estimates(const std::string& kind, const std::string& what, const Solution& s,
                     const Eigen::MatrixXd& exact, double scale);

}  // namespace root_stress
