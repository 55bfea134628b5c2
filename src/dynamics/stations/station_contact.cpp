#include "dynamics/stations/station_contact.h"

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/dynamics/station_choice.h"

namespace elastogear::dynamics {
namespace {

using contact::ToothContact;
using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int kMostRounds = 50;      // of forces and what their friction does to gaps
constexpr double kSettled = 1e-11;   // of the largest force, its last change by that
constexpr double kResisting = 1e-3;  // of the largest resistance to sliding: smaller ones are left out

contact::RelativePlacement relative(const contact::SurfaceMotion& owner, const contact::SurfaceMotion& mate) {
  return {owner.R_WB.transpose() * mate.R_WB, owner.R_WB.transpose() * (mate.r_WB - owner.r_WB)};
}

contact::SurfaceMotion start(const SystemModel& model, std::size_t b) {
  const body::Motion m = motion(model, b, {0, model.U_0, model.V_0, model.V_0});
  const auto [r_WB, R_WB] = body::placement(model.bodies[b].eq.joint, m.s);
  return {m.q, r_WB, R_WB};
}

// Flanks of which no node, or not all, has static responses to loads on it.
std::vector<contact::FlankName> stiff_flanks(const model::Flexibility& flexibility,
                                             const contact::ToothedBody& toothed) {
  std::vector<contact::FlankName> stiff;
  const auto lacks = [&](int node) { return model::find_loaded(flexibility, node) < 0; };
  for (const contact::FlankName& flank : toothed.flank_names())
    if (std::ranges::any_of(toothed.nodes(flank), lacks)) stiff.push_back(flank);
  return stiff;
}

// The columns of the stations that carry a force.
Sparse columns(const Sparse& S, const std::vector<int>& of) {
  Sparse part(S.rows(), std::ssize(of));
  part.reserve(S.nonZeros());
  for (Index k = 0; int i : of) {
    part.startVec(k);
    for (Sparse::InnerIterator at(S, i); at; ++at) part.insertBack(at.row(), k) = at.value();
    ++k;
  }
  part.finalize();
  return part;
}

// n_q x n: nodal forces on elastic coordinates.
MatrixXd on_coordinates(const model::ElasticBody& body, const std::vector<int>& node, const Sparse& S) {
  MatrixXd Phi_S = MatrixXd::Zero(body.n_q(), S.cols());
  if (body.n_q() == 0) return Phi_S;
  for (Index i = 0; i < S.cols(); ++i)
    for (Sparse::InnerIterator at(S, i); at; ++at) {
      const double* rows = model::node_rows(body.surface.Phi, node[static_cast<std::size_t>(at.row() / 3)]);
      Phi_S.col(i) += at.value() * VectorXd::Map(rows + at.row() % 3 * body.n_q(), body.n_q());
    }
  return Phi_S;
}

// Twist of the mate against the owner, in the owner's frame, by a joint coordinate of one of them.
Eigen::Matrix<double, 6, 1> relative_twist(const contact::RelativePlacement& placement, bool of_owner,
                                           const Eigen::Matrix<double, 6, 1>& H) {
  if (of_owner) return -H;
  Eigen::Matrix<double, 6, 1> twist;
  twist.tail<3>() = placement.R * H.tail<3>();
  twist.head<3>() = placement.R * H.head<3>() - twist.tail<3>().cross(placement.r);
  return twist;
}

// m, of the strips on one side, in its body's frame.
Matrix3Xd points(const ToothContact& contact, std::size_t s) {
  Matrix3Xd x(3, contact.n_strips());
  for (Index i = 0; i < x.cols(); ++i) {
    const contact::NearestPlace& place = contact.strip_place(i);
    x.col(i) = contact.flanks.owner->point(contact.flanks.on_owner, place.v, place.face.centre()).x;
    if (s == 1) x.col(i) = contact.placement.R.transpose() * (x.col(i) - contact.placement.r);
  }
  return x;
}

}  // namespace

StationContact::StationContact(const SystemModel& model) : model_(&model) {
  for (const SystemModel::Body& body : model.bodies) add_body(body);
  for (const PairSetup& pair : model.pairs) {
    const auto a = static_cast<std::size_t>(pair.body[0]), b = static_cast<std::size_t>(pair.body[1]);
    const bool turned = bodies_[b].toothed->flanks().is_hobbed();  // stations stand on the hobbed wheel
    const std::size_t owner = turned ? b : a, mate = turned ? a : b;
    pairs_.push_back({{owner, mate},
                      turned ? 1 : 0,
                      pair.settings.offset,
                      pair.settings.friction,
                      contact::toothed_pair(*bodies_[owner].toothed, *bodies_[mate].toothed,
                                            relative(start(model, owner), start(model, mate)), kStrips)});
    for (std::size_t body : {a, b})
      bodies_[body].by_nodes = bodies_[body].by_nodes || pairs_.back().toothed.is_crossed;
  }
}

void StationContact::add_body(const SystemModel::Body& body) {
  bodies_.emplace_back();
  if (!body.in_contact) return;
  const double compliance = is_rigid(body) ? 0 : body.surface_compliance / std::numbers::pi;
  bodies_.back().toothed = std::make_unique<contact::ToothedBody>(
      body.eq.body->surface, body.true_surface->flanks, compliance, body.true_surface->deviation);
  if (is_rigid(body)) return;
  bodies_.back().tables = std::make_unique<ResponseTables>(*body.eq.body, *bodies_.back().toothed);
  bodies_.back().stiff = stiff_flanks(body.eq.body->flexibility, *bodies_.back().toothed);
}

// Are both bodies reduced for loads on these flanks? Throws Error where they are not and the flanks touch.
bool StationContact::has_responses(const Pair& pair, const ToothContact& contact) const {
  for (std::size_t s : {0, 1}) {
    const std::vector<contact::FlankName>& stiff = bodies_[pair.body[s]].stiff;
    if (std::ranges::find(stiff, contact.side[s].flank) == stiff.end()) continue;
    require(contact.gap.minCoeff() + pair.offset >= 0, "body '", model_->bodies[pair.body[s]].name,
            "' touches with a flank of tooth ", contact.side[s].flank.tooth + 1,
            " for loads on which it was not reduced; reduce it anew with -loaded flanks");
    return false;
  }
  return true;
}

std::vector<StationContact::Teeth> StationContact::teeth_in_contact(const Motions& motion) const {
  std::vector<Teeth> teeth;
  Index n = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (ToothContact& contact : contact::tooth_contacts(
             pairs_[p].toothed, relative(motion[pairs_[p].body[0]], motion[pairs_[p].body[1]]))) {
      if (!has_responses(pairs_[p], contact)) continue;
      teeth.push_back({p, std::move(contact), n});
      n += teeth.back().contact.n();
      if (pairs_[p].friction.mu > 0) set_traction(motion, teeth.back());
    }
  return teeth;
}

Matrix3Xd StationContact::node_displacements(const Part& part, std::size_t body, const VectorXd& q) const {
  const std::vector<int>& node = contact::loaded_nodes(part.side());
  Matrix3Xd u(3, std::ssize(node));
  for (Index a = 0; a < u.cols(); ++a)
    u.col(a) =
        model::displacement(bodies_[body].toothed->surface().Phi, node[static_cast<std::size_t>(a)], q);
  return u;
}

// Regularised friction -mu p v_t / sqrt(v_t^2 + v_0^2) of each strip. Eq. (6.17).
void StationContact::set_traction(const Motions& motion, Teeth& teeth) const {
  const Pair& pair = pairs_[teeth.pair];
  const ToothContact& contact = teeth.contact;
  std::array<Matrix3Xd, 2> v;  // m/s, of each body, in its frame
  for (std::size_t s : {0, 1}) {
    const contact::SurfaceMotion& m = motion[pair.body[s]];
    v[s] = points(contact, s);
    for (Index i = 0; i < v[s].cols(); ++i)
      v[s].col(i) = m.v_WB_B + m.w_WB_B.cross(Eigen::Vector3d(v[s].col(i)));
    if (m.q_dot.size() == 0 || m.q_dot.isZero(0)) continue;
    const ToothContact::Side& side = contact.side[s];
    v[s] += contact::displacements(side, node_displacements({&teeth, s}, pair.body[s], m.q_dot));
  }
  teeth.sliding = v[0] - contact.placement.R * v[1];
  teeth.traction[0].resize(3, contact.n_strips());
  teeth.resistance.resize(contact.n_strips());
  for (Index i = 0; i < contact.n_strips(); ++i) {
    const Eigen::Vector3d n = contact.strip_place(i).n.normalized();
    teeth.sliding.col(i) -= n * n.dot(teeth.sliding.col(i));
    const double v_0 = pair.friction.v_0, speed = std::hypot(teeth.sliding.col(i).norm(), v_0);
    teeth.traction[0].col(i) = -pair.friction.mu / speed * teeth.sliding.col(i);
    teeth.resistance[i] = pair.friction.mu * v_0 * v_0 / (speed * speed * speed);
  }
  teeth.traction[1] = -(contact.placement.R.transpose() * teeth.traction[0]);
}

std::vector<StationContact::Part> StationContact::parts_of(std::size_t body,
                                                           const std::vector<Teeth>& teeth) const {
  std::vector<Part> parts;
  for (const Teeth& t : teeth)
    for (std::size_t s : {0, 1})
      if (pairs_[t.pair].body[s] == body) parts.push_back({&t, s});
  return parts;
}

// Station i loads all strips k, Z_ik W_k d_k. Eq. (6.45).
StationContact::Loads StationContact::loads_on(std::size_t body, const std::vector<Teeth>& teeth,
                                               Index n) const {
  Loads loads;
  const std::vector<Part> parts = parts_of(body, teeth);
  std::vector<MatrixXd> weight;
  for (const Part& part : parts) {
    weight.push_back(contact::weights(part.side()));
    const std::vector<int>& node = contact::loaded_nodes(part.side());
    for (std::size_t a = 0; a < node.size(); ++a)
      if (!weight.back().col(static_cast<Index>(a)).isZero(0)) loads.node.push_back(node[a]);
  }
  sort_unique(loads.node);
  std::array<std::vector<Eigen::Triplet<double>>, 2> entries;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const ToothContact::Side& side = parts[p].side();
    const std::vector<int>& node = contact::loaded_nodes(side);
    const MatrixXd Z = contact::spread(side);
    const std::array<const Matrix3Xd*, 2> direction{&side.direction, &parts[p].teeth->traction[parts[p].s]};
    for (Index a = 0; a < weight[p].cols(); ++a) {
      if (weight[p].col(a).isZero(0)) continue;
      const auto at =
          std::lower_bound(loads.node.begin(), loads.node.end(), node[static_cast<std::size_t>(a)]);
      const auto row = static_cast<int>(3 * (at - loads.node.begin()));
      for (std::size_t kind : {0, 1}) {
        if (direction[kind]->cols() == 0) continue;
        const Matrix3Xd forces = *direction[kind] * weight[p].col(a).asDiagonal() * Z.transpose();
        for (Index i = 0; i < forces.cols(); ++i)
          for (int d = 0; d < 3; ++d)
            if (forces(d, i) != 0)
              entries[kind].emplace_back(row + d, static_cast<int>(parts[p].teeth->first + i), forces(d, i));
      }
    }
  }
  const model::ElasticBody& elastic = *model_->bodies[body].eq.body;
  for (std::size_t kind : {0, 1}) {
    Sparse& S = kind == 0 ? loads.S : loads.S_t;
    S.resize(3 * std::ssize(loads.node), n);
    S.setFromTriplets(entries[kind].begin(), entries[kind].end());
  }
  loads.Phi_S = on_coordinates(elastic, loads.node, loads.S);
  if (!entries[1].empty()) loads.Phi_S_t = on_coordinates(elastic, loads.node, loads.S_t);
  return loads;
}

