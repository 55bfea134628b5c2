#include "dynamics/contact/pair_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "elastogear/model/corner_shares.h"

namespace elastogear::dynamics {
namespace {

// Moment of local node i's force about the world origin.
Eigen::Vector3d local_moment(const contact::ContactPoint& point, int i,
                             const contact::SurfaceState& surface) {
  const Eigen::Vector3d x_W = surface.r_WB + surface.R_WB * surface.x_B.col(local_node(point, i).node);
  return x_W.cross(local_force(point, i));
}

Eigen::Vector3d moment_on_b(const contact::ContactPoint& point, const contact::SurfaceState& b) {
  if (point.pressure > 0)
    return point.place.cross(point.slave_side == 1 ? point.f : Eigen::Vector3d(-point.f));
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int i = 0; i < point.n_local(); ++i)
    if (local_node(point, i).side == 1) moment += local_moment(point, i, b);
  return moment;
}

// Velocity of a surface node in the world frame, m/s.
Eigen::Vector3d velocity(const System::Body& body, const contact::SurfaceMotion& m, int node) {
  const model::Surface& surface = body.eq.body->surface;
  const Eigen::Vector3d x_B = surface.X.col(node) + model::displacement(surface.Phi, node, m.q);
  return m.R_WB * (m.v_WB_B + m.w_WB_B.cross(x_B) + model::displacement(surface.Phi, node, m.q_dot));
}

// Tangential velocity of the slave point on the master, m/s, for contacts whose force does not depend on it.
Eigen::Vector3d slip(const contact::ContactPoint& point, const System::Body* body[2],
                     const contact::SurfaceMotion motion[2]) {
  const int slave = point.slave_side, master = 1 - slave;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (int i = 0; i < point.n_slave(); ++i)
    if (point.slave_N[i] != 0)
      v += point.slave_N[i] * velocity(*body[slave], motion[slave], point.slave_nodes[i]);
  for (Eigen::Index i = 0; i < point.N.size(); ++i)
    if (point.N[i] != 0) v -= point.N[i] * velocity(*body[master], motion[master], point.master_nodes[i]);
  return v - point.n * point.n.dot(v);
}

// Normal force at the slave nodes of each side, N, from all contacts that load them.
using SlaveForces = std::array<std::map<int, double>, 2>;

SlaveForces slave_forces(const std::vector<contact::ContactPoint>& points) {
  SlaveForces forces;
  for (const contact::ContactPoint& point : points)
    for (int i = 0; i < point.n_slave(); ++i)
      if (point.slave_N[i] != 0)
        forces[point.slave_side][point.slave_nodes[i]] += point.slave_N[i] * point.f.dot(point.n);
  return forces;
}

// Normal forces of the slave nodes of one side, N, and the pressure that they are at each node, Pa: that of
// the corners, and between two of them their mean.
struct SideForces {
  const std::map<int, double>* node;
  const Eigen::VectorXd* area;  // m^2, of each node
  std::vector<model::CornersOfNode> corners;
  Eigen::RowVectorXd corner_pressure;

