#include "dynamics/run/snapshot.h"

#include "dynamics/contact/pair_state.h"

namespace elastogear::dynamics {
namespace {

// Forces on the nodes that carry some. Stations also know those of teeth that are near each other.
model::ContactForces without_zeros(const NodalForces& forces) {
  model::ContactForces some;
  std::vector<Eigen::Index> column;
  for (Eigen::Index i = 0; i < forces.f_B.cols(); ++i)
    if (!forces.f_B.col(i).isZero(0)) {
      column.push_back(i);
      some.node.push_back(forces.node[static_cast<std::size_t>(i)]);
    }
  some.f_B = forces.f_B(Eigen::all, column);
  return some;
}

model::BodyState body_state(const body::Motion& m, const contact::SurfaceState& placement,
                            const NodalForces& contact) {
  return {.r_WB = placement.r_WB,
          .R_WB = placement.R_WB,
          .s = m.s,
          .s_dot = m.s_dot,
          .s_ddot = m.s_ddot,
          .q = m.q,
          .q_dot = m.q_dot,
          .q_ddot = m.q_ddot,
          .contact = without_zeros(contact)};
}

// Stored energy: docs/theory, Eq. (7.1).
double stored(const model::Energies& energy) {
  return energy.kinetic + energy.elastic + energy.contact + energy.bushing;
}

// Internal variables, and the energy that the material keeps with them.
void add_relaxation(const System& system, std::size_t b, const State& x, model::Snapshot& result) {
  const model::ElasticBody& body = *system.bodies()[b].eq.body;
  if (body.relaxing.empty()) return;
  const body::RelaxationLaw& law = system.relaxation_law(b);
  model::BodyState& state = result.bodies[b];
  state.z = system.internal_variables(b, x);
  state.w = state.z * law.g.transpose();
  result.energy.elastic += body::relaxed_energy(body, law, state.q, state.z);
}

void add_markers(const System& system, const State& x, model::Snapshot& result) {
  const MarkerForces& forces = system.marker_forces();
  const std::vector<MovingBody> bodies = system.moving_bodies(x);
  const MarkerSetups& setups = forces.setups();
  for (std::size_t i = 0; i < setups.bushings.size(); ++i) {
    const BushingForce b = forces.bushing_force(i, bodies);
    result.bushings.push_back({b.d, b.d_dot, b.angle, b.w, b.force, b.torque});
    result.energy.bushing += b.energy;
  }
  for (std::size_t i = 0; i < setups.loads.size(); ++i) {
    const body::MarkerMotion at = forces.load_motion(i, bodies);
    const body::Wrench wrench = forces.load_wrench(i, x.time, at);
    result.loads.push_back({wrench.head<3>(), wrench.tail<3>(), at.x, at.R});
  }
  for (std::size_t i = 0; i < setups.sensors.size(); ++i) {
    const body::MarkerMotion at = forces.sensor_motion(i, bodies);
    result.sensors.push_back({at.x, at.v, at.a, at.R, at.w});
  }
}

double weight_energy(const System& system, std::size_t b, const model::BodyState& x) {
  return body::gravity_energy(system.bodies()[b].eq, {x.s, x.s_dot, x.s_ddot, x.q, x.q_dot, x.q_ddot},
                              system.environment().gravity);
}

// Rotation from one frame to the other as Cayley's vector, which is the rotation vector to second order.
Eigen::Vector3d turn(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::Matrix3d R = to * from.transpose(), S = R - R.transpose();
  return 2 / (1 + R.trace()) * Eigen::Vector3d(S(2, 1), S(0, 2), S(1, 0));
}

}  // namespace

double stored_in_contact(const ContactState& contact) {
  double energy = 0;
  for (const PairContacts& pair : contact.pair)
    for (const contact::ContactPoint& point : pair.points) energy += point.energy;
  return energy + contact.stations.local_energy;
}

model::Snapshot snapshot(System& system, const State& x) {
  const ContactState& contact = system.observed_contacts(x);
  model::Snapshot result;
  result.time = x.time;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const body::Motion m = system.motion(b, x);
    result.bodies.push_back(body_state(m, contact.surface[b], contact.force[b]));
    result.bodies.back().joint_force = system.joint_force(b, x);
    add_relaxation(system, b, x, result);
    result.energy.kinetic += body::kinetic_energy(system.bodies()[b].eq, m);
    result.energy.elastic += body::elastic_energy(system.bodies()[b].eq, m) + system.residual_energy(b);
  }
  for (std::size_t p = 0; p < contact.pair.size(); ++p) result.pairs.push_back(pair_state(system, x, p));
  result.energy.contact = stored_in_contact(contact);
  add_markers(system, x, result);
  return result;
}

