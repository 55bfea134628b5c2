// The Tracker's neighbour lists: searches, and measurements of clearance between them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/search/tracker.h"
#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

// The share of the measured motion for which the nodes that touch first serve; it doubles when it is used up,
// and halves when less than kShrink of it is in use.
constexpr double kFirstStretch = 0.125, kShrink = 0.4;
constexpr double kAhead = 0.8;        // of the skin, from here to where a search is made
constexpr double kStretchLeft = 1.1;  // of that way, for which near nodes serve at first
constexpr double kLargestTurn = 0.1;  // rad, until there

// The placement after the time dt with the same velocities; the deformation stays.
SurfaceMotion moved_on(const SurfaceMotion& motion, double dt) {
  return {motion.q, motion.r_WB + dt * motion.R_WB * motion.v_WB_B,
          motion.R_WB * rotation_matrix(dt * motion.w_WB_B)};
}

}  // namespace

// Measures the clearance of all candidates and leaves out those that cannot touch while the surfaces move by
// `limit`, and the faces that cannot be nearest. A node whose earlier clearance is not used up is not
// measured again. way_left: m, from where the surfaces are to where they are measured.
void Tracker::measure_clearance(double limit, double way_left) {
  NeighbourList& v = *neighbours_;
  const double soon = limit + limits_.outside;
  v.limit = limit;
  v.uses = 0;
  for (int slave : slave_sides(settings_)) {
    std::vector<double>& apart_until = v.apart_until[slave];
    for (int node : v.candidates[slave].nodes())
      apart_until[node] = std::max(apart_until[node], v.path + clear_until_[slave][node] - way_ - way_left);
    v.near[slave] = not_apart(v.candidates[slave], apart_until, v.path + soon);
  }
  for (int slave : slave_sides(settings_)) leave_out(slave, soon);
  v.within = std::exchange(v.near, {});
  take_near(kFirstStretch * limit);
  for (int i : {0, 1}) v.measured_at[i] = *now_[i];
  residual_since_measured_ = 0;
}

// Takes from the nodes within the limit those that can touch until the surfaces have moved by `distance`
// since the measurement.
void Tracker::take_near(double distance) {
  NeighbourList& v = *neighbours_;
  v.near_limit = distance;
  for (int slave : slave_sides(settings_))
    v.near[slave] = not_apart(v.within[slave], v.apart_until[slave], v.path + distance + limits_.outside);
}

// Leaves out the near nodes that have more clearance than `clear`. A node for which less than limits.outside
// serves has so much clearance more. Whichever side of the surface it is on, nothing comes of a node that is
// farther away than the depth limit. Most are so from the undeformed surface, however both are deformed, and
// are not displaced.
void Tracker::leave_out(int slave, double clear) {
  const Neighbours all = std::exchange(neighbours_->near[slave], {});
  const SurfaceView master = view(1 - slave, settings_.extension), placed = view(slave, 0);
  const FaceBounds bounds = face_bounds(1 - slave);
  const double around = settings_.points == SlavePoints::faces ? limits_.around : 0;
  const Move move{std::max(limits_.depth, limits_.outside) + settings_.skin, clear, around, &bounds};
  const RelativeMotion to_master = relative_motion(*now_[slave], *now_[1 - slave]);
  const double deformed = largest_deformation(slave) + bounds.deformed;
  Neighbours& near = neighbours_->near[slave];
  for (std::size_t i = 0; i < all.slave.size(); ++i) {
    const int node = all.slave[i];
    const Eigen::Vector3d undeformed = to_master.R * side_[slave].surface->X.col(node) + to_master.r;
    const double least = distance(boxes_[1 - slave], undeformed, all.faces(i)) - deformed,
                 surely_beyond = std::min(least, move.reach) - limits_.depth + limits_.outside;
    if (surely_beyond > clear) {
      neighbours_->apart_until[slave][node] = neighbours_->path + surely_beyond;
      continue;
    }
    const Approach found = approach(master, placed.at(node), move, all.faces(i));
    const double spare = slaves_[slave].spare.empty() ? 0 : slaves_[slave].spare[node];
    const double beyond = std::min(found.distance, move.reach) - limits_.depth + limits_.outside;
    const double surely_seen = std::min(found.clearance, settings_.skin + limits_.outside);
    neighbours_->apart_until[slave][node] = neighbours_->path + std::max(surely_seen + spare, beyond);
    if (std::max(found.clearance + spare, beyond) > clear) continue;
    near.add(node, found.faces, found.around);
  }
}

