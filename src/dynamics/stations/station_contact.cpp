#include "dynamics/stations/station_contact.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/contact/station_forces.h"

namespace elastogear::dynamics {
namespace {

using contact::ToothContact;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kStations = 16;       // of a pair of teeth
constexpr int kMostRounds = 8;      // until the radii fit the widths of contact
constexpr double kSameRadii = 1e-4;

// Contacts of teeth of one pair of bodies, and where their stations begin among all.
struct Placed {
  int body[2];
  double offset;
  ToothContact contact;
  Index first;
};

// The loads of all stations on one body.
struct LoadsOnBody {
  std::vector<int> node;         // of the surface, ascending
  Eigen::SparseMatrix<double> S;  // 3 nodes x n, BRF: nodal forces of 1 N of each station
};

LoadsOnBody loads_on(std::size_t body, const std::vector<Placed>& placed, Index n) {
  LoadsOnBody loads;
  for (const Placed& p : placed)
    for (std::size_t side : {0, 1})
      if (p.body[side] == static_cast<int>(body))
        loads.node.insert(loads.node.end(), p.contact.side[side].node.begin(),
                          p.contact.side[side].node.end());
  sort_unique(loads.node);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Placed& p : placed)
    for (std::size_t s : {0, 1}) {
      if (p.body[s] != static_cast<int>(body)) continue;
      const ToothContact::Side& side = p.contact.side[s];
      for (std::size_t a = 0; a < side.node.size(); ++a) {
        const auto at = std::lower_bound(loads.node.begin(), loads.node.end(), side.node[a]);
        const auto row = static_cast<int>(3 * (at - loads.node.begin()));
        for (Index i = 0; i < p.contact.n(); ++i)
          if (const double weight = side.weight(i, static_cast<Index>(a)); weight != 0)
            for (int d = 0; d < 3; ++d)
              entries.emplace_back(row + d, static_cast<int>(p.first + i), weight * side.direction(d, i));
      }
    }
  loads.S.resize(3 * std::ssize(loads.node), n);
  loads.S.setFromTriplets(entries.begin(), entries.end());
  return loads;
}

// m, 3 nodes: displacement in the BRF by elastic coordinates, and what is left of former forces.
VectorXd displacements(std::size_t body, const std::vector<int>& node, const model::Surface& surface,
                       const VectorXd& q, ResidualContact& responses) {
  VectorXd u(3 * std::ssize(node));
  for (Index i = 0; int a : node) {
    u.segment<3>(3 * i) = model::displacement(surface.Phi, a, q);
    if (responses.has_flexibility(body)) u.segment<3>(3 * i) += responses.lag(body, a);
    ++i;
  }
  return u;
}

// Forces and radii that fit each other.
contact::StationForces solve(contact::StationProblem& problem, std::vector<Placed>& placed) {
  contact::StationForces forces;
  for (int round = 0; round < kMostRounds; ++round) {
    for (const Placed& p : placed)
      std::copy(p.contact.own.begin(), p.contact.own.end(), problem.own.begin() + p.first);
    forces = contact::station_forces(problem);
    double change = 0;
    for (Placed& p : placed)
      change = std::max(change, contact::set_radii(p.contact, forces.f.segment(p.first, p.contact.n())));
    if (change <= kSameRadii) break;
  }
  return forces;
}

contact::RelativePlacement relative(const contact::SurfaceMotion& owner, const contact::SurfaceMotion& mate) {
  return {owner.R_WB.transpose() * mate.R_WB, owner.R_WB.transpose() * (mate.r_WB - owner.r_WB)};
}

}  // namespace

std::string lacks_for_stations(const SystemModel& model, const PairSetup& pair) {
  for (int b : pair.body) {
    const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(b)];
    const std::string who = "body '" + body.name + "' has ";
    if (!body.true_surface || !body.true_surface->flanks) return who + "no involute flanks of gear data";
    if (body.eq.body->flexibility.empty()) return who + "no static responses";
    if (!(body.surface_compliance > 0) || !body.eq.body->relaxing.empty())
      return who + "several, orthotropic or viscoelastic materials";
  }
  if (pair.settings.friction.mu > 0) return "friction is not one of its forces yet";
  if (pair.settings.law == contact::ContactLaw::penalty) return "it has the law 'penalty'";
  return {};
}

StationContact::StationContact(const SystemModel& model) : model_(&model), toothed_(model.bodies.size()) {
  for (const PairSetup& pair : model.pairs) {
    pairs_.push_back({{pair.body[0], pair.body[1]}, pair.settings.offset});
    for (int b : pair.body) {
      const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(b)];
      std::unique_ptr<contact::ToothedBody>& toothed = toothed_[static_cast<std::size_t>(b)];
      if (!toothed)
        toothed = std::make_unique<contact::ToothedBody>(
            body.eq.body->surface, body.true_surface->flanks, body.surface_compliance / std::numbers::pi,
            body.true_surface->deviation);
    }
  }
}

