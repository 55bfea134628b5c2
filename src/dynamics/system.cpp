#include "elastogear/dynamics/system.h"

#include <algorithm>
#include <utility>

#include "dynamics/integrator/low_rank_columns.h"
#include "elastogear/base/error.h"
#include "elastogear/body/tangent.h"

namespace elastogear::dynamics {
namespace {

using Terms = std::vector<Eigen::VectorXd>;

Eigen::VectorXd sum(const Terms& terms) {
  Eigen::VectorXd total = Eigen::VectorXd::Zero(terms.front().size());
  for (const Eigen::VectorXd& term : terms) total += term;
  return total;
}

// Norm of the sum and sum of the norms, of the given entries.
void set_norms(Residual& r, std::size_t block, const Terms& terms, const std::vector<Eigen::Index>* entries) {
  const auto norm = [&](const Eigen::VectorXd& x) { return entries ? x(*entries).norm() : x.norm(); };
  for (const Eigen::VectorXd& term : terms) r.scale[block] += norm(term);
  r.norm[block] = norm(sum(terms));
}

// A matrix with further rows of zeros.
Eigen::MatrixXd extended(const Eigen::MatrixXd& top, Eigen::Index rows) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, top.cols());
  all.topRows(top.rows()) = top;
  return all;
}

// n_m: rows of the body's markers.
BodyTerms body_terms(body::Tangent tangent, Eigen::Index n_m, const std::vector<int>& node) {
  const Eigen::Index n_e = tangent.beta.rows() + n_m + 3 * static_cast<Eigen::Index>(node.size());
  BodyTerms terms;
  terms.node = node;
  terms.C = std::move(tangent.C);
  terms.beta = extended(tangent.beta, n_e);
  terms.rho = extended(tangent.rho, n_e);
  terms.R_q = std::move(tangent.R_q);
  terms.Q_s = std::move(tangent.Q_s);
  terms.Gamma = tangent.Gamma;
  return terms;
}

// Load minus resistance along each joint coordinate, and the derivative of the latter.
Eigen::VectorXd load(const System::Body& body, double time, const Eigen::VectorXd& s_dot) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(body.eq.n_s());
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    h[i] = at(axis.load, time) - resistance(axis, s_dot[i]);
    ++i;
  }
  return h;
}

Eigen::VectorXd load_rate(const System::Body& body, const Eigen::VectorXd& s_dot) {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(body.eq.n_s());
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    rate[i] = resistance_rate(axis, s_dot[i]);
    ++i;
  }
  return rate;
}

// Rows and columns of the coordinates that are unknown.
void keep_open(BodyTerms& terms, const std::vector<Eigen::Index>& open) {
  if (terms.C.rows() == static_cast<Eigen::Index>(open.size())) return;
  const auto columns = [&](Eigen::MatrixXd& M) { M = Eigen::MatrixXd(M(Eigen::all, open)); };
  const auto rows = [&](Eigen::MatrixXd& M) { M = Eigen::MatrixXd(M(open, Eigen::all)); };
  rows(terms.C);
  columns(terms.C);
  columns(terms.beta);
  columns(terms.rho);
  rows(terms.W_s);
  rows(terms.V_s);
  if (terms.Q_s.rows() == 0) return;
  rows(terms.R_q);
  columns(terms.Q_s);
}

}  // namespace

double gravity_share(const Environment& environment, double time) {
  return environment.gravity_rise > 0 ? std::clamp(time / environment.gravity_rise, 0.0, 1.0) : 1;
}

Eigen::Vector3d gravity(const Environment& environment, double time) {
  return gravity_share(environment, time) * environment.gravity;
}

std::vector<SolverBody> System::solver_bodies() const {
  std::vector<SolverBody> bodies;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    bodies.push_back({&bodies_[b].eq, bodies_[b].n_open(), marker_forces_.columns(b)});
  return bodies;
}

bool System::solver_is_exact() const {
  return std::none_of(bodies_.begin(), bodies_.end(), [](const Body& body) {
    return body.eq.level == body::InertiaLevel::full && body.eq.n_s() > 0;
  });
}

