#include "contact/search/tracker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/search/surface_checks.h"
#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::contact {
namespace {

constexpr double kStretch = 1.1;  // of extensions when the surface is deformed, generously

double largest_displacement(const SurfaceState& state, const model::Surface& surface) {
  return std::sqrt((state.x_B - surface.X).colwise().squaredNorm().maxCoeff());
}

// Is a displacement bounded without displacing all nodes?
bool is_cheap(const DeformationBound& bound, const Eigen::VectorXd& q) {
  return q.size() == 0 || bound.stiffness.size() > 0;
}

// How far the extensions of a surface reach beyond its faces.
double extension_reach(const SurfaceView& surface) {
  double reach = 0;
  for (int f : surface.topology.open_faces) {
    const Face face = face_of(surface, f);
    for (int corner = 0; corner < face.sides; ++corner) {
      const Eigen::Vector2d at = extended_corner(face, corner);
      reach = std::max(reach, (combine(face, shape(face.sides, at[0], at[1]).N) - face.x[corner]).norm());
    }
  }
  return reach;
}

void serialize_motion(SurfaceMotion (&motion)[2], const std::array<Tracked, 2>& side, Archive& archive) {
  for (int i : {0, 1}) {
    archive(motion[i].q);
    archive(motion[i].r_WB);
    archive(motion[i].R_WB);
    validate(motion[i], *side[i].surface, i);
  }
}

}  // namespace

Tracked tracked(const model::Surface& surface, const Eigen::SparseMatrix<double>* K_r) {
  return {&surface, topology(surface.face, static_cast<int>(surface.X.cols())),
          deformation_bound(surface.Phi, K_r ? *K_r : Eigen::SparseMatrix<double>()),
          enclosing_ball(surface.X), corners_around(surface.X)};
}

std::vector<int> slave_sides(const Settings& settings) {
  const bool with_edges = settings.law != ContactLaw::penalty && settings.points != SlavePoints::faces;
  const bool both = settings.two_pass || with_edges;
  return both ? std::vector{settings.slave, 1 - settings.slave} : std::vector{settings.slave};
}

Tracker::Tracker(std::array<Tracked, 2> sides, const Settings& settings, const Limits& limits,
                 std::array<SlaveNodes, 2> slaves)
    : side_(std::move(sides)),
      settings_(settings),
      limits_(limits),
      slaves_(std::move(slaves)),
      search_(*side_[0].surface, *side_[1].surface, settings.k, settings.update),
      displaced_{NodeDisplacements(*side_[0].surface), NodeDisplacements(*side_[1].surface)} {
  for (int i : {0, 1}) {
    configuration_.x[i] = side_[i].surface->X;
    const auto n = static_cast<std::size_t>(side_[i].surface->X.cols());
    const std::vector<long> of_faces(static_cast<std::size_t>(side_[i].surface->face.cols()), 0);
    look_[i] = {std::vector<long>(n, 0), std::vector<long>(n, 0), of_faces, {}};
    clear_until_[i].assign(n, 0);
    rates_[i] = {{}, Eigen::Matrix3Xd(3, n), std::vector<long>(n, 0), 1};
  }
  for (int i : {0, 1}) {
    boxes_[i] = face_boxes(view(i, settings.extension));
    normals_[i].resize(3, side_[i].surface->X.cols());
    for (int node = 0; node < side_[i].surface->X.cols(); ++node)
      normals_[i].col(node) = node_normal(view(i, 0), node);
  }
  reach_ = limits.depth + limits.around +
           kStretch * std::max(extension_reach(view(0, settings.extension)),
                               extension_reach(view(1, settings.extension)));
}

SurfaceView Tracker::view(int i, double extension) {
  return {
      side_[i].surface->face, side_[i].topology, configuration_.x[i], extension, now_[0] ? this : nullptr, i,
      look_[i].node.data(),   &n_looks_};
}

void Tracker::place(const SurfaceState& a, const SurfaceState& b) {
  const RelativeMotion motion = relative_motion({{}, a.r_WB, a.R_WB}, {{}, b.r_WB, b.R_WB});
  configuration_.R = motion.R;
  configuration_.r = motion.r;
  configuration_.x[0].noalias() = motion.R * a.x_B;
  configuration_.x[0].colwise() += motion.r;
  configuration_.x[1] = b.x_B;
}

void Tracker::place(bool deformed) {
  SurfaceState state[2];
  for (int i : {0, 1})
    state[i] = deformed ? surface_state(*side_[i].surface, *now_[i])
                        : SurfaceState{side_[i].surface->X, now_[i]->r_WB, now_[i]->R_WB};
  place(state[0], state[1]);
}

// Deformed positions of earlier stages are of no use for other coordinates.
void Tracker::start_stage() {
  for (int i : {0, 1}) {
    const Eigen::VectorXd& q_dot = now_[i]->q_dot;
    if (q_dot.size() == rates_[i].q_dot.size() && q_dot == rates_[i].q_dot) continue;
    rates_[i].q_dot = q_dot;
    ++rates_[i].number;
  }
  for (int i : {0, 1}) displaced_[i].start(now_[i]->q);
}

