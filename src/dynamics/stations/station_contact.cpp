#include "dynamics/stations/station_contact.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::dynamics {
namespace {

using contact::ToothContact;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStations = 16;  // of a pair of teeth

contact::RelativePlacement relative(const contact::SurfaceMotion& owner, const contact::SurfaceMotion& mate) {
  return {owner.R_WB.transpose() * mate.R_WB, owner.R_WB.transpose() * (mate.r_WB - owner.r_WB)};
}

contact::SurfaceMotion start(const SystemModel& model, std::size_t b) {
  const body::Motion m = motion(model, b, {0, model.U_0, model.V_0, model.V_0});
  const auto [r_WB, R_WB] = body::placement(model.bodies[b].eq.joint, m.s);
  return {m.q, r_WB, R_WB};
}

// The columns of the stations that bear a force.
Eigen::SparseMatrix<double> columns(const Eigen::SparseMatrix<double>& S, const std::vector<int>& of) {
  Eigen::SparseMatrix<double> part(S.rows(), std::ssize(of));
  part.reserve(S.nonZeros());
  for (Index k = 0; int i : of) {
    part.startVec(k);
    for (Eigen::SparseMatrix<double>::InnerIterator at(S, i); at; ++at)
      part.insertBack(at.row(), k) = at.value();
    ++k;
  }
  part.finalize();
  return part;
}

}  // namespace

StationContact::StationContact(const SystemModel& model) : model_(&model) {
  for (const SystemModel::Body& body : model.bodies) add_body(body);
  for (const PairSetup& pair : model.pairs) {
    const auto a = static_cast<std::size_t>(pair.body[0]), b = static_cast<std::size_t>(pair.body[1]);
    pairs_.push_back({{a, b},
                      pair.settings.offset,
                      contact::toothed_pair(*bodies_[a].toothed, *bodies_[b].toothed,
                                            relative(start(model, a), start(model, b)), kStations)});
  }
}

void StationContact::add_body(const SystemModel::Body& body) {
  bodies_.emplace_back();
  if (!body.in_contact) return;
  bodies_.back().toothed = std::make_unique<contact::ToothedBody>(
      body.eq.body->surface, body.true_surface->flanks, body.surface_compliance / std::numbers::pi,
      body.true_surface->deviation);
  bodies_.back().tables = std::make_unique<ResponseTables>(*body.eq.body, *bodies_.back().toothed);
}

std::vector<StationContact::Teeth> StationContact::teeth_in_contact(
    const std::vector<contact::SurfaceMotion>& motion) const {
  std::vector<Teeth> teeth;
  Index n = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (ToothContact& contact : contact::tooth_contacts(
             pairs_[p].toothed, relative(motion[pairs_[p].body[0]], motion[pairs_[p].body[1]]))) {
      teeth.push_back({p, std::move(contact), n});
      n += teeth.back().contact.n();
    }
  return teeth;
}

StationContact::Loads StationContact::loads_on(std::size_t body, const std::vector<Teeth>& teeth,
                                               Index n) const {
  struct Part {
    const ToothContact::Side& side;
    Index first;
    MatrixXd weight;
  };
  Loads loads;
  std::vector<Part> parts;
  for (const Teeth& t : teeth)
    for (std::size_t s : {0, 1})
      if (pairs_[t.pair].body[s] == body) {
        const ToothContact::Side& side = t.contact.side[s];
        parts.push_back({side, t.first, contact::weights(*side.loads, side.at)});
      }
  for (const Part& part : parts) {
    const std::vector<int>& node = bodies_[body].toothed->nodes(part.side.flank);
    for (std::size_t a = 0; a < node.size(); ++a)
      if (!part.weight.col(static_cast<Index>(a)).isZero(0)) loads.node.push_back(node[a]);
  }
  sort_unique(loads.node);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Part& part : parts) {
    const std::vector<int>& node = bodies_[body].toothed->nodes(part.side.flank);
    for (Index a = 0; a < part.weight.cols(); ++a) {
      if (part.weight.col(a).isZero(0)) continue;
      const auto at =
          std::lower_bound(loads.node.begin(), loads.node.end(), node[static_cast<std::size_t>(a)]);
      const auto row = static_cast<int>(3 * (at - loads.node.begin()));
      for (Index i = 0; i < part.weight.rows(); ++i)
        for (int d = 0; d < 3 && part.weight(i, a) != 0; ++d)
          entries.emplace_back(row + d, static_cast<int>(part.first + i),
                               part.weight(i, a) * part.side.direction(d, i));
    }
  }
  loads.S.resize(3 * std::ssize(loads.node), n);
  loads.S.setFromTriplets(entries.begin(), entries.end());
  const model::ElasticBody& elastic = *model_->bodies[body].eq.body;
  loads.Phi_S = MatrixXd::Zero(elastic.n_q(), n);
  for (Index i = 0; i < n; ++i)
    for (Eigen::SparseMatrix<double>::InnerIterator at(loads.S, i); at; ++at)
      loads.Phi_S.col(i) +=
          at.value() * VectorXd::Map(model::node_rows(elastic.surface.Phi,
                                                      loads.node[static_cast<std::size_t>(at.row() / 3)]) +
                                         at.row() % 3 * elastic.n_q(),
                                     elastic.n_q());
  return loads;
}