void StationContact::evaluate(const std::vector<contact::SurfaceMotion>& motion, ResidualContact& responses,
                              ContactState& state) const {
  std::vector<Placed> placed;
  Index n = 0;
  state.pair.clear();
  for (const Pair& pair : pairs_) {
    const auto a = static_cast<std::size_t>(pair.body[0]), b = static_cast<std::size_t>(pair.body[1]);
    state.pair.push_back({{pair.body[0], pair.body[1]}, {}});
    for (ToothContact& contact :
         contact::tooth_contacts(*toothed_[a], *toothed_[b], relative(motion[a], motion[b]), kStations)) {
      placed.push_back({{pair.body[0], pair.body[1]}, pair.offset, std::move(contact), n});
      n += placed.back().contact.n();
    }
  }
  contact::StationProblem problem{MatrixXd::Zero(n, n), std::vector<contact::StripLaw>(static_cast<std::size_t>(n)),
                                  VectorXd(n)};
  for (const Placed& p : placed) {
    problem.C.block(p.first, p.first, p.contact.n(), p.contact.n()) = p.contact.local;
    problem.gap.segment(p.first, p.contact.n()) = p.contact.gap.array() + p.offset;
  }
  const MatrixXd local = problem.C;
  std::vector<LoadsOnBody> loads(toothed_.size());
  for (std::size_t b = 0; b < toothed_.size(); ++b) {
    if (!toothed_[b]) continue;
    loads[b] = loads_on(b, placed, n);
    const model::Surface& surface = toothed_[b]->surface();
    problem.gap += loads[b].S.transpose() * displacements(b, loads[b].node, surface, motion[b].q, responses);
    const MatrixXd R = responses.among(b, loads[b].node);
    const MatrixXd RS = R * loads[b].S;
    problem.C += loads[b].S.transpose() * RS;
  }
  problem.C = ((problem.C + problem.C.transpose()) / 2).eval();
  const contact::StationForces forces = solve(problem, placed);

  state.stations = {};
  state.stations.K = forces.stiffness;
  state.stations.f = forces.f(forces.active);
  state.stations.local_energy = 0.5 * forces.f.dot(local * forces.f);
  for (Index i = 0; i < n; ++i)
    state.stations.local_energy += problem.own[static_cast<std::size_t>(i)].energy(forces.f[i]);
  state.force.assign(toothed_.size(), {});
  for (std::size_t b = 0; b < toothed_.size(); ++b) {
    state.stations.body.emplace_back();
    NodalForces& nodal = state.force[b];
    nodal.x_B.resize(3, 0);
    nodal.f_B.resize(3, 0);
    if (!toothed_[b]) continue;
    const model::Surface& surface = toothed_[b]->surface();
    nodal.node = loads[b].node;
    nodal.f_B = VectorXd(loads[b].S * forces.f).reshaped(3, std::ssize(nodal.node));
    responses.respond(b, nodal);
    nodal.x_B.resize(3, std::ssize(nodal.node));
    for (Index i = 0; int a : nodal.node) {
      nodal.x_B.col(i++) = surface.X.col(a) + model::displacement(surface.Phi, a, motion[b].q) +
                           responses.displacement(b, a);
      state.surface[b].x_B.col(a) = nodal.x_B.col(i - 1);
    }
    Eigen::SparseMatrix<double> active(loads[b].S.rows(), std::ssize(forces.active));
    active.reserve(loads[b].S.nonZeros());
    for (Index k = 0; int i : forces.active) {
      active.startVec(k);
      for (Eigen::SparseMatrix<double>::InnerIterator at(loads[b].S, i); at; ++at)
        active.insertBack(at.row(), k) = at.value();
      ++k;
    }
    active.finalize();
    state.stations.body.back() = std::move(active);
  }
  std::size_t p = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    for (; p < placed.size() && placed[p].body[0] == pairs_[k].body[0] && placed[p].body[1] == pairs_[k].body[1];
         ++p)
      for (Index i = 0; i < placed[p].contact.n(); ++i) {
        const double f = forces.f[placed[p].first + i];
        if (f <= 0) continue;
        const auto a = static_cast<std::size_t>(pairs_[k].body[0]), b = static_cast<std::size_t>(pairs_[k].body[1]);
        state.pair[k].points.push_back(contact::station_point(placed[p].contact, *toothed_[a], *toothed_[b], i, f,
                                                              motion[a].R_WB));
      }
  state.balanced = true;
}

}  // namespace elastogear::dynamics
