#include "dynamics/approach/local_approach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dynamics/approach/patch_approach.h"
#include "elastogear/contact/topology.h"

namespace elastogear::dynamics {

using contact::ContactPoint;
using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using Patch = std::vector<const ContactPoint*>;

constexpr double kLeast = 1e-6;       // of a face's length, approach under forces of roundoff
constexpr double kMostChange = 0.25;  // of an approach, by extrapolation
constexpr double kSlight = 0.05;      // of all forces of a pair, below which those of a patch go on as F^m

// Outward unit normals of the nodes, by the faces of their groups.
Matrix3Xd node_normals(const model::Surface& surface, const std::vector<int>& group) {
  Matrix3Xd normal = Matrix3Xd::Zero(3, surface.X.cols());
  for (Index f = 0; f < surface.face.cols(); ++f) {
    const auto corner = surface.face.col(f);
    const Vector3d across = surface.X.col(corner[2]) - surface.X.col(corner[0]),
                   back = surface.X.col(corner[3]) - surface.X.col(corner[1]);
    for (int node : corner)
      if (group[static_cast<std::size_t>(node)] == surface.group[static_cast<std::size_t>(f)])
        normal.col(node) += across.cross(back);
  }
  normal.colwise().normalize();
  return normal;
}

// m, by group, the diagonal of the box around its nodes.
std::vector<double> lengths(const model::Surface& surface, const std::vector<int>& group) {
  std::vector<Eigen::AlignedBox3d> box(surface.group_name.size());
  for (Index i = 0; i < surface.X.cols(); ++i)
    box[static_cast<std::size_t>(group[static_cast<std::size_t>(i)])].extend(Vector3d(surface.X.col(i)));
  std::vector<double> length;
  for (const Eigen::AlignedBox3d& b : box) length.push_back(b.isEmpty() ? 0 : b.diagonal().norm());
  return length;
}

// The node of one side that is nearest to a contact.
int node_of(const ContactPoint& point, int side) {
  if (point.slave_side == side) return point.slave_node;
  Index nearest = 0;
  point.N.maxCoeff(&nearest);
  return point.master_nodes[nearest];
}

// Forces p at places t along a line, by their place.
LineForces sorted(const VectorXd& t, const VectorXd& p) {
  std::vector<Index> order(static_cast<std::size_t>(t.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return t[a] < t[b]; });
  return {t(order), p(order)};
}

// World frame, of the slave's nodes.
Vector3d place_of(const ContactPoint& point, const contact::SurfaceState& slave) {
  Vector3d x_B = Vector3d::Zero();
  for (Index i = 0; i < point.slave_nodes.size(); ++i)
    x_B += point.slave_N[i] * slave.x_B.col(point.slave_nodes[i]);
  return slave.R_WB * x_B + slave.r_WB;
}

}  // namespace

LocalApproach::LocalApproach(const SystemModel& model)
    : surface_(model.bodies.size()), flanks_(model.bodies.size()) {
  for (std::size_t p = 0; p < model.pairs.size(); ++p) {
    const PairSetup& pair = model.pairs[p];
    if (pair.settings.approach != contact::FlankApproach::hertz) continue;
    for (int b : pair.body) {
      const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(b)];
      surface_[static_cast<std::size_t>(b)].emplace(
          Surface{body.eq.body.get(), &body.node_group, &body.true_surface->curvature,
                  MeshWork(body.eq.body->surface, body.surface_compliance), body.surface_compliance});
    }
    const auto groups = [&](int side) {
      return model.bodies[static_cast<std::size_t>(pair.body[side])].eq.body->surface.group_name.size();
    };
    const int side = groups(1) >= groups(0) ? 1 : 0;
    const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(pair.body[side])];
    const model::Surface& surface = body.eq.body->surface;
    flanks_[static_cast<std::size_t>(pair.body[side])].emplace(
        Flanks{node_normals(surface, body.node_group), &body.node_group,
               std::vector<Flank>(surface.group_name.size()), lengths(surface, body.node_group)});
    const model::Surface& slave =
        model.bodies[static_cast<std::size_t>(pair.body[pair.settings.slave])].eq.body->surface;
    const double face = contact::face_size(slave.X, slave.face);
    pairs_.push_back({p, side, face, kLeast * face});
  }
}

