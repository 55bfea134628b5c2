#include "contact/search/coarse_search.h"

namespace elastogear::contact {

CoarseSearch::CoarseSearch(const model::Surface& a, const model::Surface& b, int k, Update update)
    : surface_{&a, &b}, update_(update), tree_{build(a.X, a.face, k), build(b.X, b.face, k)} {
  if (update_ != Update::realign) return;
  for (int node = 0; node < tree_[0].n_nodes(); ++node) rest_.push_back(box(tree_[0], node));
  visited_.assign(rest_.size(), 0);
}

void CoarseSearch::refit_both(const Configuration& configuration, double margin) {
  refit(tree_[0], configuration.x[0], surface_[0]->face, margin, refit_);
  refit(tree_[1], configuration.x[1], surface_[1]->face, 0, refit_);
}

// Realigns a node and its sibling (the root has none) the first time a call comes to them.
void CoarseSearch::realign_pair(int first, const Realignment& motion, double margin) {
  if (visited_[first] == call_) return;
  visited_[first] = call_;
  for (int node = first; node < first + (first == 0 ? 1 : 2); ++node)
    set_box(tree_[0], node, inflated(realigned(rest_[node], motion), margin));
}

const std::vector<NodePair>& CoarseSearch::face_pairs(const Configuration& configuration, double margin) {
  std::function<void(int)> visit;
  Realignment motion;
  if (update_ != Update::realign) {
    refit_both(configuration, margin);
  } else {  // b's tree stays as built: a's boxes take the whole margin
    ++call_;
    motion = realignment(tree_[0].k, configuration.R, configuration.r);
    visit = [&](int first) { realign_pair(first, motion, margin); };
  }
  overlapping_faces(tree_[0], tree_[1], visit, work_, pairs_);
  return pairs_;
}

}  // namespace elastogear::contact
