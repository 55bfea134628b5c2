#include "elastogear/dynamics/system.h"

#include <algorithm>

#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

constexpr double kRotationTolerance = 1e-6;  // on R'R = I and det R = 1, of matrices typed by hand

void append(Eigen::VectorXd& x, const Eigen::VectorXd& tail) {
  x.conservativeResize(x.size() + tail.size());
  x.tail(tail.size()) = tail;
}

void validate_joint(const BodySetup& setup) {
  const body::Joint& joint = setup.joint;
  const std::string who = "body '" + setup.name + "': ";
  require(joint.r_WB0.allFinite(), who, "position (", joint.r_WB0.transpose(), ") must be finite");
  const Eigen::Matrix3d& R = joint.R_WB0;
  require(R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationTolerance &&
              R.determinant() > 0,
          who, "rotation is not a rotation matrix");
  require(std::isfinite(setup.angle0) && std::isfinite(setup.omega0) && std::isfinite(setup.torque), who,
          "angle0 = ", setup.angle0, ", omega0 = ", setup.omega0, ", torque = ", setup.torque,
          " must be finite");
  require(
      joint.type != body::JointType::fixed || (setup.angle0 == 0 && setup.omega0 == 0 && setup.torque == 0),
      who, "a fixed joint takes no angle0, omega0 or torque");
}

void validate_body(const BodySetup& setup, const std::vector<System::Body>& others) {
  require(!setup.name.empty(), "a body has no name");
  for (const System::Body& other : others)
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

// Positions of the nodes that contact touches; the others' stay undeformed.
void place_touched(const PairContacts& pair, const model::Surface* surface[2],
                   const contact::SurfaceMotion* motion[2], std::vector<contact::SurfaceState>& state) {
  for (const contact::ContactPoint& point : pair.points)
    for (int i = 0; i < kLocalNodes; ++i) {
      const auto [side, node] = local_node(point, i);
      state[pair.body[side]].x_B.col(node) =
          surface[side]->X.col(node) + model::displacement(surface[side]->Phi, node, motion[side]->q);
    }
}

void set_norms(Residual& r, std::size_t block, Eigen::Index first,
               const std::vector<Eigen::VectorXd>& terms) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(terms.front().size());
  for (const Eigen::VectorXd& term : terms) {
    sum += term;
    r.scale[block] += term.norm();
  }
  r.norm[block] = sum.norm();
  r.F.segment(first, sum.size()) = sum;
}

const char* name(body::JointType type) { return type == body::JointType::fixed ? "fixed" : "revolute"; }

// Everything of a body's terms but contact, docs/theory.md, "Solving for one Newton step".
BodyTerms inertia_terms(const body::Equations& eq, const body::Motion& m, const EffectiveMatrix& A,
                        const std::vector<int>& node) {
  const Eigen::Index n_s = eq.n_s(), n_u = n_s + n_s * n_s;
  BodyTerms terms;
  terms.node = node;
  terms.C = A.shift_a * body::joint_inertia(eq, m.q) + A.shift_v * body::joint_inertia_change(eq, m.q_dot);
  terms.beta.setZero(n_u + 3 * static_cast<Eigen::Index>(node.size()), n_s);
  terms.beta.topRows(n_s) = A.shift_a * Eigen::MatrixXd::Identity(n_s, n_s);
  terms.rho = terms.beta;
  const Eigen::VectorXd of_row = m.s_ddot + A.shift_v * m.s_dot;
  for (Eigen::Index i = 0; i < n_s; ++i)
    for (Eigen::Index j = 0; j < n_s; ++j) {
      terms.beta(n_s + j * n_s + i, i) -= A.shift_v * m.s_dot[j];
      terms.rho(n_s + j * n_s + i, i) += of_row[j];
    }
  return terms;
}

}  // namespace

System::System(std::vector<BodySetup> bodies, std::vector<PairSetup> pairs, body::InertiaLevel level) {
  require(!bodies.empty(), "there is no body to simulate");
  for (const BodySetup& setup : bodies) add_body(setup, level);
  for (const PairSetup& setup : pairs) add_pair(setup);
}

void System::add_body(const BodySetup& setup, body::InertiaLevel level) {
  validate_body(setup, bodies_);
  bodies_.push_back({setup.name, body::make_equations(setup.body, setup.joint, level), size(), setup.torque,
                     false, node_groups(setup.body->surface)});
  const body::Equations& eq = bodies_.back().eq;
  append(U_0_, Eigen::VectorXd::Constant(eq.n_s(), setup.angle0));
  append(U_0_, Eigen::VectorXd::Zero(eq.n_q()));
  append(V_0_, Eigen::VectorXd::Constant(eq.n_s(), setup.omega0));
  append(V_0_, setup.q_dot0.size() ? setup.q_dot0 : Eigen::VectorXd::Zero(eq.n_q()));
}

void System::add_pair(const PairSetup& setup) {
  const auto n = static_cast<int>(bodies_.size());
  for (int b : setup.body) {
    require(b >= 0 && b < n, "contact pair '", setup.name, "' names body ", b, ", allowed are 0..", n - 1);
    require(bodies_[b].eq.body->surface.face.cols() > 0, "contact pair '", setup.name, "': body '",
            bodies_[b].name, "' has no surface faces");
    bodies_[b].in_contact = true;
  }
  require(setup.body[0] != setup.body[1], "contact pair '", setup.name, "' names one body twice");
  pairs_.push_back(setup);
  const model::ElasticBody& a = *bodies_[setup.body[0]].eq.body;
  const model::ElasticBody& b = *bodies_[setup.body[1]].eq.body;
  detectors_.emplace_back(a.surface, b.surface, setup.settings, std::array{&a.K_r, &b.K_r});
}