LocalApproach::Patches LocalApproach::patches(const Pair& pair, const PairContacts& contacts) const {
  Patches patches;
  const auto b = static_cast<std::size_t>(contacts.body[pair.side]);
  for (const ContactPoint& point : contacts.points)
    if (point.p > 0)
      patches[(*flanks_[b]->group)[static_cast<std::size_t>(node_of(point, pair.side))]].push_back(&point);
  return patches;
}

// 1/m, BRF.
Eigen::Matrix3d LocalApproach::curvature(const ContactPoint& point, int side, std::size_t b) const {
  const auto at = [&](int node) -> const Eigen::Matrix3d& {
    return (*surface_[b]->curvature)[static_cast<std::size_t>(node)];
  };
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  const bool is_slave = point.slave_side == side;
  const contact::NodeNumbers& nodes = is_slave ? point.slave_nodes : point.master_nodes;
  const contact::NodeWeights& N = is_slave ? point.slave_N : point.N;
  for (Index i = 0; i < nodes.size(); ++i) S += N[i] * at(nodes[i]);
  return S;
}

// The normal forces of a patch on one side, BRF.
NodalForces LocalApproach::normal_forces(const Patch& patch, int side, const Eigen::Matrix3d& R_BW) {
  std::map<int, Vector3d> forces;
  for (const ContactPoint* point : patch)
    for (int i = 0; i < point->n_local(); ++i) {
      const LocalNode local = local_node(*point, i);
      if (local.side != side) continue;
      forces.try_emplace(local.node, Vector3d::Zero()).first->second +=
          R_BW * (point->n.dot(local_force(*point, i)) * point->n);
    }
  NodalForces f;
  f.f_B.resize(3, std::ssize(forces));
  for (const auto& [node, force] : forces) {
    f.f_B.col(std::ssize(f.node)) = force;
    f.node.push_back(node);
  }
  return f;
}

