#include "dynamics/creep/contact_print.h"

#include <cmath>
#include <utility>

namespace elastogear::dynamics {
using body::CreepState;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ContactPrint::ContactPrint(const body::CreepLaws& laws) {
  if (!laws.creeps()) return;
  n_each_ = laws.n_columns() / laws.size();
  start_.assign(static_cast<std::size_t>(laws.size()), MatrixXd::Identity(n_each_, n_each_));
  step_ = point_ = start_;
  gram_.assign(start_.size(), MatrixXd::Zero(n_each_, n_each_));
  largest_ = VectorXd::Zero(laws.n_columns());
  remember_lag();
}

CreepState ContactPrint::product(const CreepState& gathered, const Matrices& by) const {
  CreepState result(3, gathered.cols());
  for (Index j = 0; j < static_cast<Index>(by.size()); ++j)
    result.middleCols(j * n_each_, n_each_) =
        gathered.middleCols(j * n_each_, n_each_).lazyProduct(by[static_cast<std::size_t>(j)]);
  return result;
}

// psi of a state without a force is what it lags.
VectorXd ContactPrint::lag_weights() const {
  VectorXd weights(n_each_ * static_cast<Index>(point_.size()));
  for (Index j = 0; j < static_cast<Index>(point_.size()); ++j)
    weights.segment(j * n_each_, n_each_) = point_[static_cast<std::size_t>(j)].col(0);
  return weights;
}

Eigen::Vector3d ContactPrint::lag(const CreepState& gathered) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Index j = 0; j < static_cast<Index>(point_.size()); ++j)
    sum += gathered.middleCols(j * n_each_, n_each_).lazyProduct(point_[static_cast<std::size_t>(j)].col(0));
  return sum;
}

void ContactPrint::set_point(const body::CreepLaws& laws) {
  for (std::size_t j = 0; j < step_.size(); ++j) {
    step_[j] = laws[static_cast<Index>(j)].free_step();
    point_[j] = start_[j] * step_[j];
  }
}

double ContactPrint::twice_energy(const body::CreepLaws& laws) const {
  double sum = 0;
  for (std::size_t j = 0; j < gram_.size() && !force_.empty(); ++j)
    sum += laws[static_cast<Index>(j)].twice_energy(point_[j].transpose() * gram_[j] * point_[j]);
  return sum;
}

double ContactPrint::loss(const body::CreepLaws& laws) const {
  double sum = 0;
  for (std::size_t j = 0; j < gram_.size() && !force_.empty(); ++j)
    sum += laws[static_cast<Index>(j)].free_loss(start_[j].transpose() * gram_[j] * start_[j]);
  return sum;
}

ContactPrint::Lag ContactPrint::lag_product() const {
  Lag lag;
  const VectorXd now = lag_weights(), change = now - last_lag_;
  for (Index j = 0; j < static_cast<Index>(gram_.size()); ++j) {
    const MatrixXd& G = gram_[static_cast<std::size_t>(j)];
    const auto h = now.segment(j * n_each_, n_each_), dh = change.segment(j * n_each_, n_each_);
    lag.all += std::abs(h.dot(G * h));
    lag.change += std::abs(dh.dot(G * dh));
  }
  return lag;
}

ContactPrint::Lag ContactPrint::lag_bound() const {
  const VectorXd now = lag_weights();
  return {largest_.dot(now.cwiseAbs()), largest_.dot((now - last_lag_).cwiseAbs())};
}

void ContactPrint::renew(double least) {
  for (auto& [node, force] : force_) force = product(force, start_);
  std::erase_if(force_, [&](const auto& entry) { return entry.second.cwiseAbs().maxCoeff() < least; });
  for (std::size_t j = 0; j < start_.size(); ++j) {
    auto largest = largest_.segment(static_cast<Index>(j) * n_each_, n_each_);
    largest = (start_[j].cwiseAbs().transpose() * largest).eval();
    gram_[j] = (start_[j].transpose() * gram_[j] * start_[j]).eval();
    start_[j].setIdentity();
    point_[j] = step_[j];
  }
  remember_lag();
}

void ContactPrint::add(const Entry& entry) {
  const auto [at, is_new] = force_.try_emplace(entry.node, entry.force);
  if (!is_new) at->second += entry.force;
  for (Index j = 0; j < static_cast<Index>(gram_.size()); ++j) {
    const auto of = [&](const CreepState& state) { return state.middleCols(j * n_each_, n_each_); };
    const MatrixXd half = of(entry.force).transpose() * (of(entry.by_print) + 0.5 * of(entry.by_entries));
    gram_[static_cast<std::size_t>(j)] += half + half.transpose();
  }
  largest_ = largest_.cwiseMax(entry.by_all.colwise().norm().transpose());
}

void ContactPrint::serialize(Archive& archive) {
  std::vector<int> nodes;
  for (const auto& [node, force] : force_) nodes.push_back(node);
  if (archive.is_loading()) force_.clear();
  archive(nodes);
  for (int node : nodes) archive(force_[node]);
  for (Matrices* matrices : {&start_, &gram_}) archive(*matrices);
  archive(last_lag_);
  archive(largest_);
}

}  // namespace elastogear::dynamics