// Deformed position of a node, residual displacement included, in the BRF of its surface.
Eigen::Vector3d Tracker::position(int i, int node) {
  if (!displaced_[i].has(node)) ++n_displaced_;
  const Eigen::Vector3d x_B = side_[i].surface->X.col(node) + displaced_[i].at(node);
  if (!residual_ || !(*residual_)[i].at) return x_B;
  return x_B + (*residual_)[i].at(node);
}

// Begins to place nodes by the present motion.
void Tracker::start_look() {
  ++n_looks_;
  const RelativeMotion relative = relative_motion(*now_[0], *now_[1]);
  configuration_.R = relative.R;
  configuration_.r = relative.r;
  for (Look& look : look_) look.nodes.clear();
  for (int i : {0, 1}) {
    bounds_[i].reset();
    if (is_cheap(side_[i].bound, now_[i]->q)) bounds_[i].emplace(face_bounds(i));
  }
}

// An extension moves by more than the nodes that it prolongs.
FaceBounds Tracker::face_bounds(int i) const {
  const double of_extension = 1 + 2 * settings_.extension;
  const Eigen::Matrix3d R = i == 0 ? configuration_.R : Eigen::Matrix3d::Identity();
  const Eigen::Vector3d r = i == 0 ? configuration_.r : Eigen::Vector3d::Zero();
  const Tracked& tracked = side_[i];
  return {&boxes_[i],
          {tracked.surface->face, tracked.topology, tracked.surface->X, settings_.extension},
          of_extension * of_extension * largest_deformation(i),
          R,
          r};
}

Eigen::Vector3d Tracker::undeformed_normal(int i, int node) const {
  if (!now_[0]) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d n = normals_[i].col(node);
  return i == 0 ? Eigen::Vector3d(configuration_.R * n) : n;
}

// Places a node by the present motion, in the BRF of surface b.
void Tracker::place_node(int i, int node) {
  if (look_[i].node[node] == n_looks_) return;
  look_[i].node[node] = n_looks_;
  look_[i].nodes.push_back(node);
  const Eigen::Vector3d x_B = position(i, node);
  require(x_B.allFinite(), "contact: position of node ", node, " of surface ", i == 0 ? "a" : "b",
          " is not finite");
  configuration_.x[i].col(node) = i == 0 ? Eigen::Vector3d(configuration_.R * x_B + configuration_.r) : x_B;
}

// Places a node and all nodes of the faces around it.
void Tracker::place_around(int i, int node) {
  if (look_[i].around[node] == n_looks_) return;
  look_[i].around[node] = n_looks_;
  place_node(i, node);
  for (int corner : side_[i].topology.node_corners[node])
    for (int other : side_[i].surface->face.col(corner / 4)) place_node(i, other);
}

// Places the nodes of a face and all around it. An edge or vertex that is nearest takes its normal from faces
// that are all as near.
void Tracker::place_face(int i, int face) {
  if (look_[i].face[face] == n_looks_) return;
  look_[i].face[face] = n_looks_;
  for (int node : side_[i].surface->face.col(face)) place_around(i, node);
}

// Places the nodes whose positions the fine search of these neighbours may read.
void Tracker::place_for(int slave, const Neighbours& near) {
  for (int node : near.slave) place_around(slave, node);
  for (int f : near.face) place_face(1 - slave, f);
  for (int f : near.around) place_face(1 - slave, f);
}

// Bound of the relative motion of both surfaces since `then`: docs/theory, Eq. (5.5).
double Tracker::distance_since(const SurfaceMotion then[2]) const {
  double distance = 0;
  double rigid = std::numeric_limits<double>::infinity();
  for (int i : {0, 1}) {
    const double deformed = largest_displacement(side_[i].bound, then[i].q);
    distance += largest_displacement(side_[i].bound, now_[i]->q - then[i].q);
    rigid = std::min(rigid, travel(side_[i].corners, deformed, relative_motion(then[i], then[1 - i]),
                                   relative_motion(*now_[i], *now_[1 - i])));
  }
  return distance + rigid;
}

// Bound of what the present coordinates and residual displacements move a node by, m.
double Tracker::largest_deformation(int i) const {
  return largest_displacement(side_[i].bound, now_[i]->q) + (residual_ ? (*residual_)[i].largest : 0);
}

void Tracker::find(const SurfaceState& a, const SurfaceState& b) {
  const SurfaceState* state[2] = {&a, &b};
  std::fill_n(now_, 2, nullptr);
  for (auto& bounds : bounds_) bounds.reset();
  residual_ = nullptr;
  double margin = reach_;
  for (int i : {0, 1}) {
    validate(*state[i], *side_[i].surface, i);
    if (settings_.update == Update::realign) margin += largest_displacement(*state[i], *side_[i].surface);
  }
  place(a, b);
  forget_way();
  find_candidates(margin);
}