// Where a line of contact along a unit vector (world frame) through x goes on over both flanks of a patch.
LineExtent LocalApproach::line_extent_of(const ContactPoint& point, const PairContacts& contacts,
                                         const ContactState& state, const Vector3d& x,
                                         const Vector3d& along) const {
  LineExtent both{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  for (int side : {0, 1}) {
    const auto b = static_cast<std::size_t>(contacts.body[side]);
    const contact::SurfaceState& at = state.surface[b];
    const Eigen::Matrix3d R_BW = at.R_WB.transpose();
    const LineExtent one = line_extent(surface_[b]->body->surface,
                                       (*surface_[b]->group)[static_cast<std::size_t>(node_of(point, side))],
                                       R_BW * (x - at.r_WB), R_BW * along, R_BW * point.n);
    both = {std::max(both.from, one.from), std::min(both.to, one.to), std::max(both.face, one.face)};
  }
  return both;
}

ApproachLaw LocalApproach::law(const Pair& pair, int group, const Patch& patch, const ContactState& state,
                               Flexibilities& flexibility) {
  const PairContacts& contacts = state.pair[pair.number];
  const auto n = static_cast<Index>(patch.size());
  Matrix3Xd x(3, n);
  VectorXd p(n);
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Vector3d normal = Vector3d::Zero();
  for (Index i = 0; i < n; ++i) {
    const ContactPoint& point = *patch[static_cast<std::size_t>(i)];
    x.col(i) = place_of(point, state.surface[static_cast<std::size_t>(contacts.body[point.slave_side])]);
    p[i] = point.p;
    normal += point.p * point.n;
    for (int side : {0, 1}) {
      const auto b = static_cast<std::size_t>(contacts.body[side]);
      const Eigen::Matrix3d& R = state.surface[b].R_WB;
      Q += point.p * R * curvature(point, side, b) * R.transpose();
    }
  }
  const double F = p.sum();
  if (!Q.allFinite()) return {};
  const model::Curvatures at = model::principal_curvatures(Q / F, normal.normalized());
  if (!(at.largest > 0)) return {};
  const auto flank = static_cast<std::size_t>(contacts.body[pair.side]);
  double compliance = 0, work = 0;
  for (int side : {0, 1}) compliance += surface_[static_cast<std::size_t>(contacts.body[side])]->compliance;
  const bool ellipse = is_ellipse(at, F, compliance, flanks_[flank]->length[static_cast<std::size_t>(group)]);
  for (int side : {0, 1}) {
    const auto b = static_cast<std::size_t>(contacts.body[side]);
    const Eigen::Matrix3d R_BW = state.surface[b].R_WB.transpose();
    const Vector3d along = ellipse ? Vector3d(Vector3d::Zero()) : Vector3d(R_BW * at.along);
    work += surface_[b]->mesh_work.of({pair.number, group}, normal_forces(patch, side, R_BW), along,
                                      *flexibility[b]);
  }
  const Vector3d centre = x * p / F;
  x.colwise() -= centre;
  const PatchApproach hertz =
      ellipse ? ellipse_approach(at, F, compliance)
              : line_approach(sorted(x.transpose() * at.along, p),
                              line_extent_of(*patch.front(), contacts, state, centre, at.along), pair.face,
                              at.largest, compliance);
  // Points of least gap on a line are at its place, where the gap of rigid flanks is zero.
  const double geometric = ellipse ? 0.5 * p.dot((x.transpose() * (Q / F) * x).diagonal()) / F : 0;
  double approach = hertz.approach - geometric - work / F;
  if (approach < pair.least) {  // a mesh is never too soft, what is told of it may be
    if (!moves_) return {};
    approach = 0;
  }
  double all = 0;
  for (const ContactPoint& point : contacts.points) all += point.p;
  const double F_n = std::max(F, kSlight * all);
  return {F_n, approach * std::pow(F_n / F, hertz.m), hertz.m};
}

void LocalApproach::set_law(std::size_t b, std::size_t group, const ApproachLaw& law) {
  Flank& flank = flanks_[b]->flank[group];
  flank.law = law;
  const double before = std::exchange(flank.approach, law.value(flank.force));
  flanks_[b]->change = std::max(flanks_[b]->change, std::abs(flank.approach - before));
}

double LocalApproach::take_change(std::size_t b) {
  return acts_on(b) ? std::exchange(flanks_[b]->change, 0) : 0;
}

double LocalApproach::find(const ContactState& state, Flexibilities& flexibility, double share,
                           double least) {
  std::vector<std::map<std::size_t, ApproachLaw>> found(flanks_.size());
  for (const Pair& pair : pairs_) {
    const PairContacts& contacts = state.pair[pair.number];
    for (const auto& [group, patch] : patches(pair, contacts))
      found[static_cast<std::size_t>(contacts.body[pair.side])][static_cast<std::size_t>(group)] =
          law(pair, group, patch, state, flexibility);
  }
  double change = 0;
  for (std::size_t b = 0; b < flanks_.size(); ++b)
    for (std::size_t g = 0; acts_on(b) && g < flanks_[b]->flank.size(); ++g) {
      const ApproachLaw& before = flanks_[b]->flank[g].law;
      ApproachLaw now = found[b][g];
      const double moved = now.e_n - before.value(now.F_n);
      if (std::abs(moved) <= least * flanks_[b]->length[g] && (before.F_n > 0) == (now.F_n > 0)) continue;
      change = std::max(change, std::abs(moved));
      if (before.F_n > 0) now.e_n -= (1 - share) * moved;
      set_law(b, g, now);
    }
  return change;
}

void LocalApproach::accept(const ContactState& state, Flexibilities& flexibility, double time) {
  moves_ = !std::exchange(seeks_rest_, false);
  find(state, flexibility, 1, 0);
  before_at_ = std::exchange(accepted_at_, time);
  for (auto& flanks : flanks_)
    for (std::size_t g = 0; flanks && g < flanks->flank.size(); ++g) {
      Flank& flank = flanks->flank[g];
      const ApproachLaw before = std::exchange(flank.accepted, flank.law);
      flank.before = before;
      if (before.F_n > 0 && flank.law.F_n > 0)
        taken_ += flank.law.complementary_energy(flank.force) - before.complementary_energy(flank.force);
    }
}

void LocalApproach::extrapolate(double time) {
  if (!(accepted_at_ > before_at_)) return;
  const double share = (time - accepted_at_) / (accepted_at_ - before_at_);
  for (std::size_t b = 0; b < flanks_.size(); ++b)
    for (std::size_t g = 0; acts_on(b) && g < flanks_[b]->flank.size(); ++g) {
      const Flank& flank = flanks_[b]->flank[g];
      if (!(flank.before.F_n > 0 && flank.accepted.F_n > 0)) continue;
      ApproachLaw law = flank.accepted;
      const double way = share * (law.e_n - flank.before.value(law.F_n));
      if (std::abs(way) > kMostChange * law.e_n) continue;
      law.e_n += way;
      set_law(b, g, law);
    }
}

void LocalApproach::find_new(const ContactState& state, Flexibilities& flexibility) {
  for (const Pair& pair : pairs_) {
    const PairContacts& contacts = state.pair[pair.number];
    const auto b = static_cast<std::size_t>(contacts.body[pair.side]);
    for (const auto& [group, patch] : patches(pair, contacts))
      if (const auto g = static_cast<std::size_t>(group); !(flanks_[b]->flank[g].law.F_n > 0)) {
        set_law(b, g, law(pair, group, patch, state, flexibility));
        flanks_[b]->flank[g].accepted = flanks_[b]->flank[g].law;
      }
  }
}

const LocalApproach::Flank& LocalApproach::flank_of(std::size_t b, int node) const {
  return flanks_[b]->flank[static_cast<std::size_t>((*flanks_[b]->group)[static_cast<std::size_t>(node)])];
}

double LocalApproach::set_forces(std::size_t b, const NodalForces& forces) {
  if (!acts_on(b)) return 0;
  Flanks& flanks = *flanks_[b];
  for (Flank& flank : flanks.flank) flank.force = 0;
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    const auto node = static_cast<std::size_t>(forces.node[i]);
    flanks.flank[static_cast<std::size_t>((*flanks.group)[node])].force -=
        flanks.normal.col(forces.node[i]).dot(forces.f_B.col(static_cast<Index>(i)));
  }
  double change = 0;
  for (Flank& flank : flanks.flank) {
    const double before = std::exchange(flank.approach, flank.law.value(flank.force));
    change = std::max(change, std::abs(flank.approach - before));
  }
  return change;
}