// Of the whole body, without what its modes have a share in: R = F - Phi K_r^-1 Phi'. Eqs. (6.20), (6.39).
void StationContact::add_compliance(std::size_t body, const std::vector<Teeth>& teeth, const Loads& loads,
                                    MatrixXd& C) {
  for (std::size_t k = 0; k < teeth.size(); ++k)
    for (std::size_t l = 0; l <= k; ++l)
      for (std::size_t s : {0, 1})
        for (std::size_t r : {0, 1}) {
          const Teeth &a = teeth[k], &b = teeth[l];
          if (pairs_[a.pair].body[s] != body || pairs_[b.pair].body[r] != body) continue;
          const MatrixXd F = bodies_[body].tables->responses(a.contact.side[s], b.contact.side[r]);
          C.block(a.first, b.first, F.rows(), F.cols()) += F;
          if (k != l) C.block(b.first, a.first, F.cols(), F.rows()) += F.transpose();
        }
  const VectorXd K = model_->bodies[body].eq.body->K_r.diagonal();
  C.noalias() -= loads.Phi_S.transpose() * (K.cwiseInverse().asDiagonal() * loads.Phi_S);
}

void StationContact::set_nodal_forces(std::size_t body, const Loads& loads,
                                      const contact::StationForces& forces,
                                      const contact::SurfaceMotion& motion, ResidualContact& responses,
                                      ContactState& state) const {
  NodalForces& nodal = state.force[body];
  const auto n = std::ssize(loads.node);
  nodal.node = loads.node;
  nodal.f_B = VectorXd(loads.S * forces.f).reshaped(3, n);
  nodal.x_B.resize(3, n);
  if (!bodies_[body].toothed) return;
  responses.respond(body, nodal);
  const model::Surface& surface = bodies_[body].toothed->surface();
  for (Index i = 0; int node : nodal.node) {
    nodal.x_B.col(i) = surface.X.col(node);
    state.surface[body].x_B.col(node) = nodal.x_B.col(i++);
  }
  state.stations.body[body] = columns(loads.S, forces.active);
}

namespace {

// Twist of the mate against the owner, in the owner's frame, by a joint coordinate of one of them.
Eigen::Matrix<double, 6, 1> relative_twist(const contact::RelativePlacement& placement, bool of_owner,
                                           const Eigen::Matrix<double, 6, 1>& H) {
  if (of_owner) return -H;
  Eigen::Matrix<double, 6, 1> twist;
  twist.tail<3>() = placement.R * H.tail<3>();
  twist.head<3>() = placement.R * H.head<3>() - twist.tail<3>().cross(placement.r);
  return twist;
}

}  // namespace