// Candidates within `margin` of each other where the nodes are placed now.
void Tracker::find_candidates(double margin) {
  const auto& face_pairs = search_.face_pairs(configuration_, margin);
  if (!neighbours_) neighbours_.emplace();
  neighbours_->path = 0;
  for (int slave : slave_sides(settings_)) {
    Candidates& candidates = neighbours_->candidates[slave];
    candidates.collect({face_pairs, slave, slaves_[slave].tried}, view(slave, 0),
                       view(1 - slave, settings_.extension), margin);
    neighbours_->near[slave] = everything(candidates);
    neighbours_->apart_until[slave].assign(static_cast<std::size_t>(configuration_.x[slave].cols()), 0);
  }
  ++n_searches_;
}

void Tracker::find_candidates() {
  const bool deformed = settings_.update == Update::refit;
  double margin = reach_ + settings_.skin;
  for (int i : {0, 1})
    if (!deformed) margin += largest_displacement(side_[i].bound, now_[i]->q);
  for (int i : {0, 1})
    if (residual_) margin += (*residual_)[i].largest;
  place(deformed);
  find_candidates(margin);
  residual_since_found_ = 0;
  for (int i : {0, 1}) neighbours_->found_at[i] = {now_[i]->q, now_[i]->r_WB, now_[i]->R_WB};
}

// The placements that both surfaces reach with their present velocities when their relative motion has used
// up kAhead of the skin; nothing where they do not move against each other.
std::optional<Tracker::Ahead> Tracker::motion_ahead() const {
  double speed = 0, spin = 0;  // m/s, of no point more; rad/s
  for (int i : {0, 1}) {
    const double w = now_[i]->w_WB_B.norm(), from_origin = side_[i].ball.centre.norm() + side_[i].ball.radius;
    speed += now_[i]->v_WB_B.norm() + w * from_origin;
    spin = std::max(spin, w);
  }
  if (!(speed > 0)) return {};
  Ahead ahead;
  double dt = kAhead * settings_.skin / speed;
  for (int round = 0; round < 2; ++round) {  // where both move alike the way is shorter by far
    for (int i : {0, 1}) ahead.motion[i] = moved_on(*now_[i], dt);
    ahead.way = distance_since(ahead.motion);
    if (!(ahead.way > 0)) return {};
    if (round == 0) dt = std::min(kAhead * settings_.skin / ahead.way * dt, kLargestTurn / spin);
  }
  return ahead.way < settings_.skin ? std::optional(std::move(ahead)) : std::nullopt;
}

// Searches and measures amid the way that lies ahead, so that both serve before that place and behind it.
void Tracker::search() {
  const std::optional<Ahead> ahead = neighbours_ ? motion_ahead() : std::nullopt;
  const SurfaceMotion* const now[2] = {now_[0], now_[1]};
  if (ahead) {
    for (int i : {0, 1}) now_[i] = &ahead->motion[i];
    start_look();
  }
  find_candidates();
  measure_clearance(ahead ? settings_.skin : next_limit(*neighbours_, 0, settings_.skin),
                    ahead ? ahead->way : 0);
  if (!ahead) return;
  std::copy(std::begin(now), std::end(now), std::begin(now_));
  start_look();
  take_near(std::min(kStretchLeft * ahead->way, neighbours_->limit));
}

// Brings the neighbour lists up to date.
void Tracker::update_neighbours() {
  const bool search_is_due =
      !neighbours_ || !(distance_since(neighbours_->found_at) + residual_since_found_ <= settings_.skin);
  const double distance =
      neighbours_ ? distance_since(neighbours_->measured_at) + residual_since_measured_ : 0;
  if (search_is_due) {
    search();
  } else if (!(distance <= neighbours_->limit)) {
    neighbours_->path += distance;
    measure_clearance(next_limit(*neighbours_, distance, settings_.skin), 0);
  } else if (distance > neighbours_->near_limit) {
    take_near(std::min(2 * distance, neighbours_->limit));
  } else if (neighbours_->near_limit > kFirstStretch * neighbours_->limit &&
             distance < kShrink * neighbours_->near_limit) {
    take_near(std::max(kFirstStretch * neighbours_->limit, 0.5 * neighbours_->near_limit));
  }
  ++neighbours_->uses;
}

}  // namespace elastogear::contact