// Of the whole body, without what its modes have a share in: R = F - Phi K_r^-1 Phi'. Eqs. (6.20), (6.39).
// of_friction: of gaps, by the friction that comes with normal forces.
// A body that touches at points has them by nodes, of which few are loaded at a time.
MatrixXd StationContact::compliance(std::size_t body, const std::vector<Teeth>& teeth, const Loads& loads,
                                    bool of_friction, ResidualContact& responses) {
  MatrixXd C = MatrixXd::Zero(loads.S.cols(), loads.S.cols());
  if (!bodies_[body].tables) return C;
  if (bodies_[body].by_nodes) {
    const Sparse& S = of_friction ? loads.S_t : loads.S;
    if (S.nonZeros() > 0) C = loads.S.transpose() * MatrixXd(responses.among(body, loads.node) * S);
    return C;
  }
  const VectorXd K = model_->bodies[body].eq.body->K_r.diagonal();
  const MatrixXd& Phi_S = of_friction ? loads.Phi_S_t : loads.Phi_S;
  if (Phi_S.cols() == 0) return C;
  const std::vector<Part> parts = parts_of(body, teeth);
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t l = 0; l < parts.size(); ++l) {
      if (!of_friction && l > k) continue;  // symmetric
      const Matrix3Xd& force = of_friction ? parts[l].teeth->traction[parts[l].s] : parts[l].side().direction;
      if (force.cols() == 0) continue;
      const MatrixXd F = bodies_[body].tables->responses(parts[k].side(), parts[l].side(), force);
      const Index row = parts[k].teeth->first, column = parts[l].teeth->first;
      C.block(row, column, F.rows(), F.cols()) += F;
      if (!of_friction && l < k) C.block(column, row, F.cols(), F.rows()) += F.transpose();
    }
  C.noalias() -= loads.Phi_S.transpose() * (K.cwiseInverse().asDiagonal() * Phi_S);
  return of_friction ? C : MatrixXd((C + C.transpose()) / 2);
}

