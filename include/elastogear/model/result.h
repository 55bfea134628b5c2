#pragma once
// Contents of a result file: the state of all bodies, contact pairs and energies at one time. SI units.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/model/run_input.h"

namespace elastogear::model {

/// Sums of all contact forces on one body at the n surface nodes that are touched.
struct ContactForces {
  std::vector<int> node = {};  ///< local numbers in the surface, ascending
  Eigen::Matrix3Xd f_B = {};   ///< N, body frame
};

/// The same over n_t times, at the n surface nodes that are touched at one of them.
struct ForceHistory {
  std::vector<int> node;  ///< n, local numbers in the surface, ascending
  Eigen::MatrixXd force;  ///< 3 n x n_t, N, body frame
};

struct BodyState {
  Eigen::Vector3d r_WB;  ///< m, BRF origin in the world
  Eigen::Matrix3d R_WB;  ///< body to world
  Eigen::VectorXd s, s_dot,
      s_ddot;  ///< n_s, joint coordinates (rad or m; body/joint.h) and their rates; empty when fixed
  Eigen::VectorXd q, q_dot, q_ddot;  ///< n_q, elastic coordinates and their rates
  /// n_s, N or N m: of load, friction and drive along the joint coordinates
  Eigen::VectorXd joint_force = {};
  ContactForces contact = {};
  Eigen::MatrixXd z = {};  ///< n_q x n_z, internal variables of viscoelastic materials (body/relaxation.h)
  Eigen::MatrixXd w = {};  ///< n_q x n_p, what the relaxing parts have lost of q: sum_i g_pi z_i
  Eigen::VectorXd q_error = {};  ///< n_q, estimated error of q by the steps in time; empty: none is known
};

/// One active contact of a pair.
struct ContactRecord {
  int slave_side = 0;      ///< which of the pair's two surfaces owns the slave node (0 or 1)
  int slave_node = 0;      ///< local number in that surface
  int face = 0;            ///< master face, local number in the other surface
  double xi = 0, eta = 0;  ///< closest point on the master face
  double g_n = 0;          ///< m, negative = penetration
  Eigen::Vector3d f;       ///< N, force on the slave node, world frame
  double pressure = 0;     ///< Pa, normal force over the slave node's share of its surface
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();  ///< m/s, of the slave node on the master, world frame
};

/// Figures of a pair, or of one of its areas of contact.
struct ContactFigures {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m, on body b, about the world origin
  int count = 0;                                     ///< active contacts
  double area = 0;                               ///< m^2, the share of the surface that the slave nodes have
  double pressure = 0;                           ///< Pa, largest
  double sliding_speed = 0;                      ///< m/s, largest
  double friction_power = 0, damping_power = 0;  ///< W, taken
};

/// One contact pair a:b. Forces are those on body b; body a receives the opposite.
struct PairState {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, world frame
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m, about the world origin
  int count = 0;                                     ///< number of active contacts
  double penetration = 0;                            ///< m, largest (>= 0)
  std::vector<Eigen::Vector3d>
      group_force[2];  ///< N, force on body b through each face group of surface a, b
  ContactFigures total;
  std::vector<ContactFigures> area[2];  ///< of each face group of surface a, b
  std::vector<ContactRecord> contacts;
};

/// A spring and damper between two markers. Along the axes, which turn with the first marker:
struct BushingState {
  Eigen::Vector3d displacement, velocity;  ///< m, m/s, of the second marker against the first
  Eigen::Vector3d angle, rate;             ///< rad, tilt about x and y, turn about z; rad/s
  Eigen::Vector3d force, torque;           ///< N, N m, on the second marker, in the world
};

/// A load at a marker, components in the world.
struct LoadState {
  Eigen::Vector3d force, torque;  ///< N, N m
  Eigen::Vector3d x;              ///< m, position of the marker
  Eigen::Matrix3d R;              ///< marker to world
};

/// Motion of a marker, components in the world.
struct SensorState {
  Eigen::Vector3d position, velocity, acceleration;  ///< m, m/s, m/s^2
  Eigen::Matrix3d rotation;                          ///< marker to world
  Eigen::Vector3d angular_velocity;                  ///< rad/s
};

struct Energies {
  double kinetic = 0, elastic = 0, contact = 0;  ///< J, stored
  double dissipated = 0, work = 0;               ///< J, since the start: by damping; by loads
  double balance = 0;                            ///< J, stored + dissipated - work - stored at the start
  double bushing = 0;                            ///< J, stored
  double relaxation = 0;                         ///< J, of dissipated: by viscoelastic materials
};

struct Snapshot {
  double time = 0;  ///< s
  std::vector<BodyState> bodies;
  std::vector<PairState> pairs;
  Energies energy;
  std::vector<BushingState> bushings = {};
  std::vector<LoadState> loads = {};
  std::vector<SensorState> sensors = {};
};

/// The data that do not change over a run.
struct ResultHeader {
  struct Body {
    std::string name, file, joint;  ///< file: the body file as given by the user
    bool relaxes = false;           ///< has viscoelastic materials; not read back
  };
  struct Pair {
    std::string name;                        ///< "worm:wheel"
    int body[2] = {0, 1};                    ///< indices into bodies
    std::vector<std::string> group_name[2];  ///< face groups of both surfaces
    std::string law = {};                    ///< of contact: penalty or unilateral; empty: not known
    int strips = 0;                          ///< over the face, where contact has stations; 0: none
    double friction = 0;                     ///< -, coefficient of sliding friction
  };
  std::vector<Body> bodies;
  std::vector<Pair> pairs;
  std::map<std::string, std::string> provenance;
  std::vector<std::string> bushings = {}, sensors = {};  ///< names
  std::optional<RunInput> input = {};                    ///< nothing: not known
};

}  // namespace elastogear::model