void Tracker::move_to(const SurfaceMotion& a, const SurfaceMotion& b,
                      const std::array<ResidualDisplacement, 2>& residual) {
  now_[0] = &a;
  now_[1] = &b;
  residual_ = &residual;
  has_residual_ = residual[0].at || residual[1].at;
  for (int i : {0, 1}) validate(*now_[i], *side_[i].surface, i);
  n_displaced_ = 0;
  is_near_found_ = false;
  start_stage();
  start_look();
  for (double* sum : {&residual_since_found_, &residual_since_measured_, &residual_since_seen_})
    for (const ResidualDisplacement& y : residual) *sum += y.change;
}

bool Tracker::stays_within(double distance) const {
  return neighbours_ && is_seen_ && distance_since(seen_at_) + residual_since_seen_ <= distance &&
         distance_since(neighbours_->measured_at) + residual_since_measured_ <= neighbours_->limit &&
         distance_since(neighbours_->found_at) + residual_since_found_ <= settings_.skin;
}

void Tracker::find_near() {
  go_on();
  update_neighbours();
  for (int i : {0, 1})
    for (int node : kept_[i]) place_node(i, node);
  for (int i : {0, 1}) seen_at_[i] = *now_[i];
  residual_since_seen_ = 0;
  is_seen_ = is_near_found_ = true;
  if (settings_.points != SlavePoints::faces) return;
  for (int slave : slave_sides(settings_)) place_for(slave, neighbours_->near[slave]);
}

void Tracker::forget() {
  neighbours_.reset();
  forget_way();
  forget_near();
}

Eigen::Vector3d Tracker::position_B(int i, int node) {
  if (now_[0]) place_node(i, node);
  const Eigen::Vector3d x = configuration_.x[i].col(node);
  return i == 0 ? Eigen::Vector3d(configuration_.R.transpose() * (x - configuration_.r)) : x;
}

// Phi q_dot of a node: those of the master belong to several contacts.
Eigen::Vector3d Tracker::elastic_velocity(int i, int node) {
  Rates& rates = rates_[i];
  if (rates.node[node] != rates.number) {
    rates.x_dot_B.col(node) = model::displacement(side_[i].surface->Phi, node, rates.q_dot);
    rates.node[node] = rates.number;
  }
  return rates.x_dot_B.col(node);
}

Eigen::Vector3d Tracker::velocity(int i, int node) {
  if (!now_[i]) return Eigen::Vector3d::Zero();
  const SurfaceMotion& m = *now_[i];
  const Eigen::Matrix3d& R = configuration_.R;
  const Eigen::Vector3d x_B = position_B(i, node);
  Eigen::Vector3d v = m.v_WB_B + m.w_WB_B.cross(x_B);
  if (m.q_dot.size() > 0) v += elastic_velocity(i, node);
  return i == 0 ? Eigen::Vector3d(R * v) : v;
}

void Tracker::remember() {
  for (int i : {0, 1}) {
    remembered_[i].node = look_[i].nodes;
    sort_unique(remembered_[i].node);
    remembered_[i].x = configuration_.x[i](Eigen::all, remembered_[i].node);
  }
}

std::optional<Eigen::Vector3d> Tracker::moved(int i, int node) const {
  const auto& [nodes, x] = remembered_[i];
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
  if (at == nodes.end() || *at != node) return {};
  return Eigen::Vector3d(configuration_.x[i].col(node) - x.col(at - nodes.begin()));
}

// Adds the way from the last call of find_near to here.
void Tracker::go_on() {
  if (knows_way_) way_ += distance_since(seen_at_) + residual_since_seen_;
  knows_way_ = true;
}

void Tracker::forget_way() {
  knows_way_ = is_near_found_ = false;
  for (std::vector<double>& until : clear_until_) std::fill(until.begin(), until.end(), 0);
}

void Tracker::set_clearance(int slave, int node, double clearance) {
  if (!is_near_found_) return;
  const double spare = slaves_[slave].spare.empty() ? 0 : slaves_[slave].spare[node];
  clear_until_[slave][node] = way_ + clearance + spare;
}

void Tracker::serialize(Archive& archive) {
  for (Placed& placed : remembered_) {
    archive(placed.node);
    archive(placed.x);
  }
  serialize_neighbours(archive);
  for (NodeDisplacements& displaced : displaced_) displaced.serialize(archive);
}

// Stores the motions at which candidates were found and measured; on loading, candidates and clearances are
// found anew from these.
void Tracker::serialize_neighbours(Archive& archive) {
  bool found = neighbours_.has_value();
  archive(found);
  if (!found) return neighbours_.reset();
  NeighbourList then = neighbours_.value_or(NeighbourList{});
  serialize_motion(then.found_at, side_, archive);
  serialize_motion(then.measured_at, side_, archive);
  archive(then.limit);
  archive(then.near_limit);
  archive(then.uses);
  archive(has_residual_);
  if (!archive.is_loading()) return;
  forget_near();
  forget_way();
  if (has_residual_) return neighbours_.reset();  // the residual displacement of that time is not known
  for (int i : {0, 1}) now_[i] = &then.found_at[i];
  find_candidates();
  for (int i : {0, 1}) now_[i] = &then.measured_at[i];
  start_stage();
  start_look();
  measure_clearance(then.limit, 0);
  take_near(then.near_limit);
  neighbours_->uses = then.uses;
  std::fill_n(now_, 2, nullptr);
}

}  // namespace elastogear::contact