// Derivatives of the potential with joint coordinates, as the places of stations move at the same
// elastic coordinates and forces. Eq. (6.49).
void StationContact::add_joint_forces(const std::vector<contact::SurfaceMotion>& motion,
                                      const std::vector<Teeth>& teeth, const std::vector<Loads>& loads,
                                      const VectorXd& f, ContactState& state) {
  std::vector<VectorXd> q(bodies_.size());  // of elastic coordinates less the share of the modes in F
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].toothed) continue;
    state.force[b].joint = VectorXd::Zero(model_->bodies[b].eq.n_s());
    q[b] = motion[b].q - (loads[b].Phi_S * f).cwiseQuotient(model_->bodies[b].eq.body->K_r.diagonal());
  }
  for (const Teeth& t : teeth) {
    const VectorXd f_t = f.segment(t.first, t.contact.n());
    if (f_t.isZero(0)) continue;
    std::array<contact::PotentialSlopes, 2> slope;
    for (std::size_t s : {0, 1}) {
      const std::size_t b = pairs_[t.pair].body[s];
      const ToothContact::Side& side = t.contact.side[s];
      const std::vector<int>& node = bodies_[b].toothed->nodes(side.flank);
      const model::Surface& surface = bodies_[b].toothed->surface();
      Eigen::Matrix3Xd u(3, std::ssize(node));
      for (Index a = 0; a < u.cols(); ++a)
        u.col(a) = model::displacement(surface.Phi, node[static_cast<std::size_t>(a)], q[b]);
      const VectorXd strip_force = side.loads->Z.transpose() * f_t;
      contact::StationDisplacements moved = contact::displacements(*side.loads, side.at, u);
      for (const Teeth& other : teeth)
        for (std::size_t r : {0, 1}) {
          if (pairs_[other.pair].body[r] != b) continue;
          const ToothContact::Side& there = other.contact.side[r];
          bodies_[b].tables->add(
              side, there, there.loads->Z.transpose() * f.segment(other.first, other.contact.n()), moved);
        }
      slope[s].v =
          moved.u_v.cwiseProduct(side.direction).colwise().sum().transpose() -
          bodies_[b].toothed->compliance() * contact::smooth_slopes(*side.loads, side.at, strip_force);
      slope[s].v = slope[s].v.cwiseProduct(strip_force).eval();
      slope[s].direction = moved.u * strip_force.asDiagonal();
      for (Index i = 0; i < slope[s].v.size(); ++i)
        if (side.is_clamped(i)) slope[s].v[i] = 0;
    }
    for (std::size_t s : {0, 1}) {
      const std::size_t b = pairs_[t.pair].body[s];
      const body::MotionSubspace& H = model_->bodies[b].eq.H;
      for (Index i = 0; i < H.cols(); ++i)
        state.force[b].joint[i] += contact::change_of_potential(
            t.contact, f_t, slope, relative_twist(t.contact.placement, s == 0, H.col(i)));
    }
  }
}

void StationContact::evaluate(const std::vector<contact::SurfaceMotion>& motion, ResidualContact& responses,
                              ContactState& state) {
  std::vector<Teeth> teeth = teeth_in_contact(motion);
  const Index n = teeth.empty() ? 0 : teeth.back().first + teeth.back().contact.n();
  contact::StationProblem problem{MatrixXd::Zero(n, n),
                                  std::vector<contact::StripLaw>(static_cast<std::size_t>(n)), VectorXd(n)};
  for (const Teeth& t : teeth) {
    problem.C.block(t.first, t.first, t.contact.n(), t.contact.n()) = t.contact.local;
    problem.gap.segment(t.first, t.contact.n()) = t.contact.gap.array() + pairs_[t.pair].offset;
    std::copy(t.contact.own.begin(), t.contact.own.end(), problem.own.begin() + t.first);
  }
  const MatrixXd local = problem.C;
  std::vector<Loads> loads(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].toothed) continue;
    loads[b] = loads_on(b, teeth, n);
    problem.gap += loads[b].Phi_S.transpose() * motion[b].q;
    add_compliance(b, teeth, loads[b], problem.C);
  }
  problem.C = ((problem.C + problem.C.transpose()) / 2).eval();
  const contact::StationForces forces = contact::station_forces(problem);

  state.stations = {std::vector<Eigen::SparseMatrix<double>>(bodies_.size()), forces.f(forces.active),
                    forces.stiffness, forces.potential, 0.5 * forces.f.dot(local * forces.f)};
  for (Index i = 0; i < n; ++i) {  // the energy of a strip, whose complement is U
    const contact::StripLaw& law = problem.own[static_cast<std::size_t>(i)];
    state.stations.local_energy += forces.f[i] * law.approach(forces.f[i]) - law.energy(forces.f[i]);
  }
  state.force.assign(bodies_.size(), {});
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    set_nodal_forces(b, loads[b], forces, motion[b], responses, state);
  add_joint_forces(motion, teeth, loads, forces.f, state);
  state.pair.clear();
  for (const Pair& pair : pairs_)
    state.pair.push_back({{static_cast<int>(pair.body[0]), static_cast<int>(pair.body[1])}, {}});
  for (const Teeth& t : teeth)
    for (Index i = 0; i < t.contact.n(); ++i)
      if (const double f = forces.f[t.first + i]; f > 0)
        state.pair[t.pair].points.push_back(contact::station_point(t.contact, pairs_[t.pair].toothed, i, f,
                                                                   motion[pairs_[t.pair].body[0]].R_WB));
  state.balanced = true;
}

}  // namespace elastogear::dynamics