void EnergyLedger::enter_joint(const System::Body& body, const model::BodyState& now,
                               const model::BodyState& before, const std::array<double, 2>& times) {
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    const double distance = now.s[i] - before.s[i], rate = 0.5 * (now.s_dot[i] + before.s_dot[i]);
    const double lost = (times[1] - times[0]) * rate * resistance(axis, rate);
    dissipated_ += lost;
    work_ += axis.drive ? 0.5 * (now.joint_force[i] + before.joint_force[i]) * distance + lost
                        : at(axis.load, 0.5 * (times[0] + times[1])) * distance;
    if (axis.law)
      work_ += law_force(axis, 0.5 * (times[0] + times[1]), 0.5 * (now.s[i] + before.s[i]), rate) * distance;
    ++i;
  }
}

void EnergyLedger::enter_markers(const MarkerForces& forces, const model::Snapshot& now) {
  const double dt = now.time - time_;
  for (std::size_t i = 0; i < bushings_.size(); ++i) {
    const model::BushingState &a = bushings_[i], &b = now.bushings[i];
    dissipated_ += dt * dissipation(forces.setups().bushings[i].law, 0.5 * (a.velocity + b.velocity),
                                    0.5 * (a.rate + b.rate));
  }
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const model::LoadState &a = loads_[i], &b = now.loads[i];
    work_ += 0.5 * (a.force + b.force).dot(b.x - a.x) + 0.5 * (a.torque + b.torque).dot(turn(a.R, b.R));
  }
}

void EnergyLedger::enter_weight(const System& system, const model::Snapshot& now) {
  double weight = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) weight += weight_energy(system, b, now.bodies[b]);
  if (!bodies_.empty())
    work_ += 0.5 *
             (gravity_share(system.environment(), time_) + gravity_share(system.environment(), now.time)) *
             (weight_ - weight);
  weight_ = weight;
}

void EnergyLedger::enter_relaxation(const System& system, std::size_t b, const model::BodyState& now) {
  const model::ElasticBody& body = *system.bodies()[b].eq.body;
  if (body.relaxing.empty()) return;
  const model::BodyState& before = bodies_[b];
  const double lost =
      body::relaxation_loss(body, system.relaxation_law(b), {0, before.q, before.z}, {0, now.q, now.z});
  relaxation_ += lost;
  dissipated_ += lost;
}

void EnergyLedger::enter(const System& system, model::Snapshot& snapshot) {
  if (bodies_.empty()) stored_0_ = stored(snapshot.energy);
  enter_weight(system, snapshot);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const System::Body& body = system.bodies()[b];
    const Eigen::VectorXd q_dot_m = 0.5 * (bodies_[b].q_dot + snapshot.bodies[b].q_dot);
    dissipated_ += (snapshot.time - time_) * body::dissipation(body.eq, q_dot_m);
    enter_relaxation(system, b, snapshot.bodies[b]);
    enter_joint(body, snapshot.bodies[b], bodies_[b], {time_, snapshot.time});
  }
  enter_markers(system.marker_forces(), snapshot);
  double crept = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) crept += system.residual_loss(b);
  snapshot.energy.dissipated = dissipated_ + crept + system.contact_loss();
  snapshot.energy.work = work_;
  snapshot.energy.relaxation = relaxation_ + crept;
  snapshot.energy.balance =
      stored(snapshot.energy) + snapshot.energy.dissipated - snapshot.energy.work - stored_0_;
  time_ = snapshot.time;
  bodies_ = snapshot.bodies;
  bushings_ = snapshot.bushings;
  loads_ = snapshot.loads;
}

void EnergyLedger::serialize(Archive& archive) {
  for (double* x : {&stored_0_, &dissipated_, &work_, &weight_, &time_, &relaxation_}) archive(*x);
  archive.each(bodies_, [&](model::BodyState& body) {
    archive(body.r_WB);
    archive(body.R_WB);
    for (Eigen::VectorXd* x :
         {&body.s, &body.s_dot, &body.s_ddot, &body.q, &body.q_dot, &body.q_ddot, &body.joint_force})
      archive(*x);
    archive(body.z);
  });
  archive.each(bushings_, [&](model::BushingState& b) {
    for (Eigen::Vector3d* x : {&b.displacement, &b.velocity, &b.angle, &b.rate, &b.force, &b.torque})
      archive(*x);
  });
  archive.each(loads_, [&](model::LoadState& load) {
    for (Eigen::Vector3d* x : {&load.force, &load.torque, &load.x}) archive(*x);
    archive(load.R);
  });
}

}  // namespace elastogear::dynamics
