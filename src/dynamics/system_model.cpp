#include "elastogear/dynamics/system_model.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <variant>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/contact/topology.h"
#include "elastogear/dynamics/station_choice.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::dynamics {
namespace {

constexpr double kRotationTolerance = 1e-6;  // on R'R = I and det R = 1, of matrices typed by hand

void append(Eigen::VectorXd& x, const Eigen::VectorXd& tail) {
  x.conservativeResize(x.size() + tail.size());
  x.tail(tail.size()) = tail;
}

bool is_default(const Axis& axis) {
  return axis.s_0 == 0 && axis.s_dot_0 == 0 && axis.load.value.empty() && axis.damping == 0 &&
         axis.friction == 0 && !axis.drive;
}

// Throws Error for motions and loads that the joint does not have, or that are not finite.
void validate_motion(const BodySetup& setup, const std::string& who) {
  const body::JointType type = setup.joint.type;
  const std::string& joint = body::joint_names()[static_cast<std::size_t>(type)];
  require(body::has_rotation_axis(type) || is_default(setup.rotation), who, "a ", joint,
          " joint has no axis to turn about: no initial angle or speed, torque, friction or prescribed "
          "rotation");
  require(
      body::has_translation_axis(type) || is_default(setup.translation), who, "a ", joint,
      " joint has no axis to slide along: no initial displacement or speed, force, friction or prescribed "
      "translation");
  require(type == body::JointType::free || setup.velocity0.isZero(0), who,
          "only a free body takes an initial velocity as a vector");
  require(body::has_rotation_vector(type) || setup.omega0.isZero(0), who,
          "only a free or spherical joint takes an initial angular velocity as a vector");
  require(setup.velocity0.allFinite() && setup.omega0.allFinite(), who, "initial velocity (",
          setup.velocity0.transpose(), ") and angular velocity (", setup.omega0.transpose(),
          ") must be finite");
  validate(setup.rotation, who + "rotation: ");
  validate(setup.translation, who + "translation: ");
}

void validate_joint(const BodySetup& setup) {
  const body::Joint& joint = setup.joint;
  const std::string who = "body '" + setup.name + "': ";
  require(joint.r_WB0.allFinite(), who, "position (", joint.r_WB0.transpose(), ") must be finite");
  const Eigen::Matrix3d& R = joint.R_WB0;
  require(R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationTolerance &&
              R.determinant() > 0,
          who, "rotation is not a rotation matrix");
  validate_motion(setup, who);
}

// Inertia of the undeformed body against what the joint lets it do.
void require_inertia(const SystemModel::Body& body) {
  const model::Inertia& inertia = body.eq.body->inertia;
  Eigen::Matrix<double, 6, 6> M;
  const Eigen::Matrix3d S = skew(inertia.m * inertia.c);
  M << inertia.m * Eigen::Matrix3d::Identity(), -S, S, inertia.J;
  const Eigen::MatrixXd H = body.eq.H(Eigen::all, body.open);
  const Eigen::LLT<Eigen::MatrixXd> factor(H.transpose() * M * H);
  require(factor.info() == Eigen::Success, "body '", body.name, "' has a mass of ", inertia.m,
          " kg and no (or a negative) inertia against a motion that its joint allows");
}

void validate_body(const BodySetup& setup, const std::vector<SystemModel::Body>& others) {
  require(!setup.name.empty(), "a body has no name");
  for (const SystemModel::Body& other : others)
    require(other.name != setup.name, "two bodies are named '", setup.name, "'");
  require(setup.body != nullptr, "body '", setup.name, "' has no elastic body");
  require(setup.q_dot0.size() == 0 || setup.q_dot0.size() == setup.body->n_q(), "body '", setup.name,
          "': q_dot0 has ", setup.q_dot0.size(), " entries, must have n_q = ", setup.body->n_q());
  require(setup.q_dot0.allFinite(), "body '", setup.name, "': q_dot0 is not finite");
  validate_joint(setup);
}

std::vector<int> node_groups(const model::Surface& surface) {
  std::vector<int> group(surface.node.size(), 0);
  for (Eigen::Index f = surface.face.cols() - 1; f >= 0; --f)
    for (int node : surface.face.col(f)) group[node] = surface.group[f];
  return group;
}

std::vector<Axis> axes(const BodySetup& setup) {
  std::vector<Axis> axes;
  if (body::has_rotation_axis(setup.joint.type)) axes.push_back(setup.rotation);
  if (body::has_translation_axis(setup.joint.type)) axes.push_back(setup.translation);
  return axes;
}

std::vector<Eigen::Index> open_coordinates(const std::vector<Axis>& axes, Eigen::Index n_s) {
  std::vector<Eigen::Index> open;
  for (Eigen::Index i = 0; i < n_s; ++i)
    if (axes.empty() || !axes[static_cast<std::size_t>(i)].drive) open.push_back(i);
  return open;
}

// Initial joint coordinates and their rates.
std::pair<Eigen::VectorXd, Eigen::VectorXd> initial_motion(const BodySetup& setup, Eigen::Index n_s) {
  Eigen::VectorXd s = Eigen::VectorXd::Zero(n_s), s_dot = s;
  if (setup.joint.type == body::JointType::free) {
    s.head<3>() = setup.joint.r_WB0;
    s_dot.head<3>() = setup.velocity0;
  }
  if (body::has_rotation_vector(setup.joint.type)) s_dot.tail<3>() = setup.omega0;
  for (Eigen::Index i = 0; const Axis& axis : axes(setup)) {
    s[i] = axis.s_0;
    s_dot[i++] = axis.s_dot_0;
  }
  return {s, s_dot};
}

void validate_relaxed(const BodySetup& setup) {
  const model::RelaxedState& state = setup.relaxed0;
  if (state.empty()) return;
  const body::RelaxationLaw law = body::relaxation_law(*setup.body);
  require(state.q.size() == setup.body->n_q() && state.z.rows() == state.q.size() &&
              state.z.cols() == state.tau.size() && state.tau == law.tau,
          "body '", setup.name, "': begins with a deformation of ", state.q.size(), " coordinates and ",
          state.tau.size(), " relaxation times, which are not those of the body (", setup.body->n_q(),
          " and ", law.n_z(), "): reduced otherwise, or at another temperature");
}

// Norm of the three rows at a node of the surface, root mean square over some hundred nodes.
double row_size(const model::Surface& surface) {
  constexpr Eigen::Index kNodes = 256;
  const Eigen::Index n = surface.X.cols(), step = 1 + n / kNodes;
  double sum = 0;
  Eigen::Index count = 0;
  const model::RowBounds* known = model::known_bounds(surface.Phi);
  const auto* sparse = std::get_if<model::SparseRows>(&surface.Phi);
  const Eigen::Index n_q = model::column_count(surface.Phi);
  for (Eigen::Index node = 0; node < n && n_q > 0; node += step, ++count) {
    if (known)
      sum += known->square[node];
    else if (sparse)
      sum += sparse->middleRows(3 * node, 3).squaredNorm();
    else
      sum += Eigen::Map<const Eigen::VectorXd>(model::node_rows(surface.Phi, static_cast<int>(node)), 3 * n_q)
                 .squaredNorm();
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

void add_body(const BodySetup& setup, SystemModel& model) {
  validate_relaxed(setup);
  validate_body(setup, model.bodies);
  const std::vector<Axis> axis = axes(setup);
  const auto [s, s_dot] = initial_motion(setup, body::coordinate_count(setup.joint.type));
  const std::vector<Eigen::Index> open = open_coordinates(axis, s.size());
  const model::Surface& surface = setup.body->surface;
  model.bodies.push_back(
      {setup.name, body::make_equations(setup.body, setup.joint, model.environment.inertia), model.U_0.size(),
       axis, open, false, node_groups(surface), contact::node_areas(surface.X, surface.face),
       setup.true_surface, setup.relaxed0, setup.surface_compliance, row_size(surface)});
  require_inertia(model.bodies.back());
  const Eigen::Index n_q = setup.body->n_q();
  append(model.U_0, s(open));
  append(model.U_0, setup.relaxed0.empty() ? Eigen::VectorXd(Eigen::VectorXd::Zero(n_q)) : setup.relaxed0.q);
  append(model.V_0, s_dot(open));
  append(model.V_0, setup.q_dot0.size() ? setup.q_dot0 : Eigen::VectorXd::Zero(n_q));
}

void add_pair(const PairSetup& setup, SystemModel& model) {
  const auto n = static_cast<int>(model.bodies.size());
  for (int b : setup.body) {
    require(b >= 0 && b < n, "contact pair '", setup.name, "' names body ", b, ", allowed are 0..", n - 1);
    require(model.bodies[b].eq.body->surface.face.cols() > 0, "contact pair '", setup.name, "': body '",
            model.bodies[b].name, "' has no surface faces");
    model.bodies[b].in_contact = true;
  }
  require(setup.body[0] != setup.body[1], "contact pair '", setup.name, "' names one body twice");
  // A dashpot's force jumps when a node touches. With residual flexibility the node would move back and open
  // the gap again, so that there is no solution.
  for (int b : setup.body)
    require(setup.settings.damping == 0 || model.bodies[b].eq.body->flexibility.empty(), "contact pair '",
            setup.name, "': damping = ", setup.settings.damping,
            " jumps at touch, which the residual flexibility of body '", model.bodies[b].name,
            "' cannot follow: use hysteresis instead, or leave the residual flexibility out");
  const bool flexible = std::any_of(std::begin(setup.body), std::end(setup.body),
                                    [&](int b) { return !model.bodies[b].eq.body->flexibility.empty(); });
  model.pairs.push_back(setup);
  contact::Settings& settings = model.pairs.back().settings;
  settings.law = contact::chosen_law(settings, flexible);
  settings.points = contact::chosen_points(
      settings, model.bodies[setup.body[settings.slave == 0 ? 0 : 1]].eq.body->surface);
}

// Pairs of a system touch at stations together, as their forces depend on each other, or not at all: then
// where gaps are least.
void choose_stations(SystemModel& model) {
  const bool all = std::all_of(model.pairs.begin(), model.pairs.end(), [&](const PairSetup& pair) {
    return pair.settings.points == contact::SlavePoints::stations && lacks_for_stations(model, pair).empty();
  });
  for (PairSetup& pair : model.pairs) {
    if (pair.settings.points != contact::SlavePoints::stations) continue;
    if (!all) pair.settings.points = contact::SlavePoints::minima;
  }
}

void add_marker_forces(const MarkerSetups& setups, SystemModel& model) {
  std::vector<MarkerForces::Body> bodies;
  for (const SystemModel::Body& body : model.bodies) bodies.push_back({body.name, body.eq.body.get()});
  model.marker_forces = MarkerForces(setups, bodies);
  model.marker_forces.set_unloaded(moving_bodies(model, {0, model.U_0, model.V_0, model.V_0}));
}

}  // namespace

double gravity_share(const Environment& environment, double time) {
  return environment.gravity_rise > 0 ? std::clamp(time / environment.gravity_rise, 0.0, 1.0) : 1;
}

Eigen::Vector3d gravity(const Environment& environment, double time) {
  return gravity_share(environment, time) * environment.gravity;
}

SystemModel make_system_model(const std::vector<BodySetup>& bodies, const std::vector<PairSetup>& pairs,
                              const Environment& environment, const MarkerSetups& markers) {
  require(!bodies.empty(), "there is no body to simulate");
  require(environment.gravity.allFinite(), "gravity (", environment.gravity.transpose(), ") must be finite");
  SystemModel model;
  model.environment = environment;
  for (const BodySetup& setup : bodies) add_body(setup, model);
  for (const PairSetup& setup : pairs) add_pair(setup, model);
  choose_stations(model);
  add_marker_forces(markers, model);
  return model;
}

void begin_with(SystemModel& model, const std::vector<model::BodyState>& states) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    SystemModel::Body& body = model.bodies[b];
    const model::BodyState& state = states[b];
    model.U_0.segment(body.first + body.n_open(), body.eq.n_q()) = state.q;
    if (state.s.size() != body.eq.n_s()) continue;
    Eigen::VectorXd s = state.s;
    if (body.eq.joint.type == body::JointType::free) {
      body.eq.joint.R_WB0 = state.R_WB;
      s << state.r_WB, Eigen::Vector3d::Zero();
    }
    model.U_0.segment(body.first, body.n_open()) = s(body.open);
  }
}