// Forces of stations; those with friction by substitution of what it does to gaps, which is small. Eq.
// (6.52).
StationContact::Solution StationContact::solve(const Motions& motion, const std::vector<Teeth>& teeth,
                                               const std::vector<Loads>& loads, Index n,
                                               ResidualContact& responses) {
  contact::StationProblem problem{MatrixXd::Zero(n, n), {}, VectorXd(n)};
  for (const Teeth& t : teeth) {
    problem.C.block(t.first, t.first, t.contact.n(), t.contact.n()) = t.contact.local;
    problem.gap.segment(t.first, t.contact.n()) = t.contact.gap.array() + pairs_[t.pair].offset;
    problem.own.insert(problem.own.end(), t.contact.own.begin(), t.contact.own.end());
  }
  const MatrixXd local = problem.C;
  MatrixXd C_t = MatrixXd::Zero(n, n);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].toothed) continue;
    problem.gap += loads[b].Phi_S.transpose() * motion[b].q;
    problem.C += compliance(b, teeth, loads[b], false, responses);
    C_t += compliance(b, teeth, loads[b], true, responses);
  }
  const VectorXd gap = problem.gap;
  Solution solution{contact::station_forces(problem), {}};
  const bool rubs = !C_t.isZero(0);
  for (int round = 0; rubs && round < kMostRounds; ++round) {
    const VectorXd before = solution.forces.f;
    problem.gap = gap + C_t * before;
    solution.forces = contact::station_forces(problem);
    const VectorXd& f = solution.forces.f;
    if ((f - before).cwiseAbs().maxCoeff() <= kSettled * f.cwiseAbs().maxCoeff()) break;
  }
  const contact::StationForces& forces = solution.forces;
  solution.stiffness = forces.stiffness;
  if (rubs && !forces.active.empty()) {
    const MatrixXd C_t_A = C_t(forces.active, forces.active);
    const auto size = std::ssize(forces.active);
    solution.stiffness =
        (MatrixXd::Identity(size, size) + forces.stiffness * C_t_A).partialPivLu().solve(forces.stiffness);
  }
  solution.local_energy = 0.5 * forces.f.dot(local * forces.f);
  for (Index i = 0; i < n; ++i) {  // the energy of a strip, whose complement is U
    const contact::StationLaw& law = problem.own[static_cast<std::size_t>(i)];
    solution.local_energy += forces.f[i] * law.approach(forces.f[i]) - law.energy(forces.f[i]);
  }
  return solution;
}

