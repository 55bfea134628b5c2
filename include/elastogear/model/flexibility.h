#pragma once
// Static responses of the whole body to forces on its contact surface, F = B' K^-1 B and G = S K^-1 B, from
// which dynamics and recovery take what a truncated modal basis leaves out (docs/theory, section 6.9).

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace elastogear::model {

/// Which nodes of a list are turned copies of each other. Of a body that does not repeat, every node is an
/// orbit of its own.
struct Images {
  std::vector<int> orbit;  ///< of each node, 0..n_orbits-1
  std::vector<int>
      sector_index;      ///< of each node, 0..n_sectors-1: by how many sectors its orbit's first was turned
  Eigen::MatrixXi node;  ///< n_sectors x n_orbits: the way back
};

/// Images from the orbit and sector of each node. Throws Error naming `source` unless every orbit has one
/// node in each of the n_sectors sectors.
Images make_images(std::vector<int> orbit, std::vector<int> sector_index, int n_sectors,
                   const std::string& source);
/// Images of n nodes that are no copies of each other.
Images no_images(int n);

/// F of the body with a share of its moduli relaxed, one of the states between which static responses are
/// interpolated (docs/theory, Eq. (2.21)).
struct RelaxedResponse {
  Eigen::VectorXd share;  ///< n_p, gamma_p: which share of each relaxing part is gone
  Eigen::VectorXd self;   ///< n_orbits, m/N, as that of Flexibility
  Eigen::MatrixXf F = {};
  std::function<Eigen::MatrixXf(int orbit)> read_F = {};
};

/// Body frame. Forces act on the first node of each orbit, along x, y, z.
struct Flexibility {
  int n_sectors = 1;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector along the axis of the sectors
  std::vector<int> node;                            ///< n_c surface nodes (local numbers), ascending
  Images surface;                                   ///< of them
  Images stress;                ///< of the n_r nodes of G: evaluation nodes and their images
  std::vector<int> stress_row;  ///< n_e: which of them each evaluation node is
  Eigen::VectorXd self;         ///< n_orbits, m/N, |F(b, b)|
  Eigen::MatrixXf F;            ///< 3 n_c x 3 n_orbits, m/N, displacements of the n_c nodes; or empty, then
  Eigen::MatrixXf G;            ///< 6 n_r x 3 n_orbits, Pa/N, order xx yy zz xy yz xz; or empty. Below it as
                                ///< many rows of each of the relaxed states
  std::function<Eigen::MatrixXf(int orbit)> read_F = {};  ///< ... reads the three columns of an orbit
  /// Of a viscoelastic body in one ratio everywhere: its relaxing part, by whose series what the modes leave
  /// out creeps; otherwise -1.
  int creep = -1;
  std::vector<RelaxedResponse> relaxed = {};  ///< n_s states of a viscoelastic body in different ratios,
  Eigen::MatrixXd law = {};                   ///< n_s x n_p, and mu_jp of the laws between them. Eq. (2.22)

  bool empty() const { return node.empty(); }
};

/// Position of a surface node in flexibility.node; -1: forces on it are not provided for.
int find_loaded(const Flexibility& flexibility, int surface_node);

/// The columns of F of one orbit, 3 n_c x 3.
Eigen::MatrixXf displacement_columns(const Flexibility& flexibility, int orbit);
/// Those of a relaxed state.
Eigen::MatrixXf displacement_columns(const RelaxedResponse& relaxed, int orbit);
using Columns3 = Eigen::Ref<const Eigen::Matrix<float, Eigen::Dynamic, 3>>;

/// |F(b, b)| of an orbit's first node b, m/N, given the columns of F of the orbit.
double self_response(const Flexibility& flexibility, int orbit, const Columns3& F);
/// Sets `self` from F.
void set_self(Flexibility& flexibility);

/// Displacement of node a by unit forces on node b (positions in flexibility.node), m/N, given the columns of
/// F of b's orbit. F(a, b) = F(b, a)' to the accuracy of what is stored.
Eigen::Matrix3d displacement_response(const Flexibility& flexibility, int a, int b, const Columns3& F);

/// Stresses at evaluation nodes by unit forces on node b (position in flexibility.node), 6 n x 3, Pa/N, given
/// the columns of G of b's orbit.
Eigen::Matrix<double, Eigen::Dynamic, 3> stress_responses(const Flexibility& flexibility,
                                                          const std::vector<int>& evaluated, int b,
                                                          const Columns3& G);

}  // namespace elastogear::model
