#include "tracker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/contact/penalty.h"

namespace elastogear::contact {
namespace {

// The relative motion for which one measurement of clearance serves: at first this share of the skin, twice
// as much when it has served few stages only, half as much after many.
constexpr double kLimit = 0.125;
constexpr int kFewUses = 8, kManyUses = 64;
constexpr double kStretch = 1.1;  // of prolonged ends when the surface is deformed, generously

double largest_displacement(const SurfaceState& state, const model::Surface& surface) {
  return std::sqrt((state.x_B - surface.X).colwise().squaredNorm().maxCoeff());
}

// How far the prolonged open ends of a surface reach beyond its faces.
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

double next_limit(const Vicinity& vicinity, double skin) {
  if (vicinity.limit == 0) return kLimit * skin;
  if (vicinity.uses < kFewUses) return std::min(2 * vicinity.limit, skin);
  return vicinity.uses > kManyUses ? vicinity.limit / 2 : vicinity.limit;
}

void make_set(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

void visit_motion(SurfaceMotion (&motion)[2], const std::array<Tracked, 2>& side, Tape& tape) {
  for (int i : {0, 1}) {
    tape(motion[i].q);
    tape(motion[i].r_WB);
    tape(motion[i].R_WB);
    validate(motion[i], *side[i].surface, i);
  }
}

}  // namespace

Tracked tracked(const model::Surface& surface, const Eigen::SparseMatrix<double>* K_r) {
  return {&surface, topology(surface.face, static_cast<int>(surface.X.cols())),
          deformation_bound(surface.Phi, K_r ? *K_r : Eigen::SparseMatrix<double>()),
          enclosing_ball(surface.X)};
}

std::vector<int> slave_sides(const Settings& settings) {
  return settings.two_pass ? std::vector{settings.slave, 1 - settings.slave} : std::vector{settings.slave};
}

Tracker::Tracker(std::array<Tracked, 2> sides, const Settings& settings, const Limits& limits)
    : side_(std::move(sides)),
      settings_(settings),
      limits_(limits),
      search_(*side_[0].surface, *side_[1].surface, settings.k, settings.update) {
  for (int i : {0, 1}) configuration_.x[i] = side_[i].surface->X;
  reach_ = limits.depth + kStretch * std::max(extension_reach(view(0, settings.extension)),
                                              extension_reach(view(1, settings.extension)));
}

SurfaceView Tracker::view(int i, double extension) const {
  return {side_[i].surface->face, side_[i].topology, configuration_.x[i], extension};
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

// Where the motion puts them now.
void Tracker::place_nodes(int i, const std::vector<int>& nodes) {
  const RelativeMotion relative = relative_motion(*now_[0], *now_[1]);
  const model::Surface& surface = *side_[i].surface;
  configuration_.R = relative.R;
  configuration_.r = relative.r;
  for (int node : nodes) {
    const Eigen::Vector3d x_B = surface.X.col(node) + model::displacement(surface.Phi, node, now_[i]->q);
    require(x_B.allFinite(), "contact: position of node ", node, " of surface ", i == 0 ? "a" : "b",
            " is not finite");
    configuration_.x[i].col(node) = i == 0 ? Eigen::Vector3d(relative.R * x_B + relative.r) : x_B;
  }
  n_displaced_ += static_cast<int>(nodes.size());
}

// Bound of the relative motion since.
double Tracker::way(const SurfaceMotion then[2]) const {
  double way = 0;
  for (int i : {0, 1}) way += largest_displacement(side_[i].bound, now_[i]->q - then[i].q);
  Ball ball = side_[0].ball;
  ball.radius += largest_displacement(side_[0].bound, then[0].q);
  return way + travel(ball, relative_motion(then[0], then[1]), relative_motion(*now_[0], *now_[1]));
}

// Whose positions the fine search of the candidates at hand reads.
void Tracker::list_nodes() {
  std::array<std::vector<int>, 2>& lists = vicinity_->node = kept_;
  for (int slave : slave_sides(settings_))
    for (int i : {0, 1}) {
      const Topology& t = side_[i].topology;
      const Eigen::Matrix4Xi& face = side_[i].surface->face;
      const Nearby& near = vicinity_->near[slave];
      const auto nodes =
          i == slave ? nodes_around_nodes(near.slave, t, face) : nodes_around(near.face, t, face);
      lists[i].insert(lists[i].end(), nodes.begin(), nodes.end());
    }
  for (auto& list : lists) make_set(list);
}

// Of all candidates: those that cannot touch soon are left out, and faces that cannot be nearest.
void Tracker::measure_clearance(double limit) {
  for (int slave : slave_sides(settings_)) vicinity_->near[slave] = everything(vicinity_->candidates[slave]);
  list_nodes();
  for (int i : {0, 1}) place_nodes(i, vicinity_->node[i]);
  vicinity_->limit = limit;
  vicinity_->uses = 0;
  const std::array reach_and_limit{std::max(limits_.depth, limits_.outside) + settings_.skin,
                                   limit + limits_.outside};
  for (int slave : slave_sides(settings_)) {
    Nearby& near = vicinity_->near[slave] = {};
    const SurfaceView master = view(1 - slave, settings_.extension);
    const Candidates& candidates = vicinity_->candidates[slave];
    for (int node : candidates.nodes()) {
      const auto [clearance, faces] =
          approach(master, configuration_.x[slave].col(node), reach_and_limit, candidates[node]);
      if (clearance > limit + limits_.outside) continue;
      near.slave.push_back(node);
      near.face.insert(near.face.end(), faces.begin(), faces.end());
      near.end.push_back(static_cast<int>(near.face.size()));
    }
  }
  list_nodes();
  for (int i : {0, 1}) vicinity_->measured_at[i] = *now_[i];
}

// Whether it had to be measured again, which places all its nodes.
bool Tracker::update_vicinity() {
  const bool search_is_due = !vicinity_ || !(way(vicinity_->found_at) <= settings_.skin);
  if (search_is_due) find_candidates();
  const bool is_used_up = search_is_due || !(way(vicinity_->measured_at) <= vicinity_->limit);
  if (is_used_up) measure_clearance(next_limit(*vicinity_, settings_.skin));
  ++vicinity_->uses;
  return is_used_up;
}

// Candidates within `margin` of each other where the nodes are placed now.
void Tracker::find_candidates(double margin) {
  const auto& face_pairs = search_.face_pairs(configuration_, margin);
  if (!vicinity_) vicinity_.emplace();
  for (int slave : slave_sides(settings_)) {
    Candidates& candidates = vicinity_->candidates[slave];
    candidates.collect(face_pairs, slave, view(slave, 0), view(1 - slave, settings_.extension), margin);
    vicinity_->near[slave] = everything(candidates);
  }
  ++n_searches_;
}

void Tracker::find_candidates() {
  const bool deformed = settings_.update == Update::refit;
  double margin = reach_ + settings_.skin;
  for (int i : {0, 1})
    if (!deformed) margin += largest_displacement(side_[i].bound, now_[i]->q);
  place(deformed);
  find_candidates(margin);
  for (int i : {0, 1}) vicinity_->found_at[i] = {now_[i]->q, now_[i]->r_WB, now_[i]->R_WB};
}

void Tracker::find(const SurfaceState& a, const SurfaceState& b) {
  const SurfaceState* state[2] = {&a, &b};
  std::fill_n(now_, 2, nullptr);
  double margin = reach_;
  for (int i : {0, 1}) {
    validate(*state[i], *side_[i].surface, i);
    if (settings_.update == Update::realign) margin += largest_displacement(*state[i], *side_[i].surface);
  }
  place(a, b);
  find_candidates(margin);
}

void Tracker::follow(const SurfaceMotion& a, const SurfaceMotion& b) {
  now_[0] = &a;
  now_[1] = &b;
  for (int i : {0, 1}) validate(*now_[i], *side_[i].surface, i);
  n_displaced_ = 0;
  if (!update_vicinity())
    for (int i : {0, 1}) place_nodes(i, vicinity_->node[i]);
}

void Tracker::forget() { vicinity_.reset(); }

std::span<const int> Tracker::all_faces(int slave, int node) {
  const auto faces = vicinity_->candidates[slave][node];
  const Tracked& master = side_[1 - slave];
  if (now_[0]) place_nodes(1 - slave, nodes_around(faces, master.topology, master.surface->face));
  return faces;
}

Eigen::Vector3d Tracker::velocity(int i, int node) const {
  if (!now_[i]) return Eigen::Vector3d::Zero();
  const SurfaceMotion& m = *now_[i];
  const Eigen::Matrix3d& R = configuration_.R;
  const Eigen::Vector3d x = configuration_.x[i].col(node);
  const Eigen::Vector3d x_B = i == 0 ? Eigen::Vector3d(R.transpose() * (x - configuration_.r)) : x;
  Eigen::Vector3d v = m.v_WB_B + m.w_WB_B.cross(x_B);
  if (m.q_dot.size() > 0) v += model::displacement(side_[i].surface->Phi, node, m.q_dot);
  return i == 0 ? Eigen::Vector3d(R * v) : v;
}

// Candidates and their clearance follow from where they were found.
void Tracker::visit_memory(Tape& tape) {
  bool found = vicinity_.has_value();
  tape(found);
  if (!found) return vicinity_.reset();
  Vicinity then = vicinity_.value_or(Vicinity{});
  visit_motion(then.found_at, side_, tape);
  visit_motion(then.measured_at, side_, tape);
  tape(then.limit);
  tape(then.uses);
  if (!tape.plays()) return;
  for (int i : {0, 1}) now_[i] = &then.found_at[i];
  find_candidates();
  for (int i : {0, 1}) now_[i] = &then.measured_at[i];
  measure_clearance(then.limit);
  vicinity_->uses = then.uses;
  std::fill_n(now_, 2, nullptr);
}

}  // namespace elastogear::contact