// Displacements at the stations on one body, by elastic coordinates and static responses. q: elastic
// coordinates less the share of the modes in F.
contact::StationDisplacements StationContact::moved(const Part& part, std::size_t body,
                                                    const std::vector<Teeth>& teeth, const VectorXd& q,
                                                    const VectorXd& f) {
  const ToothContact::Side& side = part.side();
  contact::StationDisplacements moved =
      contact::displacements(*side.loads, side.at, node_displacements(part, body, q));
  if (!bodies_[body].tables) return moved;
  for (const Part& other : parts_of(body, teeth)) {
    const ToothContact::Side& there = other.side();
    const VectorXd strip =
        contact::spread(there).transpose() * f.segment(other.teeth->first, other.teeth->contact.n());
    Matrix3Xd force = there.direction;
    if (const Matrix3Xd& traction = other.teeth->traction[other.s]; traction.cols() > 0) force += traction;
    bodies_[body].tables->add(side, there, force * strip.asDiagonal(), moved);
  }
  return moved;
}

// m, of the loaded nodes, by elastic coordinates and by the static responses that are in place.
Matrix3Xd StationContact::moved_nodes(const Part& part, std::size_t body, const VectorXd& q,
                                      ResidualContact& responses) const {
  Matrix3Xd u = node_displacements(part, body, q);
  if (!bodies_[body].tables) return u;
  for (Index a = 0; int node : contact::loaded_nodes(part.side()))
    u.col(a++) += responses.displacement(body, node);
  return u;
}