  SideForces(const std::map<int, double>& force, const System::Body& body)
      : node(&force), area(&body.node_area), corners(model::corners_of_nodes(body.eq.body->surface)) {
    Eigen::MatrixXd of_nodes = Eigen::MatrixXd::Zero(2, area->size());  // forces and areas
    for (const auto& [i, f] : force) of_nodes(0, i) = f;
    of_nodes.row(1) = area->transpose();
    const Eigen::MatrixXd sums = model::sums_at_corners(corners, of_nodes);
    corner_pressure = (sums.row(1).array() > 0).select(sums.row(0).cwiseQuotient(sums.row(1)), 0.0);
  }
  double pressure(int i) const {
    const auto [a, b] = corners[static_cast<std::size_t>(i)];
    return (corner_pressure[a] + corner_pressure[b]) / 2;
  }
};

// The share of its slave nodes' area that a contact has, m^2, and the pressure there, Pa.
struct Pressed {
  double area = 0, pressure = 0;
};

Pressed pressed(const contact::ContactPoint& point, const SideForces& force) {
  if (point.pressure > 0) return {point.area, point.pressure};
  if (point.area > 0) return {point.area, force.node->at(point.slave_node) / point.area};
  Pressed sum;
  for (int i = 0; i < point.n_slave(); ++i) {
    const int node = point.slave_nodes[i];
    const double N = point.slave_N[i], area = (*force.area)[node];
    if (N == 0 || !(area > 0)) continue;
    const double all = force.node->at(node);
    sum.area += all != 0 ? N * point.f.dot(point.n) / all * area : area;
    sum.pressure += N * force.pressure(node);
  }
  return sum;
}

// The pressure that the nodes of the master bear as slaves, at the closest point.
double pressure_of_master(const contact::ContactPoint& point, const SideForces& force) {
  double pressure = 0;
  for (Eigen::Index i = 0; i < point.N.size(); ++i)
    pressure += point.N[i] * force.pressure(point.master_nodes[i]);
  return pressure;
}

model::ContactFigures figures(const contact::ContactPoint& point, const Pressed& pressed) {
  model::ContactFigures f;
  f.count = 1;
  f.area = pressed.area;
  f.pressure = pressed.pressure;
  f.sliding_speed = point.slip.norm();
  f.friction_power = point.friction_power;
  f.damping_power = point.power;
  return f;
}

void add(model::ContactFigures& sum, const model::ContactFigures& f) {
  sum.torque += f.torque;
  sum.count += f.count;
  sum.area += f.area;
  sum.pressure = std::max(sum.pressure, f.pressure);
  sum.sliding_speed = std::max(sum.sliding_speed, f.sliding_speed);
  sum.friction_power += f.friction_power;
  sum.damping_power += f.damping_power;
}

model::ContactRecord record(const contact::ContactPoint& point, double pressure) {
  return {point.slave_side, point.slave_node, point.face, point.xi,  point.eta,
          point.g_n,        point.f,          pressure,   point.slip};
}

// With a penalty each of two passes carries half of the pressure; without one each carries some part, as
// edges of the master do in one pass.
template <class OfMaster>
double pressure_of_other_pass(const contact::Settings& settings, double own, const OfMaster& of_master) {
  if (settings.points == contact::SlavePoints::stations) return 0;
  if (settings.law == contact::ContactLaw::penalty) return settings.two_pass ? own : 0;
  return settings.points == contact::SlavePoints::nodes ? of_master() : 0;
}

}  // namespace

model::PairState pair_state(System& system, const State& x, std::size_t p) {
  const ContactState& contact = system.observed_contacts(x);
  const PairContacts& pair = contact.pair[p];
  const System::Body* body[2] = {&system.bodies()[pair.body[0]], &system.bodies()[pair.body[1]]};
  model::PairState state;
  for (int side : {0, 1}) {
    const std::size_t n = body[side]->eq.body->surface.group_name.size();
    state.group_force[side].assign(n, Eigen::Vector3d::Zero());
    state.area[side].resize(n);
  }
  const contact::SurfaceMotion motion[2] = {system.surface_motion(pair.body[0], x.time, x.U, x.V),
                                            system.surface_motion(pair.body[1], x.time, x.U, x.V)};
  const SlaveForces normal_force = slave_forces(pair.points);
  const SideForces force[2] = {{normal_force[0], *body[0]}, {normal_force[1], *body[1]}};
  for (contact::ContactPoint point : pair.points) {
    const int slave = point.slave_side, master = 1 - slave;
    const Eigen::Vector3d f_b = slave == 1 ? point.f : Eigen::Vector3d(-point.f);
    if (point.V_dot.cols() == 0 && point.slip.isZero(0)) point.slip = slip(point, body, motion);
    model::ContactFigures f = figures(point, pressed(point, force[slave]));
    f.pressure += pressure_of_other_pass(system.pairs()[p].settings, f.pressure,
                                         [&] { return pressure_of_master(point, force[master]); });
    f.torque = moment_on_b(point, contact.surface[pair.body[1]]);
    const int group[2] = {body[slave]->node_group[point.slave_node],
                          body[master]->eq.body->surface.group[point.face]};
    state.group_force[slave][group[0]] += f_b;
    state.group_force[master][group[1]] += f_b;
    add(state.area[slave][group[0]], f);
    add(state.area[master][group[1]], f);
    add(state.total, f);
    state.force += f_b;
    state.penetration = std::max(state.penetration, -point.g_n);
    state.contacts.push_back(record(point, f.pressure));
  }
  state.torque = state.total.torque;
  state.count = state.total.count;
  return state;
}

}  // namespace elastogear::dynamics
