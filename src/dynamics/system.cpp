#include "elastogear/dynamics/system.h"

#include <algorithm>
#include <utility>

#include "dynamics/contact/low_rank_columns.h"
#include "dynamics/system_contact.h"
#include "dynamics/system_relaxation.h"
#include "elastogear/body/tangent.h"

namespace elastogear::dynamics {
namespace {

// Forces that are to balance those that are subtracted.
struct Terms {
  std::vector<const Eigen::VectorXd*> added, subtracted;
};

Eigen::VectorXd sum(const Terms& terms) {
  Eigen::VectorXd total = *terms.added.front();
  for (std::size_t i = 1; i < terms.added.size(); ++i) total += *terms.added[i];
  for (const Eigen::VectorXd* term : terms.subtracted) total -= *term;
  return total;
}

// Norm of the sum and sum of the norms, of the given entries.
void set_norms(Residual& r, std::size_t block, const Terms& terms, const Eigen::VectorXd& sum,
               const std::vector<Eigen::Index>* entries) {
  const auto norm = [&](const Eigen::VectorXd& x) { return entries ? x(*entries).norm() : x.norm(); };
  for (const auto* list : {&terms.added, &terms.subtracted})
    for (const Eigen::VectorXd* term : *list) r.scale[block] += norm(*term);
  r.norm[block] = norm(sum);
}

constexpr double kLeast = 1e-3;  // of forces that cancel, as a scale of what is left

// Contact forces that cancel on all modes, as those along a tooth do on modes out of its plane, leave their
// roundoff.
void raise_cancelled(Residual& r, std::size_t block, const NodalForces& contact, double row_size) {
  const double before = contact.f_B.colwise().norm().sum() * row_size;
  r.scale[static_cast<Eigen::Index>(block)] =
      std::max(r.scale[static_cast<Eigen::Index>(block)], kLeast * before);
}

// Coordinates on which the forces cancel, as the angle of an idler between two gears, or modes out of a plane
// of symmetry, are in balance when what is left is small against the forces on those of other bodies.
void raise_vanishing_scales(Residual& r) {
  for (Eigen::Index kind : {0, 1}) {
    double largest = 0;
    for (Eigen::Index i = kind; i < r.scale.size(); i += 2) largest = std::max(largest, r.scale[i]);
    for (Eigen::Index i = kind; i < r.scale.size(); i += 2)
      r.scale[i] = std::max(r.scale[i], kLeast * largest);
  }
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

// Loads minus resistance along each joint coordinate, and minus their derivative with it at a shift.
Eigen::VectorXd load(const SystemModel::Body& body, double time, const body::Motion& m) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(body.eq.n_s());
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    h[i] = at(axis.load, time) - resistance(axis, m.s_dot[i]);
    if (axis.law) h[i] += law_force(axis, time, m.s[i], m.s_dot[i]);
    ++i;
  }
  return h;
}

Eigen::VectorXd load_stiffness(const SystemModel::Body& body, double time, const body::Motion& m,
                               double shift_v) {
  Eigen::VectorXd k = Eigen::VectorXd::Zero(body.eq.n_s());
  for (Eigen::Index i = 0; const Axis& axis : body.axis) {
    k[i] = shift_v * resistance_rate(axis, m.s_dot[i]);
    if (axis.law) {
      const LawRates law = law_rates(axis, time, m.s[i], m.s_dot[i]);
      k[i] -= law.by_s + shift_v * law.by_s_dot;
    }
    ++i;
  }
  return k;
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

System::System(SystemModel model)
    : model_(std::move(model)),
      contact_(std::make_unique<SystemContact>(model_)),
      relaxation_(std::make_unique<SystemRelaxation>(model_)) {}
System::System(const std::vector<BodySetup>& bodies, const std::vector<PairSetup>& pairs,
               const Environment& environment, const MarkerSetups& markers)
    : System(make_system_model(bodies, pairs, environment, markers)) {}
System::System(SystemModel model, const System& like)
    : model_(std::move(model)),
      contact_(std::make_unique<SystemContact>(model_, like.contact_.get())),
      relaxation_(std::make_unique<SystemRelaxation>(model_)) {}
System::~System() = default;
System::System(System&&) noexcept = default;

std::vector<SolverBody> System::solver_bodies() const {
  std::vector<SolverBody> bodies;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b)
    bodies.push_back({&model_.bodies[b].eq, model_.bodies[b].n_open(), model_.marker_forces.columns(b)});
  return bodies;
}

bool System::solver_is_exact() const {
  return std::none_of(model_.bodies.begin(), model_.bodies.end(), [](const Body& body) {
    return body.eq.level == body::InertiaLevel::full && body.eq.n_s() > 0;
  });
}

body::Motion System::motion(std::size_t b, const State& x) const { return dynamics::motion(model_, b, x); }

body::Motion System::sliding_motion(std::size_t b, const State& x) const {
  body::Motion m = motion(b, x);
  if (sliding_.empty()) return m;
  m.s_dot = sliding_[b];
  m.q_dot.setZero();
  return m;
}

void System::set_sliding(std::vector<Eigen::VectorXd> rates) {
  sliding_ = std::move(rates);
  contact_->forget();
}

void System::turn_bushing(std::size_t i, double angle) { model_.marker_forces.turn_unloaded(i, angle); }

std::vector<MovingBody> System::moving_bodies(const State& x) const {
  return dynamics::moving_bodies(model_, x);
}

contact::SurfaceMotion System::surface_motion(std::size_t b, double time, ConstVector U,
                                              ConstVector V) const {
  const body::Motion m = sliding_motion(b, {time, U, V, V});
  const auto [r_WB, R_WB] = body::placement(model_.bodies[b].eq.joint, m.s);
  const body::FrameMotion frame = body::frame_motion(model_.bodies[b].eq, m);
  return {m.q, r_WB, R_WB, m.q_dot, frame.v, frame.w};
}

const ContactState& System::contacts(double time, ConstVector U, ConstVector V) {
  return contacts(time, U, V, ForceAccuracy::balanced);
}

const ContactState& System::observed_contacts(const State& x) {
  return contacts(x.time, x.U, x.V, ForceAccuracy::observed);
}

const ContactState& System::contacts(double time, ConstVector U, ConstVector V, ForceAccuracy accuracy) {
  if (const ContactState* known = contact_->known(time, U, V, accuracy)) return *known;
  std::vector<contact::SurfaceMotion> motion;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    motion.push_back(surface_motion(b, time, U, V));
    if (contact_->creeps(b)) contact_->set_point(b, relaxation_->moduli(), relaxation_->point(b, time));
  }
  return contact_->evaluate(time, U, V, motion, accuracy);
}

