#pragma once
// A system of elastic bodies consists of bodies on joints, contact pairs and loads, with the motion at the
// start. It does not change during a run, but for the placements from which rotation vectors count.

#include <memory>
#include <string>
#include <vector>

#include "elastogear/body/equations.h"
#include "elastogear/body/relaxation.h"
#include "elastogear/contact/true_surface.h"
#include "elastogear/contact/types.h"
#include "elastogear/dynamics/axis.h"
#include "elastogear/dynamics/marker_forces.h"
#include "elastogear/model/relaxed_state.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

struct BodySetup {
  std::string name;
  std::shared_ptr<const model::ElasticBody> body = nullptr;
  body::Joint joint = {};
  Axis rotation = {};                                   ///< revolute and cylindrical: about the axis
  Axis translation = {};                                ///< prismatic and cylindrical: along the axis
  Eigen::Vector3d velocity0 = Eigen::Vector3d::Zero();  ///< free: m/s, of the BRF's origin, in W
  Eigen::Vector3d omega0 = Eigen::Vector3d::Zero();     ///< free and spherical: rad/s, in the BRF
  Eigen::VectorXd q_dot0 = {};                          ///< n_q, initial elastic velocity; empty: zero
  model::RelaxedState relaxed0 = {};  ///< deformation, and what is remembered of loads; empty: none
  std::shared_ptr<const contact::TrueSurface> true_surface = nullptr;  ///< null: nothing is known of it
  double surface_compliance = 0;  ///< 1/Pa, (1 - nu^2) / E of the material at the surface; 0: unknown
};

struct PairSetup {
  std::string name;      ///< "a:b", surface a and surface b of the contact module
  int body[2] = {0, 1};  ///< indices into the bodies
  contact::Settings settings;
};

/// Settings and loads common to all bodies.
struct Environment {
  body::InertiaLevel inertia = body::InertiaLevel::affine;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2, in W
  double gravity_rise = 0;  ///< s, from time 0 on, within which gravity grows from zero
  body::Moduli moduli =
      body::Moduli::relaxing;  ///< of viscoelastic materials; static equilibria have no history
};
double gravity_share(const Environment& environment, double time);  ///< 0..1, of its gravity
Eigen::Vector3d gravity(const Environment& environment, double time);

struct SystemModel {
  struct Body {
    std::string name;
    body::Equations eq;
    Eigen::Index first;              ///< first entry of [s; q] in a system vector
    std::vector<Axis> axis;          ///< one per joint coordinate; free, spherical: none
    std::vector<Eigen::Index> open;  ///< joint coordinates without prescribed motion, ascending
    bool in_contact;                 ///< named by a pair
    std::vector<int> node_group;     ///< face group of each surface node: that of its lowest face
    Eigen::VectorXd node_area;       ///< m^2, share of the surface of each of its nodes
    std::shared_ptr<const contact::TrueSurface> true_surface;  ///< may be null
    model::RelaxedState relaxed;                               ///< at the start
    double surface_compliance;                                 ///< 1/Pa, as in BodySetup
    double row_size;  ///< norm of surface.Phi's rows at a node, root mean square over the nodes

    Eigen::Index n_open() const { return static_cast<Eigen::Index>(open.size()); }
  };

  std::vector<Body> bodies;
  std::vector<PairSetup> pairs;
  Environment environment;
  MarkerForces marker_forces;
  Eigen::VectorXd U_0, V_0;  ///< initial positions and velocities
};

/// Throws Error for what cannot be simulated: no bodies, equal names, values that are not finite, motion or
/// loads that the joint does not have, bodies without mass that may move, pairs of a body with itself or
/// without surfaces.
SystemModel make_system_model(const std::vector<BodySetup>& bodies, const std::vector<PairSetup>& pairs,
                              const Environment& environment = {}, const MarkerSetups& markers = {});

/// Has a body neither elastic coordinates nor static responses in this run?
bool is_rigid(const SystemModel::Body& body);

/// Lets the motion begin with joint coordinates and deformations of these states, one for each body. Joint
/// coordinates stay where the state has others, as that of a body that was held. Bushings are unloaded where
/// they were before.
void begin_with(SystemModel& model, const std::vector<model::BodyState>& states);

using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

/// A state of the system. The vectors must outlive it.
struct State {
  double time;  ///< s
  ConstVector U, V, A;
};

/// Motion of a body, prescribed coordinates included.
body::Motion motion(const SystemModel& model, std::size_t b, const State& x);
std::vector<MovingBody> moving_bodies(const SystemModel& model, const State& x);
/// Names of bodies, joints, pairs and face groups for the result file, and which bodies are rigid; the
/// bodies' files stay empty.
model::ResultHeader result_header(const SystemModel& model);

}  // namespace elastogear::dynamics