std::vector<const body::Equations*> System::equations() const {
  std::vector<const body::Equations*> equations;
  for (const Body& body : bodies_) equations.push_back(&body.eq);
  return equations;
}

body::Motion System::motion(std::size_t b, ConstVector U, ConstVector V, ConstVector A) const {
  const body::Equations& eq = bodies_[b].eq;
  const Eigen::Index s = bodies_[b].first, n_s = eq.n_s(), q = s + n_s, n_q = eq.n_q();
  return {U.segment(s, n_s), V.segment(s, n_s), A.segment(s, n_s),
          U.segment(q, n_q), V.segment(q, n_q), A.segment(q, n_q)};
}

const ContactState& System::contacts(ConstVector U) {
  if (U_of_state_ && *U_of_state_ == U) return state_;
  U_of_state_.reset();
  std::vector<contact::SurfaceMotion> motion;
  state_.surface.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    motion.push_back(surface_motion(b, U));
    const bool first = state_.surface[b].x_B.cols() == 0 && bodies_[b].in_contact;
    if (first) state_.surface[b].x_B = bodies_[b].eq.body->surface.X;
    state_.surface[b].r_WB = motion[b].r_WB;
    state_.surface[b].R_WB = motion[b].R_WB;
  }
  state_.pair.clear();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const int a = pairs_[p].body[0], b = pairs_[p].body[1];
    const model::Surface* surface[2] = {&bodies_[a].eq.body->surface, &bodies_[b].eq.body->surface};
    const contact::SurfaceMotion* moved[2] = {&motion[a], &motion[b]};
    state_.pair.push_back({{a, b}, detectors_[p].detect(motion[a], motion[b])});
    place_touched(state_.pair.back(), surface, moved, state_.surface);
  }
  state_.force = nodal_forces(state_.pair, state_.surface);
  U_of_state_ = U;
  return state_;
}

contact::SurfaceMotion System::surface_motion(std::size_t b, ConstVector U) const {
  const body::Equations& eq = bodies_[b].eq;
  const auto [r_WB, R_WB] = body::placement(eq.joint, eq.H, U.segment(bodies_[b].first, eq.n_s()));
  return {U.segment(bodies_[b].first + eq.n_s(), eq.n_q()), r_WB, R_WB};
}

double System::depth_share(ConstVector U) {
  double share = 0;
  const ContactState& contact = contacts(U);
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (const contact::ContactPoint& point : contact.pair[p].points)
      share = std::max(share, -point.g_n / detectors_[p].settings().depth);
  return share;
}

Residual System::residual(ConstVector U, ConstVector V, ConstVector A) {
  const ContactState& contact = contacts(U);
  const auto n_blocks = static_cast<Eigen::Index>(2 * bodies_.size());
  Residual r{Eigen::VectorXd::Zero(size()), Eigen::VectorXd::Zero(n_blocks), Eigen::VectorXd::Zero(n_blocks)};
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const body::Equations& eq = bodies_[b].eq;
    const body::Motion m = motion(b, U, V, A);
    const body::Force inertia = body::inertia_force(eq, m), quadratic = body::quadratic_force(eq, m),
                      inner = body::inner_force(eq, m), touch = contact_force(eq, contact.force[b]);
    const Eigen::VectorXd torque = Eigen::VectorXd::Constant(eq.n_s(), bodies_[b].torque);
    const Eigen::Index first = bodies_[b].first;
    set_norms(r, 2 * b, first, {inertia.s, inner.s, -quadratic.s, -touch.s, -torque});
    set_norms(r, 2 * b + 1, first + eq.n_s(), {inertia.q, inner.q, -quadratic.q, -touch.q});
  }
  return r;
}

EffectiveMatrix System::effective_matrix(ConstVector U, ConstVector V, ConstVector A, double shift_v,
                                         double shift_a) {
  const ContactState& contact = contacts(U);
  EffectiveMatrix matrix;
  matrix.shift_v = shift_v;
  matrix.shift_a = shift_a;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    matrix.body.push_back(inertia_terms(bodies_[b].eq, motion(b, U, V, A), matrix, contact.force[b].node));
    add_geometric_stiffness(bodies_[b].eq, contact.force[b], matrix.body.back());
  }
  set_contact_columns(equations(), contact.pair, contact.surface, matrix);
  return matrix;
}

model::ResultHeader result_header(const System& system) {
  model::ResultHeader header;
  for (const System::Body& body : system.bodies())
    header.bodies.push_back({body.name, "", name(body.eq.joint.type)});
  for (const PairSetup& pair : system.pairs()) {
    model::ResultHeader::Pair entry{pair.name, {pair.body[0], pair.body[1]}, {}};
    for (int side : {0, 1})
      entry.group_name[side] = system.bodies()[pair.body[side]].eq.body->surface.group_name;
    header.pairs.push_back(entry);
  }
  return header;
}

}  // namespace elastogear::dynamics
