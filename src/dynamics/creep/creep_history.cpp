#include "dynamics/creep/creep_history.h"

#include <algorithm>
#include <utility>

#include "elastogear/base/sort_unique.h"

namespace elastogear::dynamics {
using body::CreepState;
using Eigen::Index, Eigen::Vector3d;

namespace {

Vector3d force_on(const NodalForces& forces, int node) {
  const auto at = std::lower_bound(forces.node.begin(), forces.node.end(), node);
  if (at == forces.node.end() || *at != node) return Vector3d::Zero();
  return forces.f_B.col(at - forces.node.begin());
}

constexpr long kSteps = 32;           // accepted, from one gathering to the next
constexpr double kForgotten = 1e-16;  // of the largest force in the history: a state that has decayed

}  // namespace

CreepHistory::CreepHistory(const std::vector<body::RelaxationLaw>& laws, std::size_t n_nodes)
    : laws_(laws), print_(laws_), fields_(laws_.creeps() ? n_nodes : 0) {}

CreepHistory::Field& CreepHistory::field(int node, const Response& response) {
  Field& field = fields_[static_cast<std::size_t>(node)];
  if (field.by_recent.cols() > 0) return field;
  field.by_recent = field.by_print = CreepState::Zero(3, laws_.n_columns());
  for (const auto& [b, recent] : recent_) field.by_recent += response.displaced_by(node, b, recent.force);
  for (const auto& [b, force] : print_.force()) field.by_print += response.displaced_by(node, b, force);
  field.asked_at = n_accepted_;
  known_.push_back(node);
  return field;
}

Vector3d CreepHistory::lag(int node, const Response& response) {
  if (empty()) return Vector3d::Zero();
  Field& own = field(node, response);
  own.asked_at = n_accepted_;
  return laws_.lag(own.by_recent) + print_.lag(own.by_print);
}

Vector3d CreepHistory::displaced_at_start(int node, const Response& response) {
  if (empty()) return Vector3d::Zero();
  const Field& own = field(node, response);
  return laws_.sum(own.by_recent) + laws_.sum(print_.at_start(own.by_print));
}

CreepHistory::Lag CreepHistory::set_point(body::Moduli moduli, const body::StepPoint& at,
                                          const Response& response) {
  laws_.set_point(moduli, at);
  print_.set_point(laws_);
  return remember_lags(response);
}

// The forces in the print and the others displace each other by the same work, for D is symmetric.
CreepHistory::Lag CreepHistory::remember_lags(const Response& response) {
  const ContactPrint::Lag product = print_.lag_product(), bound = print_.lag_bound();
  Lag lag{product.all, product.change, bound.all, bound.change};
  for (auto& [node, recent] : recent_) {
    const Field& own = field(node, response);
    const Vector3d h = laws_.lag(recent.force), by_recent = laws_.lag(own.by_recent),
                   by_print = print_.lag(own.by_print), dh = h - recent.lag,
                   d_recent = by_recent - recent.by_recent, d_print = by_print - recent.by_print;
    lag.product += std::abs(h.dot(by_recent)) + 2 * std::abs(h.dot(by_print));
    lag.product_change += std::abs(dh.dot(d_recent)) + 2 * std::abs(dh.dot(d_print));
    lag.largest = std::max(lag.largest, (by_recent + by_print).norm());
    lag.largest_change = std::max(lag.largest_change, (d_recent + d_print).norm());
    recent.lag = h;
    recent.by_recent = by_recent;
    recent.by_print = by_print;
  }
  print_.remember_lag();
  return lag;
}

void CreepHistory::accept(const NodalForces& forces, const Response& response) {
  ++n_accepted_;
  const CreepState zero = CreepState::Zero(3, laws_.n_columns());
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    if (forces.f_B.col(static_cast<Index>(i)).isZero(0)) continue;
    const int node = forces.node[i];
    if (!recent_.contains(node)) {
      const Field& own = field(node, response);
      recent_[node] = {zero, zero.col(0), laws_.lag(own.by_recent), print_.lag(own.by_print), 0};
    }
    recent_[node].loaded_at = n_accepted_;
  }
  for (const auto& [node, recent] : recent_) field(node, response);
  std::vector<CreepState> before;
  for (int node : known_) {
    CreepState& by_recent = fields_[static_cast<std::size_t>(node)].by_recent;
    before.push_back(std::exchange(by_recent, laws_.displaced_state(by_recent, response.displaced(node))));
  }
  std::vector<const CreepState*> field_before(fields_.size());
  for (std::size_t i = 0; i < known_.size(); ++i)
    field_before[static_cast<std::size_t>(known_[i])] = &before[i];
  for (auto& [node, recent] : recent_) {
    const CreepState then = std::exchange(recent.force, laws_.state(recent.force, force_on(forces, node)));
    const Field& own = fields_[static_cast<std::size_t>(node)];
    const CreepState from = print_.at_start(own.by_print), to = print_.at_point(own.by_print);
    loss_ +=
        laws_.loss({then, recent.force}, {*field_before[static_cast<std::size_t>(node)], own.by_recent}) +
        laws_.loss({then, recent.force}, {from, to}) + laws_.loss({from, to}, {then, recent.force});
  }
  loss_ += print_.loss(laws_);
  print_.accept();
}

