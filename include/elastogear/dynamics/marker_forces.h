#pragma once
// Loads, bushings and sensors at markers, and their part of the effective matrix (docs/theory,
// sections 3.5 and 8.1).

#include <array>
#include <string>
#include <vector>

#include "elastogear/body/marker.h"
#include "elastogear/dynamics/axis.h"
#include "elastogear/dynamics/bushing.h"
#include "elastogear/dynamics/effective_matrix.h"

namespace elastogear::dynamics {

/// A marker by name. Without a body: the ground.
struct MarkerName {
  std::string body, marker;
};

/// Force and torque (N, N m) that a program computes of the time (s) and the marker's motion without its
/// acceleration. It is asked any number of times in a step, in any order, and must depend on nothing else.
using WrenchLaw = std::function<body::Wrench(double t, const body::MarkerMotion& marker)>;

/// force, torque and pressure times the signal; in the world, or turning with the marker. A pressure turns
/// with the body's frame.
struct LoadSetup {
  std::string name;
  MarkerName marker;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m
  bool follows = false;                              ///< components in the marker's frame
  Signal signal = constant_signal(1);
  WrenchLaw law = {};   ///< beside these, in the same frame
  double pressure = 0;  ///< Pa, on the face set of the marker, against its normals
};

/// Unloaded in the initial state; a marker on the ground is then at the place of the other one.
struct BushingSetup {
  std::string name;
  MarkerName marker[2];
  BushingLaw law = {};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< as columns, at the start
  bool axes_of_first = false;                          ///< in the first marker's frame; else in the world
};

struct SensorSetup {
  std::string name;
  MarkerName marker;
};

struct MarkerSetups {
  std::vector<LoadSetup> loads = {};
  std::vector<BushingSetup> bushings = {};
  std::vector<SensorSetup> sensors = {};
};

/// A body and its motion.
struct MovingBody {
  const body::Equations* eq;
  body::Motion motion;
};

/// Apart, because they may cancel: what is left is small against each of them.
struct MarkerForce {
  body::Force loads, bushings;
};

class MarkerForces {
 public:
  struct Body {
    std::string name;
    const model::ElasticBody* body;
  };

  MarkerForces() = default;
  /// Throws Error for names that do not exist or exist twice, values that are not finite, torques and
  /// rotational springs on markers without rotation, and bushings from the ground to the ground.
  MarkerForces(const MarkerSetups& setups, const std::vector<Body>& bodies);

  /// Markers of body b on which forces act: their columns Phi', n_q x 6 each, side by side.
  Eigen::MatrixXd columns(std::size_t b) const;
  Eigen::Index row_count(std::size_t b) const { return 6 * marker_count(static_cast<int>(b)); }

  /// Makes the present positions those at which bushings are unloaded.
  void set_unloaded(const std::vector<MovingBody>& bodies);
  /// Turns the second marker's unloaded orientation by an angle (rad) about z of the bushing's axes.
  void turn_unloaded(std::size_t bushing, double angle);
  /// Generalised forces of all loads and bushings, one per body.
  std::vector<MarkerForce> forces(double time, const std::vector<MovingBody>& bodies) const;
  /// Adds their tangent to A, which holds that of contact, if any.
  void add_tangent(double time, const std::vector<MovingBody>& bodies, const body::Shifts& shift,
                   EffectiveMatrix& A) const;

  bool empty() const { return place_.empty(); }
  const MarkerSetups& setups() const { return setups_; }
  /// Throws Error when a load's table ends before `end_time` or begins after 0.
  void require_tables_cover(double end_time) const;
  body::MarkerMotion load_motion(std::size_t i, const std::vector<MovingBody>& bodies) const;
  body::MarkerMotion sensor_motion(std::size_t i, const std::vector<MovingBody>& bodies) const;
  body::Wrench load_wrench(std::size_t i, double time, const body::MarkerMotion& marker) const;
  BushingForce bushing_force(std::size_t i, const std::vector<MovingBody>& bodies) const;

 private:
  /// Columns of a marker in W k V': changes of x, orientation, v and w; elastic markers have three more, of
  /// their elastic rotation.
  static constexpr Eigen::Index kMotion = 12;

  /// A marker, or a point on the ground (body = -1).
  struct Place {
    int body = -1;
    const model::Marker* marker = nullptr;             ///< null: the frame
    Eigen::Index row = 0, column = 0;                  ///< first ones, in columns(body) and among all places'
    Eigen::Vector3d ground = Eigen::Vector3d::Zero();  ///< m
  };
  /// What a pressure does at one place: on the volume that its faces sweep, and on the body's frame, with
  /// which both turn.
  struct Part {
    std::size_t load = 0;
    int place = 0;
    body::Wrench wrench;
  };
  struct Tangent {
    body::Shifts shift;
    body::Wrench wrench;
    Eigen::Index first_column;
    Eigen::SparseMatrix<double>* k;
  };

  Place find(const MarkerName& name, const std::string& who) const;
  int use(const MarkerName& name, const std::string& who);
  const Place& place(int i) const { return place_[static_cast<std::size_t>(i)]; }
  Eigen::Index marker_count(int b) const;
  void add_load(const LoadSetup& load);
  void add_pressure(const LoadSetup& load, const std::string& who);
  void add_bushing(const BushingSetup& bushing);
  body::Wrench part_wrench(const Part& part, double time, const body::MarkerMotion& marker) const;
  static void require_turning(const Place& place, const std::string& who);
  static body::MarkerMotion motion(const Place& place, const std::vector<MovingBody>& bodies);
  std::vector<body::MarkerMotion> motions(const std::vector<MovingBody>& bodies) const;
  std::vector<body::Wrench> load_wrenches(double time, const std::vector<body::MarkerMotion>& motion) const;
  std::vector<body::Wrench> bushing_wrenches(const std::vector<body::MarkerMotion>& motion) const;
  void add_stiffness(std::size_t load, double time, const body::MarkerMotion& marker,
                     Eigen::Ref<Eigen::Matrix<double, 6, 12>> K) const;
  Eigen::MatrixXd stiffness(double time, const std::vector<body::MarkerMotion>& motion) const;
  void add_place(const Place& place, const MovingBody& body, const Tangent& tangent, BodyTerms& terms) const;

  MarkerSetups setups_;
  std::vector<Body> bodies_;
  std::vector<Place> place_;                    ///< where forces act
  std::vector<int> load_at_;                    ///< indices into place_
  std::vector<std::array<int, 2>> bushing_at_;  ///< likewise
  std::vector<Part> part_;
  std::vector<Place> sensor_at_;
  std::vector<Bushing> bushing_;
  Eigen::Index n_columns_ = 0;  ///< of all places
};

}  // namespace elastogear::dynamics