body::Motion motion(const SystemModel& model, std::size_t b, const State& x) {
  const SystemModel::Body& body = model.bodies[b];
  const Eigen::Index n_s = body.eq.n_s(), s = body.first, q = s + body.n_open(), n_q = body.eq.n_q();
  body::Motion m{Eigen::VectorXd(n_s), Eigen::VectorXd(n_s), Eigen::VectorXd(n_s),
                 x.U.segment(q, n_q),  x.V.segment(q, n_q),  x.A.segment(q, n_q)};
  for (Eigen::Index i = s; const Eigen::Index open : body.open) {
    m.s[open] = x.U[i];
    m.s_dot[open] = x.V[i];
    m.s_ddot[open] = x.A[i++];
  }
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    if (axis.drive) {
      const Prescribed p = at(*axis.drive, x.time);
      m.s[i] = p.s;
      m.s_dot[i] = p.s_dot;
      m.s_ddot[i] = p.s_ddot;
    }
    ++i;
  }
  return m;
}

std::vector<MovingBody> moving_bodies(const SystemModel& model, const State& x) {
  std::vector<MovingBody> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    bodies.push_back({&model.bodies[b].eq, motion(model, b, x)});
  return bodies;
}

bool is_rigid(const SystemModel::Body& body) {
  return body.eq.n_q() == 0 && body.eq.body->flexibility.empty();
}