double System::depth_share(double time, ConstVector U, ConstVector V) {
  contacts(time, U, V);
  return contact_->depth_share();
}

const contact::Settings& System::contact_settings(std::size_t pair) const { return contact_->settings(pair); }
const contact::Pair& System::detector(std::size_t pair) const { return contact_->detector(pair); }
bool System::any_augmented() const { return contact_->any_augmented(); }
double System::unclosed() const { return contact_->unclosed(); }
void System::augment() { contact_->augment(); }
void System::stiffen(double factor) { contact_->stiffen(factor); }
void System::set_forces(const std::vector<PairContacts>& pairs) { contact_->set_forces(pairs); }
void System::set_force_tolerance(double unbalanced) { contact_->set_force_tolerance(unbalanced); }
void System::begin_equilibrium_search(double tolerance) { contact_->begin_equilibrium_search(tolerance); }
bool System::release_points() { return contact_->release_points(); }
bool System::change_closed() { return contact_->change_closed(); }
bool System::had_impulse() const { return contact_->had_impulse(); }
bool System::had_impulse_before() const { return contact_->had_impulse_before(); }
double System::contact_loss() const { return contact_->loss(); }
double System::residual_energy(std::size_t b) { return contact_->residual_energy(b); }
double System::residual_loss(std::size_t b) const { return contact_->residual_loss(b); }

void System::begin_step(double dt, double alpha_f) {
  relaxation_->begin_step(dt, alpha_f);
  if (relaxes_in_time()) contact_->forget();
  if (any_augmented()) contact_->begin_step(dt, alpha_f);
}

void System::advance_relaxation(double dt) {
  relaxation_->begin_step(dt, 1);
  contact_->forget();
}

model::RelaxedState System::relaxed_state(std::size_t b) const {
  model::RelaxedState state = relaxation_->relaxed_state(b);
  contact_->get_creep(b, state);
  return state;
}

void System::end_step(bool solved, double delivered) {
  relaxation_->end_step();
  if (any_augmented()) contact_->end_step(solved, delivered);
}

bool System::relaxes_in_time() const {
  return relaxation_->any() && model_.environment.moduli == body::Moduli::relaxing;
}

const body::RelaxationLaw& System::relaxation_law(std::size_t b) const { return relaxation_->law(b); }

Eigen::MatrixXd System::internal_variables(std::size_t b, const State& x) const {
  const Eigen::VectorXd q = motion(b, x).q;
  if (!relaxation_->of(b)) return Eigen::MatrixXd(q.size(), 0);
  return relaxation_->internal_variables(b, x.time, q);
}

void System::accept(const State& x, bool is_observed) {
  contact_->follow_contacts(!is_observed);
  observed_contacts(x);
  contact_->follow_contacts(false);
  contact_->accept();
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) relaxation_->accept(b, x.time, motion(b, x).q);
  relaxation_->close_step();
}

std::vector<MarkerForce> System::at_markers(const State& x) const {
  if (!model_.marker_forces.empty()) return model_.marker_forces.forces(x.time, moving_bodies(x));
  std::vector<MarkerForce> all;
  for (const Body& body : model_.bodies) {
    const body::Force none{Eigen::VectorXd::Zero(body.eq.n_s()), Eigen::VectorXd::Zero(body.eq.n_q())};
    all.push_back({none, none});
  }
  return all;
}