// Derivatives of the potential with places and directions on one body.
contact::PotentialSlopes StationContact::slopes(const Part& part, std::size_t body,
                                                const contact::StationDisplacements& moved,
                                                const VectorXd& f) const {
  const ToothContact::Side& side = part.side();
  const VectorXd strip =
      contact::spread(side).transpose() * f.segment(part.teeth->first, part.teeth->contact.n());
  const double compliance = bodies_[body].toothed->compliance();
  const auto along = [&](const Matrix3Xd& u) {
    return VectorXd(u.cwiseProduct(side.direction).colwise().sum().transpose());
  };
  contact::PotentialSlopes slopes{along(moved.u_v), moved.u * strip.asDiagonal()};
  slopes.v -= compliance * contact::smooth_slopes(*side.loads, side.at, strip);
  slopes.v = slopes.v.cwiseProduct(strip).eval();
  for (Index i = 0; i < slopes.v.size(); ++i)
    if (side.is_clamped(i)) slopes.v[i] = 0;
  return slopes;
}

// Derivatives of the potential with joint coordinates, as gaps, places and directions of stations change at
// the same elastic coordinates and forces, Eq. (6.49), and the friction on them.
void StationContact::add_joint_forces(const Motions& motion, const std::vector<Teeth>& teeth,
                                      const std::vector<Loads>& loads, const VectorXd& f,
                                      ResidualContact& responses, ContactState& state) {
  std::vector<VectorXd> q(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].toothed) continue;
    state.force[b].joint = state.force[b].joint_size = VectorXd::Zero(model_->bodies[b].eq.n_s());
    VectorXd on_modes = loads[b].Phi_S * f;
    if (loads[b].Phi_S_t.cols() > 0) on_modes += loads[b].Phi_S_t * f;
    q[b] = motion[b].q - on_modes.cwiseQuotient(model_->bodies[b].eq.body->K_r.diagonal());
  }
  for (const Teeth& t : teeth) {
    const VectorXd f_t = f.segment(t.first, t.contact.n());
    if (f_t.isZero(0)) continue;
    const std::array<std::size_t, 2>& body = pairs_[t.pair].body;
    std::array<Matrix3Xd, 2> of_nodes;
    std::array<contact::PotentialSlopes, 2> slope;
    for (std::size_t s : {0, 1}) {
      const std::size_t b = body[s];
      const Part part{&t, s};
      if (bodies_[b].by_nodes) of_nodes[s] = moved_nodes(part, b, motion[b].q, responses);
      if (t.contact.is_moving()) continue;
      const auto& side = part.side();
      slope[s] = slopes(part, b,
                        bodies_[b].by_nodes ? contact::displacements(*side.loads, side.at, of_nodes[s])
                                            : moved(part, b, teeth, q[b], f),
                        f);
    }
    const auto change = [&](const Eigen::Matrix<double, 6, 1>& twist) {
      return t.contact.is_moving() ? contact::change_of_potential(t.contact, f_t, of_nodes, twist)
                                   : contact::change_of_potential(t.contact, f_t, slope, twist);
    };
    for (std::size_t s : {0, 1}) {
      const body::MotionSubspace& H = model_->bodies[body[s]].eq.H;
      Eigen::Matrix<double, 6, 1> friction = Eigen::Matrix<double, 6, 1>::Zero();
      if (t.traction[s].cols() > 0) {
        const Matrix3Xd force =
            t.traction[s] * VectorXd(contact::spread(t.contact.side[s]).transpose() * f_t).asDiagonal();
        const Matrix3Xd x = points(t.contact, s);
        friction.head<3>() = force.rowwise().sum();
        for (Index i = 0; i < x.cols(); ++i) friction.tail<3>() += x.col(i).cross(force.col(i));
      }
      for (Index i = 0; i < H.cols(); ++i) {
        const double force =
            change(relative_twist(t.contact.placement, s == 0, H.col(i))) + H.col(i).dot(friction);
        state.force[body[s]].joint[i] += force;
        state.force[body[s]].joint_size[i] += std::abs(force);
      }
    }
  }
}