body::Motion System::motion(std::size_t b, const State& x) const {
  const Body& body = bodies_[b];
  const Eigen::Index n_s = body.eq.n_s(), s = body.first, q = s + body.n_open(), n_q = body.eq.n_q();
  body::Motion m{Eigen::VectorXd(n_s), Eigen::VectorXd(n_s), Eigen::VectorXd(n_s),
                 x.U.segment(q, n_q),  x.V.segment(q, n_q),  x.A.segment(q, n_q)};
  m.s(body.open) = x.U.segment(s, body.n_open());
  m.s_dot(body.open) = x.V.segment(s, body.n_open());
  m.s_ddot(body.open) = x.A.segment(s, body.n_open());
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

std::vector<MovingBody> System::moving_bodies(const State& x) const {
  std::vector<MovingBody> bodies;
  for (std::size_t b = 0; b < bodies_.size(); ++b) bodies.push_back({&bodies_[b].eq, motion(b, x)});
  return bodies;
}

contact::SurfaceMotion System::surface_motion(std::size_t b, double time, ConstVector U,
                                              ConstVector V) const {
  const body::Motion m = motion(b, {time, U, V, V});
  const auto [r_WB, R_WB] = body::placement(bodies_[b].eq.joint, m.s);
  const body::FrameMotion frame = body::frame_motion(bodies_[b].eq, m);
  return {m.q, r_WB, R_WB, m.q_dot, frame.v, frame.w};
}

void System::accept(const State& x) {
  const ContactState& contact = contacts(x.time, x.U, x.V);
  double power = 0;
  bool any_sticks = false;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const contact::FrictionSettings& friction = pairs_[p].settings.friction;
    const bool sticks = friction.mu > 0 && friction.law == contact::FrictionLaw::stick;
    any_sticks |= sticks;
    for (const contact::ContactPoint& point : contact.pair[p].points) {
      history_.loss += point.slip_work;
      power += point.power + (sticks ? 0 : point.friction_power);
    }
    detectors_[p].accept(contact.pair[p].points);
  }
  if (accepted_) history_.loss += 0.5 * (x.time - history_.time) * (power + history_.power);
  history_.time = x.time;
  history_.power = power;
  accepted_ = true;
  if (residual_contact_.any()) residual_contact_.accept(x.time);
  if (any_sticks) U_of_state_.reset();  // forces of the same state start from the new history
}

ContactHistory System::contact_history() const {
  ContactHistory history = history_;
  for (const contact::Pair& pair : detectors_) history.stuck.push_back(pair.history());
  return history;
}

void System::restore(const ContactHistory& history) {
  require(history.stuck.size() == pairs_.size(), "contact history of ", history.stuck.size(),
          " pairs, the system has ", pairs_.size());
  for (std::size_t p = 0; p < pairs_.size(); ++p) detectors_[p].restore(history.stuck[p]);
  history_ = {history.time, history.power, history.loss, {}};
  accepted_ = true;
  U_of_state_.reset();
}

std::vector<MarkerForce> System::at_markers(const State& x) const {
  if (!marker_forces_.empty()) return marker_forces_.forces(x.time, moving_bodies(x));
  std::vector<MarkerForce> all;
  for (const Body& body : bodies_) {
    const body::Force none{Eigen::VectorXd::Zero(body.eq.n_s()), Eigen::VectorXd::Zero(body.eq.n_q())};
    all.push_back({none, none});
  }
  return all;
}

body::Force System::balance(std::size_t b, const State& x, const MarkerForce& marker_force, Residual* r) {
  const Body& body = bodies_[b];
  const body::Motion m = motion(b, x);
  const body::Force inertia = body::inertia_force(body.eq, m), quadratic = body::quadratic_force(body.eq, m),
                    inner = body::inner_force(body.eq, m),
                    weight = body::gravity_force(body.eq, m, gravity(environment_, x.time)),
                    touch = contact_force(body.eq, contacts(x.time, x.U, x.V).force[b]);
  const Terms s{inertia.s,
                -quadratic.s,
                -touch.s,
                -weight.s,
                -marker_force.loads.s,
                -marker_force.bushings.s,
                -load(body, x.time, m.s_dot)},
      q{inertia.q,
        inner.q,
        -quadratic.q,
        -touch.q,
        -weight.q,
        -marker_force.loads.q,
        -marker_force.bushings.q};
  const body::Force total{sum(s), sum(q)};
  if (!r) return total;
  r->F.segment(body.first, body.n_open()) = total.s(body.open);
  r->F.segment(body.first + body.n_open(), body.eq.n_q()) = total.q;
  set_norms(*r, 2 * b, s, &body.open);
  set_norms(*r, 2 * b + 1, q, nullptr);
  return total;
}

Residual System::residual(const State& x) {
  const auto n_blocks = static_cast<Eigen::Index>(2 * bodies_.size());
  Residual r{Eigen::VectorXd::Zero(size()), Eigen::VectorXd::Zero(n_blocks), Eigen::VectorXd::Zero(n_blocks)};
  const std::vector<MarkerForce> marker_force = at_markers(x);
  for (std::size_t b = 0; b < bodies_.size(); ++b) balance(b, x, marker_force[b], &r);
  return r;
}