Vector3d LocalApproach::displacement(std::size_t b, int node) const {
  if (!acts_on(b)) return Vector3d::Zero();
  const Flank& flank = flank_of(b, node);
  return -flank.approach * flanks_[b]->normal.col(node);
}

Vector3d LocalApproach::lag(std::size_t b, int node) const {
  if (!acts_on(b)) return Vector3d::Zero();
  const Flank& flank = flank_of(b, node);
  return -(flank.approach - flank.law.slope(flank.force) * flank.force) * flanks_[b]->normal.col(node);
}

void LocalApproach::add_tangent(std::size_t b, const std::vector<int>& node, Eigen::MatrixXd& R) const {
  const Flanks& flanks = *flanks_[b];
  for (std::size_t i = 0; i < node.size(); ++i) {
    const Flank& flank = flank_of(b, node[i]);
    const double slope = flank.law.slope(flank.force);
    for (std::size_t j = 0; j < node.size() && slope != 0; ++j)
      if ((*flanks.group)[static_cast<std::size_t>(node[i])] ==
          (*flanks.group)[static_cast<std::size_t>(node[j])])
        R.block<3, 3>(static_cast<Index>(3 * i), static_cast<Index>(3 * j)) +=
            slope * flanks.normal.col(node[i]) * flanks.normal.col(node[j]).transpose();
  }
}

double LocalApproach::largest(std::size_t b) const {
  double most = 0;
  if (acts_on(b))
    for (const Flank& flank : flanks_[b]->flank) most = std::max(most, std::abs(flank.approach));
  return most;
}

double LocalApproach::energy(std::size_t b) const {
  double sum = 0;
  if (acts_on(b))
    for (const Flank& flank : flanks_[b]->flank) sum += flank.law.energy(flank.force);
  return sum;
}

void LocalApproach::serialize(Archive& archive) {
  for (double* x : {&taken_, &accepted_at_, &before_at_}) archive(*x);
  for (bool* x : {&seeks_rest_, &moves_}) archive(*x);
  for (auto& flanks : flanks_)
    for (std::size_t g = 0; flanks && g < flanks->flank.size(); ++g) {
      Flank& flank = flanks->flank[g];
      for (ApproachLaw* law : {&flank.law, &flank.accepted, &flank.before})
        for (double* x : {&law->F_n, &law->e_n, &law->m}) archive(*x);
      for (double* x : {&flank.force, &flank.approach}) archive(*x);
    }
}

}  // namespace elastogear::dynamics