void StationContact::set_nodal_forces(std::size_t body, const Loads& loads, const VectorXd& f,
                                      const contact::SurfaceMotion& motion, ResidualContact& responses,
                                      ContactState& state) const {
  NodalForces& nodal = state.force[body];
  const auto n = std::ssize(loads.node);
  nodal.node = loads.node;
  nodal.f_B = VectorXd(loads.S * f).reshaped(3, n);
  nodal.x_B.resize(3, n);
  if (!bodies_[body].toothed) return;
  const model::Surface& surface = bodies_[body].toothed->surface();
  for (Index i = 0; int node : nodal.node) {
    nodal.x_B.col(i++) = surface.X.col(node);
    state.surface[body].x_B.col(node) =
        surface.X.col(node) + model::displacement(surface.Phi, node, motion.q);
  }
  if (!state.stations.friction.empty()) {
    state.stations.friction[body] = {nodal.node, nodal.x_B, VectorXd(loads.S_t * f).reshaped(3, n)};
    nodal.f_B += state.stations.friction[body].f_B;
  }
  responses.respond(body, nodal);
}

// Forces of the stations in contact, and columns along which friction changes with sliding speeds.
void StationContact::set_loads(const std::vector<Teeth>& teeth, const std::vector<Loads>& loads,
                               const Solution& solution, ContactState& state) const {
  const contact::StationForces& forces = solution.forces;
  StationLoads& stations = state.stations = {};
  stations.f = forces.f(forces.active);
  stations.K = solution.stiffness;
  stations.potential = forces.potential;
  stations.local_energy = solution.local_energy;
  for (const Loads& of_body : loads) stations.body.push_back(columns(of_body.S, forces.active));
  const auto rubs = [](const Teeth& t) { return t.traction[0].cols() > 0; };
  if (std::none_of(teeth.begin(), teeth.end(), rubs)) return;
  stations.friction.resize(loads.size());
  std::vector<double> resistance;
  std::vector<std::vector<Eigen::Triplet<double>>> entries(loads.size());
  double largest = 0;
  for (const Teeth& t : teeth)
    if (rubs(t)) largest = std::max(largest, t.resistance.maxCoeff());
  for (const Teeth& t : teeth) {
    if (!rubs(t)) continue;
    const VectorXd strip =
        contact::spread(t.contact.side[0]).transpose() * forces.f.segment(t.first, t.contact.n());
    for (Index k = 0; k < strip.size(); ++k) {
      if (!(strip[k] > 0) || t.resistance[k] < kResisting * largest) continue;
      for (std::size_t s : {0, 1}) {
        const ToothContact::Side& side = t.contact.side[s];
        const std::size_t b = pairs_[t.pair].body[s];
        const contact::NearestPlace& place = t.contact.strip_place(k);
        Eigen::Vector3d along =
            t.contact.flanks.owner->point(t.contact.flanks.on_owner, place.v, place.face.centre()).x_v;
        if (s == 1) along = -(t.contact.placement.R.transpose() * along);
        const std::vector<int>& node = contact::loaded_nodes(side);
        const Eigen::RowVectorXd weight = contact::weights(side).row(k);
        for (Index a = 0; a < weight.size(); ++a) {
          if (weight[a] == 0) continue;
          const auto row = std::lower_bound(loads[b].node.begin(), loads[b].node.end(),
                                            node[static_cast<std::size_t>(a)]) -
                           loads[b].node.begin();
          for (int d = 0; d < 3; ++d)
            entries[b].emplace_back(static_cast<int>(3 * row) + d, static_cast<int>(resistance.size()),
                                    weight[a] * along[d]);
        }
      }
      resistance.push_back(t.resistance[k] * strip[k]);
    }
  }
  stations.resistance = VectorXd::Map(resistance.data(), std::ssize(resistance));
  for (std::size_t b = 0; b < loads.size(); ++b) {
    stations.with_friction.push_back(columns(loads[b].S + loads[b].S_t, forces.active));
    stations.sliding.emplace_back(loads[b].S.rows(), stations.resistance.size());
    stations.sliding.back().setFromTriplets(entries[b].begin(), entries[b].end());
  }
}