Eigen::VectorXd System::joint_force(std::size_t b, const State& x) {
  const Body& body = bodies_[b];
  Eigen::VectorXd force = load(body, x.time, motion(b, x).s_dot);
  const bool driven = body.n_open() < body.eq.n_s();
  if (!driven) return force;
  const Eigen::VectorXd missing = balance(b, x, at_markers(x)[b], nullptr).s;
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    if (axis.drive) force[i] += missing[i];
    ++i;
  }
  return force;
}

EffectiveMatrix System::effective_matrix(const State& x, const body::Shifts& shift) {
  const ContactState& contact = contacts(x.time, x.U, x.V);
  EffectiveMatrix matrix;
  matrix.shift_v = shift.v;
  matrix.shift_a = shift.a;
  std::vector<JointTwists> twists;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const body::Equations& eq = bodies_[b].eq;
    const body::Motion m = motion(b, x);
    const std::vector<int>& node = contact.force[b].node;
    const body::JointMotion joint{m.s, m.s_dot, m.s_ddot};
    const body::FrameDerivative d = body::frame_derivative(eq.joint, eq.H, joint, shift);
    twists.push_back({eq.H, body::MotionSubspace(6, eq.n_s()),
                      velocity_twists(eq.joint, eq.H, joint, shift.v), body::frame_motion(eq, m).w, shift.v});
    twists.back().P << d.r, d.theta;
    matrix.body.push_back(body_terms(body::tangent(eq, m, gravity(environment_, x.time), shift),
                                     marker_forces_.row_count(b), node));
    matrix.body.back().C.diagonal() += shift.v * load_rate(bodies_[b], m.s_dot);
    add_geometric_stiffness(twists.back(), contact.force[b], matrix.body.back());
    matrix.body.back().R = residual_contact_.among(b, node);
  }
  set_contact_columns(twists, contact.pair, contact.surface, matrix);
  if (!marker_forces_.empty()) marker_forces_.add_tangent(x.time, moving_bodies(x), shift, matrix);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    add_border_stiffness(body::stiffness_in_border(bodies_[b].eq, matrix.body[b].Gamma), b, matrix);
    keep_open(matrix.body[b], bodies_[b].open);
  }
  return matrix;
}

bool System::rebase(Eigen::Ref<Eigen::VectorXd> U) {
  bool any = false;
  for (Body& body : bodies_) {
    if (!body::has_rotation_vector(body.eq.joint.type)) continue;
    body.eq.joint = body::rebased(body.eq.joint, U.segment(body.first, body.eq.n_s()));
    U.segment<3>(body.first + body.eq.n_s() - 3).setZero();
    any = true;
  }
  if (any) U_of_state_.reset();
  return any;
}

void System::serialize_contact_history(Archive& archive) {
  ContactHistory history = contact_history();
  for (double* x : {&history.time, &history.power, &history.loss}) archive(*x);
  for (auto& points : history.stuck)
    archive.each(points, [&](contact::StickPoint& point) {
      for (int* n : {&point.slave_side, &point.slave_node, &point.face}) archive(*n);
      for (double* x : {&point.u, &point.v, &point.e_u, &point.e_v}) archive(*x);
      archive(point.slides);
    });
  if (archive.is_loading()) restore(history);
}

void System::serialize(Archive& archive) {
  for (Body& body : bodies_) {
    archive(body.eq.joint.r_WB0);
    archive(body.eq.joint.R_WB0);
  }
  serialize_contact_history(archive);
  for (contact::Pair& pair : detectors_) pair.serialize(archive);
  residual_contact_.serialize(archive);
  if (archive.is_loading()) U_of_state_.reset();
}

model::ResultHeader result_header(const System& system) {
  model::ResultHeader header;
  for (const System::Body& body : system.bodies())
    header.bodies.push_back(
        {body.name, "", body::joint_names()[static_cast<std::size_t>(body.eq.joint.type)]});
  for (const PairSetup& pair : system.pairs()) {
    model::ResultHeader::Pair entry{pair.name, {pair.body[0], pair.body[1]}, {}};
    for (int side : {0, 1})
      entry.group_name[side] = system.bodies()[pair.body[side]].eq.body->surface.group_name;
    header.pairs.push_back(entry);
  }
  const MarkerSetups& markers = system.marker_forces().setups();
  for (const BushingSetup& bushing : markers.bushings) header.bushings.push_back(bushing.name);
  for (const SensorSetup& sensor : markers.sensors) header.sensors.push_back(sensor.name);
  return header;
}

}  // namespace elastogear::dynamics