body::Force System::inner_force(std::size_t b, double time, const body::Motion& m) const {
  const body::Equations& eq = model_.bodies[b].eq;
  body::Force force = body::inner_force(eq, m);
  if (!relaxation_->of(b)) return force;
  const Eigen::MatrixXd z = relaxation_->internal_variables(b, time, m.q);
  force.q -= body::relaxed_force(*eq.body, z * relaxation_->law(b).g.transpose());
  return force;
}

body::Force System::balance(std::size_t b, const State& x, const MarkerForce& marker_force, Residual* r) {
  const Body& body = model_.bodies[b];
  const body::Motion m = motion(b, x);
  const body::MotionForces moving = body::motion_forces(body.eq, m, gravity(model_.environment, x.time));
  const body::Force inner = inner_force(b, x.time, m),
                    touch = contact_force(body.eq, observed_contacts(x).force[b]);
  const Eigen::VectorXd loads = load(body, x.time, m);
  const Terms s{{&moving.inertia.s},
                {&moving.quadratic.s, &touch.s, &moving.weight.s, &marker_force.loads.s,
                 &marker_force.bushings.s, &loads}},
      q{{&moving.inertia.q, &inner.q},
        {&moving.quadratic.q, &touch.q, &moving.weight.q, &marker_force.loads.q, &marker_force.bushings.q}};
  const body::Force total{sum(s), sum(q)};
  if (!r) return total;
  r->F.segment(body.first, body.n_open()) = total.s(body.open);
  r->F.segment(body.first + body.n_open(), body.eq.n_q()) = total.q;
  set_norms(*r, 2 * b, s, total.s, &body.open);
  // Teeth on both sides of a planet balance each other.
  if (const Eigen::VectorXd& size = observed_contacts(x).force[b].joint_size; size.size() > 0)
    r->scale[static_cast<Eigen::Index>(2 * b)] =
        std::max(r->scale[static_cast<Eigen::Index>(2 * b)], size(body.open).norm());
  set_norms(*r, 2 * b + 1, q, total.q, nullptr);
  raise_cancelled(*r, 2 * b + 1, observed_contacts(x).force[b], body.row_size);
  return total;
}

Residual System::residual(const State& x) {
  const auto n_blocks = static_cast<Eigen::Index>(2 * model_.bodies.size());
  Residual r{Eigen::VectorXd::Zero(size()), Eigen::VectorXd::Zero(n_blocks), Eigen::VectorXd::Zero(n_blocks)};
  const std::vector<MarkerForce> marker_force = at_markers(x);
  contacts(x.time, x.U, x.V);  // as exact as forces in balance are, for all that follows
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) balance(b, x, marker_force[b], &r);
  raise_vanishing_scales(r);
  return r;
}

Eigen::VectorXd System::joint_force(std::size_t b, const State& x) {
  const Body& body = model_.bodies[b];
  Eigen::VectorXd force = load(body, x.time, motion(b, x));
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
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const body::Equations& eq = model_.bodies[b].eq;
    const body::Motion m = motion(b, x);
    const std::vector<int>& node = contact.force[b].node;
    const body::Motion slides = sliding_motion(b, x);
    const body::JointMotion joint{slides.s, slides.s_dot, slides.s_ddot};
    const body::FrameDerivative d = body::frame_derivative(eq.joint, eq.H, joint, shift);
    twists.push_back({eq.H, body::MotionSubspace(6, eq.n_s()),
                      velocity_twists(eq.joint, eq.H, joint, shift.v), body::frame_motion(eq, slides).w,
                      shift.v});
    twists.back().P << d.r, d.theta;
    matrix.body.push_back(body_terms(body::tangent(eq, m, gravity(model_.environment, x.time), shift),
                                     model_.marker_forces.row_count(b), node));
    matrix.body.back().C.diagonal() += load_stiffness(model_.bodies[b], x.time, m, shift.v);
    add_geometric_stiffness(twists.back(), contact.force[b], matrix.body.back());
    matrix.body.back().R = contact_->flexibility_among(b, node);
    if (relaxation_->of(b)) matrix.body.back().following = relaxation_->following(b, x.time);
  }
  set_contact_columns(twists, contact, matrix);
  if (!model_.marker_forces.empty())
    model_.marker_forces.add_tangent(x.time, moving_bodies(x), shift, matrix);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    add_border_stiffness(body::stiffness_in_border(model_.bodies[b].eq, matrix.body[b].Gamma), b, matrix);
    keep_open(matrix.body[b], model_.bodies[b].open);
  }
  return matrix;
}

bool System::rebase(Eigen::Ref<Eigen::VectorXd> U) {
  bool any = false;
  for (Body& body : model_.bodies) {
    if (!body::has_rotation_vector(body.eq.joint.type)) continue;
    body.eq.joint = body::rebased(body.eq.joint, U.segment(body.first, body.eq.n_s()));
    U.segment<3>(body.first + body.eq.n_s() - 3).setZero();
    any = true;
  }
  if (any) contact_->forget();
  return any;
}

void System::serialize(Archive& archive) {
  for (Body& body : model_.bodies) {
    archive(body.eq.joint.r_WB0);
    archive(body.eq.joint.R_WB0);
  }
  contact_->serialize(archive);
  relaxation_->serialize(archive);
}

}  // namespace elastogear::dynamics
