#pragma once
// Motion of two gears in mesh: transmission error, stiffness, sliding (docs/theory, section 10.2).

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/gear/toothing.h"

namespace elastogear::evaluation {

/// A gear over a run of n_t times. Its body frame stands at its bore, seats or outside, wherever it is held.
struct Gear {
  std::string name;
  gear::Toothing toothing;
  double width = 0;                                  ///< m, of its teeth, symmetric about z = 0
  double ratio = 1;                                  ///< -, its speed over that of the drive's first gear
  double angle = 0;                                  ///< rad, about its axis where the roll angle is 0
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();   ///< body to world at the angle 0
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, of the body frame in the world as it is mounted
  std::vector<Eigen::Vector3d> position;             ///< n_t, m, of the body frame in the world
  std::vector<Eigen::Matrix3d> rotation;             ///< n_t, body to world
  Eigen::VectorXd layers;  ///< m, z of the layers of corners of cells on its flanks, ascending

  Eigen::Vector3d axis(std::size_t step) const { return rotation[step].col(2); }
};

/// rad, one pitch of a gear.
double pitch(const Gear& gear);

/// Angles of a gear about its axis at n_t times, rad, in whole turns as the nominal angles are.
Eigen::VectorXd angles(const Gear& gear, const Eigen::VectorXd& nominal);
/// Angles of a gear of perfect rigid drives at these roll angles (pitches of the drive's first gear, which
/// has `first_teeth`), rad.
Eigen::VectorXd nominal_angles(const Gear& gear, int first_teeth, const Eigen::VectorXd& roll);
/// Angles of a gear in a run in time, whose steps turn it by less than half a turn, rad; the first one is
/// taken nearest to the angle at the roll angle `roll`.
Eigen::VectorXd continuous_angles(const Gear& gear, int first_teeth, double roll);

/// How two gears transmit.
struct Transmission {
  double ratio = 1;   ///< -, z_1/z_2 > 0
  double s = -1;      ///< -1: they turn against each other; +1: in one sense
  double sense = 1;   ///< +1: the first one drives counter-clockwise; -1: clockwise
  double radius = 0;  ///< m, at which errors are measured
  bool parallel = true;
};
/// The radius is that of the second gear's base circle, of crossed axes its pitch radius. sense: of the
/// drive's first gear.
Transmission transmission(const Gear& first, const Gear& second, double sense);

/// m, one for each time: by how much the second gear leads, Eq. (10.3). Angles in rad, less those where the
/// roll angle is 0.
Eigen::VectorXd transmission_error(const Transmission& t, const Eigen::VectorXd& phi_1,
                                   const Eigen::VectorXd& phi_2);

/// N/m, one for each time: a change of force over that of the transmission error, Eq. (10.4); NaN where that
/// does not change.
Eigen::VectorXd stiffness(const Eigen::VectorXd& force, const Eigen::VectorXd& error,
                          const Eigen::VectorXd& other_error);

/// m/s, velocity of the first gear against the second one at point x (world, m) in the tangent plane with the
/// unit normal n, where the drive's first gear turns at omega rad/s: Eq. (10.5).
Eigen::Vector3d sliding_velocity(const Gear& first, const Gear& second, std::size_t step,
                                 const Eigen::Vector3d& x, const Eigen::Vector3d& n, double omega);

/// Place of a tooth (0-based) on its way through the mesh, pitches: 0 where its centre at z = 0 stands on the
/// line to the mate, > 0 later; between -z/2 and z/2. Eq. (10.6).
double place_of_tooth(const Gear& gear, const Gear& mate, int tooth, std::size_t step);

/// Places of a tooth of the second gear, pitches, between which rigid external involute gears on parallel
/// axes touch it on this side (+1 left, -1 right) anywhere over the face width, Eq. (10.6a); nothing for
/// others.
std::optional<std::array<double, 2>> path_of_contact(const Gear& first, const Gear& second, int side);

}  // namespace elastogear::evaluation