void StationContact::set_points(const Motions& motion, const std::vector<Teeth>& teeth, const VectorXd& f,
                                ContactState& state) const {
  state.pair.clear();
  for (const Pair& pair : pairs_) {
    const auto owner = static_cast<int>(pair.body[0]), mate = static_cast<int>(pair.body[1]);
    state.pair.push_back({{pair.owner == 0 ? owner : mate, pair.owner == 0 ? mate : owner}, {}});
  }
  for (const Teeth& t : teeth) {
    const Pair& pair = pairs_[t.pair];
    const Eigen::Matrix3d& R_WB = motion[pair.body[0]].R_WB;
    for (Index i = 0; i < t.contact.n(); ++i) {
      const double f_i = f[t.first + i];
      if (!(f_i > 0)) continue;
      state.pair[t.pair].points.push_back(
          contact::station_point(t.contact, pair.toothed, i, f_i, {R_WB, motion[pair.body[0]].r_WB}));
      state.pair[t.pair].points.back().slave_side = pair.owner;
      if (t.traction[0].cols() == 0) continue;
      contact::ContactPoint& point = state.pair[t.pair].points.back();
      const Eigen::Vector3d friction = f_i * (R_WB * t.traction[0].col(t.contact.strip_of(i)));
      point.f += friction;
      for (Index k = 0; k < 4; ++k) {
        point.F.col(k) += point.slave_N[k] * friction;
        point.F.col(4 + k) -= point.N[k] * friction;
      }
      point.slip = R_WB * t.sliding.col(t.contact.strip_of(i));
      point.friction_power = -friction.dot(point.slip);
    }
  }
}

void StationContact::evaluate(const Motions& motion, ResidualContact& responses, ContactState& state) {
  const std::vector<Teeth> teeth = teeth_in_contact(motion);
  const Index n = teeth.empty() ? 0 : teeth.back().first + teeth.back().contact.n();
  std::vector<Loads> loads(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].toothed)
      loads[b] = loads_on(b, teeth, n);
    else
      for (Sparse* S : {&loads[b].S, &loads[b].S_t}) S->resize(0, n);
  }
  const Solution solution = solve(motion, teeth, loads, n, responses);
  const VectorXd& f = solution.forces.f;
  set_loads(teeth, loads, solution, state);
  state.force.assign(bodies_.size(), {});
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    set_nodal_forces(b, loads[b], f, motion[b], responses, state);
  add_joint_forces(motion, teeth, loads, f, responses, state);
  set_points(motion, teeth, f, state);
  state.balanced = true;
}

}  // namespace elastogear::dynamics