model::ResultHeader result_header(const SystemModel& model) {
  model::ResultHeader header;
  for (const SystemModel::Body& body : model.bodies) {
    header.bodies.push_back({body.name, "", body::joint_names()[static_cast<std::size_t>(body.eq.joint.type)],
                             !body.eq.body->relaxing.empty()});
    header.provenance[model::rigid_key(body.name)] = is_rigid(body) ? "true" : "false";
  }
  for (const PairSetup& pair : model.pairs) {
    const bool unilateral = pair.settings.law != contact::ContactLaw::penalty;
    model::ResultHeader::Pair entry{pair.name,
                                    {pair.body[0], pair.body[1]},
                                    {},
                                    unilateral ? "unilateral" : "penalty",
                                    strips_of(model, pair),
                                    pair.settings.friction.mu};
    for (int side : {0, 1})
      entry.group_name[side] = model.bodies[pair.body[side]].eq.body->surface.group_name;
    header.pairs.push_back(entry);
  }
  const MarkerSetups& markers = model.marker_forces.setups();
  for (const BushingSetup& bushing : markers.bushings) header.bushings.push_back(bushing.name);
  for (const SensorSetup& sensor : markers.sensors) header.sensors.push_back(sensor.name);
  return header;
}

}  // namespace elastogear::dynamics
