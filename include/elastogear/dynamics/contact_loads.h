#pragma once
// From contact points (local displacements in the world frame) to generalised coordinates (docs/theory,
// section 6.4): node positions x = r(s) + R(s) (X + Phi q), so that a twist i moves them by
// R (v_i + w_i x x_B), and dx/dq = R Phi, Eq. (6.9). Forces act on the joint's virtual twists H, positions
// change by the twists P = [r; theta] of body::FrameDerivative.

#include <Eigen/SparseCore>
#include <vector>

#include "elastogear/body/equations.h"
#include "elastogear/contact/types.h"
#include "elastogear/dynamics/effective_matrix.h"

namespace elastogear::dynamics {

/// Sums over the contacts of all pairs at the surface nodes of one body that they touch.
struct NodalForces {
  std::vector<int> node;  ///< surface nodes, ascending
  Eigen::Matrix3Xd x_B;   ///< m, deformed position in the BRF
  Eigen::Matrix3Xd f_B;   ///< N, contact force in the BRF
  /// n_s, N or N m: on joint coordinates, in place of what the nodal forces are on them. Places of contact
  /// move with these coordinates (docs/theory, section 6.18); empty: it is that of the nodal forces.
  Eigen::VectorXd joint = {};
  Eigen::VectorXd joint_size = {};  ///< n_s: sums of the sizes of its parts by pairs of teeth
};

/// Contact points of one pair and the two bodies they belong to.
struct PairContacts {
  int body[2] = {0, 1};
  std::vector<contact::ContactPoint> points;
};

/// Loads of the n stations of exact flanks that carry a force, of all pairs (docs/theory, section 6.18).
struct StationLoads {
  /// 3 nodes x n of each body, BRF: forces of 1 N of each station on the nodes of its NodalForces.
  std::vector<Eigen::SparseMatrix<double>> body = {};
  /// With friction: the same of normal and tangential forces together. Empty: there is none.
  std::vector<Eigen::SparseMatrix<double>> with_friction = {};
  /// 3 nodes x m of each body, BRF: unit tangential forces on the nodes, along which friction resists
  /// sliding.
  std::vector<Eigen::SparseMatrix<double>> sliding = {};
  Eigen::VectorXd resistance = {};         ///< m, N s/m: of friction to the rates of these
  std::vector<NodalForces> friction = {};  ///< of each body, or empty; a part of its nodal forces
  Eigen::VectorXd f = {};                  ///< n, N
  Eigen::MatrixXd K = {};                  ///< n x n, N/m: -df/dgap. Eq. (6.48)
  double potential = 0;                    ///< J, of all stations; forces are its derivatives. Eq. (6.38)
  double local_energy = 0;                 ///< J, stored in the half-spaces below the meshes
};

/// Contact of all bodies at one time, by positions and velocities alone.
struct ContactState {
  std::vector<contact::SurfaceState> surface;  ///< per body; x_B is right at the nodes that contact touches
  std::vector<PairContacts> pair;
  std::vector<NodalForces> force;  ///< per body
  StationLoads stations = {};
  bool balanced = true;  ///< did Newton's method for contact forces and static responses converge?
};

/// Body side and surface node of local node i of a contact point: slave nodes first, then four of the master.
struct LocalNode {
  int side, node;
};
LocalNode local_node(const contact::ContactPoint& point, int i);
/// N, force on local node i, world frame; all of them sum to zero.
Eigen::Vector3d local_force(const contact::ContactPoint& point, int i);

/// One entry per body. states[b].x_B may be empty for bodies that no pair names.
std::vector<NodalForces> nodal_forces(const std::vector<PairContacts>& pairs,
                                      const std::vector<contact::SurfaceState>& states);
/// The same of the parts of contact forces that lie along the master.
std::vector<NodalForces> friction_forces(const std::vector<PairContacts>& pairs,
                                         const std::vector<contact::SurfaceState>& states);

/// Generalised contact force: s: H' [sum f; sum x x f], q: Phi' f. Eqs. (3.7) and (6.10).
body::Force contact_force(const body::Equations& eq, const NodalForces& forces);

/// A body's virtual twists H, the twists P that its coordinates make, and how these change velocities.
struct JointTwists {
  body::MotionSubspace H, P;
  body::MotionSubspace P_dot = {};  ///< change of [R_WB' r_WB'; w] with s, velocity turned by P left out
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< rad/s, w_WB_B
  double shift_v = 0;                           ///< 1/s
};

/// Adds -d(contact force)/dz at constant local forces: the part that comes from the turning of the BRF.
/// s_i s_j: -f.(theta_j x (v_i + w_i x x)); s_i q: -(f x w_i).Phi. The rows of U come before the nodes'.
/// Eq. (6.11).
void add_geometric_stiffness(const JointTwists& twists, const NodalForces& forces, BodyTerms& terms);

/// Twists P_dot of a body, see JointTwists.
body::MotionSubspace velocity_twists(const body::Joint& joint, const body::MotionSubspace& H,
                                     const body::JointMotion& m, double shift_v);

/// W_s, V_s, L, L_V of every body (whose `node` are set) and k, from the tangents of all contact points and
/// stations.
void set_contact_columns(const std::vector<JointTwists>& twists, const ContactState& contact,
                         EffectiveMatrix& A);

}  // namespace elastogear::dynamics