double CreepHistory::twice_energy(const NodalForces& forces, const Response& response) {
  std::vector<int> nodes = forces.node;
  for (const auto& [node, recent] : recent_) nodes.push_back(node);
  sort_unique(nodes);
  double twice = print_.twice_energy(laws_);
  for (int node : nodes) {
    const auto at = recent_.find(node);
    const Field& own = field(node, response);
    const CreepState force = laws_.state(at == recent_.end() ? CreepState() : at->second.force,
                                         force_on(forces, node)),
                     by_recent = laws_.displaced_state(own.by_recent, response.displaced(node)),
                     by_print = print_.at_point(own.by_print);
    twice += laws_.twice_energy(force, by_recent) + laws_.twice_energy(force, by_print) +
             laws_.twice_energy(by_print, force);
  }
  return twice;
}

double CreepHistory::least_force() const {
  double largest = 0;
  for (const auto& [node, recent] : recent_) largest = std::max(largest, recent.force.cwiseAbs().maxCoeff());
  for (const auto& [node, force] : print_.force()) largest = std::max(largest, force.cwiseAbs().maxCoeff());
  return kForgotten * largest;
}

CreepState CreepHistory::displaced_by(int a, const std::vector<int>& nodes, const Response& response) const {
  CreepState sum = CreepState::Zero(3, laws_.n_columns());
  for (int b : nodes) sum += response.displaced_by(a, b, recent_.at(b).force);
  return sum;
}

void CreepHistory::gather(const Response& response) {
  if (n_accepted_ % kSteps != 1) return;  // after the first step, too: a run may begin with many nodes
  const long before = n_accepted_ - kSteps;
  std::vector<int> left;
  for (const auto& [node, recent] : recent_)
    if (recent.loaded_at <= before) left.push_back(node);
  for (int node : known_) {
    CreepState& by_print = fields_[static_cast<std::size_t>(node)].by_print;
    by_print = print_.at_start(by_print);
  }
  print_.renew(least_force());
  std::vector<ContactPrint::Entry> entries;
  for (int node : left) {
    const Field& own = fields_[static_cast<std::size_t>(node)];
    entries.push_back({node, recent_.at(node).force, own.by_print, displaced_by(node, left, response),
                       own.by_recent + own.by_print});
  }
  const auto is_needed = [&](int node) {
    return fields_[static_cast<std::size_t>(node)].asked_at > before ||
           (recent_.contains(node) && !std::binary_search(left.begin(), left.end(), node));
  };
  std::vector<int> needed;
  for (int node : known_) {
    Field& own = fields_[static_cast<std::size_t>(node)];
    if (!is_needed(node)) {
      own = {};
      continue;
    }
    needed.push_back(node);
    const CreepState moved = displaced_by(node, left, response);
    own.by_recent -= moved;
    own.by_print += moved;
  }
  known_ = std::move(needed);
  for (const ContactPrint::Entry& entry : entries) print_.add(entry);
  for (int node : left) recent_.erase(node);
  remember_lags(response);
}

void CreepHistory::get(model::RelaxedState& state) const {
  std::map<int, CreepState> all;
  for (const auto& [node, force] : print_.force()) all[node] = print_.at_start(force);
  for (const auto& [node, recent] : recent_) {
    const auto [at, is_new] = all.try_emplace(node, recent.force);
    if (!is_new) at->second += recent.force;
  }
  state.node.clear();
  state.force.resize(3, laws_.n_columns() * static_cast<Index>(all.size()));
  for (const auto& [node, force] : all) {
    state.force.middleCols(laws_.n_columns() * static_cast<Index>(state.node.size()), laws_.n_columns()) =
        force;
    state.node.push_back(node);
  }
}

void CreepHistory::set(const model::RelaxedState& state) {
  recent_.clear();
  const Index n = laws_.n_columns();
  for (std::size_t i = 0; i < state.node.size(); ++i)
    recent_[state.node[i]] = {state.force.middleCols(n * static_cast<Index>(i), n), Vector3d::Zero(),
                              Vector3d::Zero(), Vector3d::Zero(), -kSteps};
}

void CreepHistory::serialize(Archive& archive) {
  std::vector<int> nodes;
  for (const auto& [node, recent] : recent_) nodes.push_back(node);
  if (archive.is_loading()) {
    recent_.clear();
    fields_.assign(fields_.size(), {});
  }
  archive(nodes);
  archive(known_);
  archive(n_accepted_);
  archive(loss_);
  for (int node : nodes) {
    Recent& recent = recent_[node];
    archive(recent.force);
    archive(recent.loaded_at);
    for (Vector3d* lag : {&recent.lag, &recent.by_recent, &recent.by_print}) archive(*lag);
  }
  for (int node : known_) {
    Field& own = fields_[static_cast<std::size_t>(node)];
    archive(own.by_recent);
    archive(own.by_print);
    archive(own.asked_at);
  }
  print_.serialize(archive);
}

}  // namespace elastogear::dynamics
