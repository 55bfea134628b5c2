// The Tracker's state beyond one look at the surfaces: displaced nodes of the last one, ways and clearances,
// and checkpoints.
#include <algorithm>

#include "contact/search/tracker.h"
#include "contact/settings.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::contact {
namespace {

void serialize_motion(SurfaceMotion (&motion)[2], const std::array<Tracked, 2>& side, Archive& archive) {
  for (int i : {0, 1}) {
    archive(motion[i].q);
    archive(motion[i].r_WB);
    archive(motion[i].R_WB);
    validate(motion[i], *side[i].surface, i);
  }
}

}  // namespace

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
  measure_clearance(then.limit);
  take_near(then.near_limit);
  neighbours_->uses = then.uses;
  std::fill_n(now_, 2, nullptr);
}

}  // namespace elastogear::contact
