#include "contact/search/node_displacements.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kLeastSize = 500;       // of the coordinates; products with fewer cost less than combinations
constexpr std::size_t kMostStages = 9;  // two time steps with two Newton iterations each
constexpr Index kSamples = 96;          // coordinates from which weights are found
constexpr double kResolved = 64 * std::numeric_limits<double>::epsilon();
constexpr double kRank = 1e-8;  // stages that follow from others have no weight of their own
constexpr double kNoWeight = 1e-6;
constexpr double kMostWeight = 32;  // sum of sizes, which multiply roundoff
constexpr int kOldest = 48;         // successive combinations, whose roundoff adds up

// Weights of the columns, whose sum is 1, with the least sum of squares of what is left of q, each coordinate
// over its size; columns with weight 0 have none.
VectorXd weights(const Eigen::MatrixXd& columns, const VectorXd& q, const std::vector<Index>& used) {
  const VectorXd size = columns.cwiseAbs().rowwise().maxCoeff().cwiseMax(std::numeric_limits<double>::min());
  const VectorXd first = columns.col(used.front());
  Eigen::MatrixXd A(columns.rows(), static_cast<Index>(used.size()) - 1);
  for (Index j = 0; j < A.cols(); ++j)
    A.col(j) = (columns.col(used[static_cast<std::size_t>(j) + 1]) - first).cwiseQuotient(size);
  VectorXd weight = VectorXd::Zero(columns.cols());
  weight[used.front()] = 1;
  if (A.cols() == 0) return weight;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
  qr.setThreshold(kRank);
  const VectorXd x = qr.compute(A).solve((q - first).cwiseQuotient(size));
  for (Index j = 0; j < x.size(); ++j) weight[used[static_cast<std::size_t>(j) + 1]] = x[j];
  weight[used.front()] -= x.sum();
  return weight;
}

}  // namespace

NodeDisplacements::Stage NodeDisplacements::empty_stage() const {
  const Index n = surface_->X.cols();
  return {{}, Eigen::Matrix3Xd(3, n), std::vector<short>(static_cast<std::size_t>(n), -1), {}};
}

void NodeDisplacements::start(const VectorXd& q) {
  if (!stages_.empty() && stages_.front().q.size() == q.size() && stages_.front().q == q) return;
  weight_ = combination(q);
  const std::size_t most = q.size() < kLeastSize ? 1 : kMostStages;
  Stage stage;
  if (stages_.size() >= most) {
    stage = std::move(stages_.back());
    stages_.pop_back();
    for (int node : stage.nodes) stage.age[static_cast<std::size_t>(node)] = -1;
    stage.nodes.clear();
  } else {
    stage = empty_stage();
  }
  stage.q = q;
  stages_.push_front(std::move(stage));
}

// Weights of the stages that add up to q, to roundoff of each coordinate; empty where there are none.
VectorXd NodeDisplacements::combination(const VectorXd& q) const {
  const auto n = static_cast<Index>(std::min(stages_.size(), kMostStages - 1));
  if (q.size() < kLeastSize || n < 2) return {};
  Eigen::MatrixXd columns(kSamples, n);
  const auto samples = Eigen::seqN(Index{0}, kSamples, q.size() / kSamples);
  for (Index j = 0; j < n; ++j) columns.col(j) = stages_[static_cast<std::size_t>(j)].q(samples);
  std::vector<Index> used(static_cast<std::size_t>(n));
  std::iota(used.begin(), used.end(), Index{0});
  VectorXd weight = weights(columns, q(samples), used);
  std::erase_if(used, [&](Index j) { return std::abs(weight[j]) < kNoWeight; });
  if (used.empty()) return {};
  if (used.size() < static_cast<std::size_t>(n)) weight = weights(columns, q(samples), used);
  if (!(weight.cwiseAbs().sum() <= kMostWeight)) return {};  // a coordinate that was zero has no finite ones
  VectorXd left = q, size = VectorXd::Zero(q.size());
  for (Index j : used) {
    const VectorXd& then = stages_[static_cast<std::size_t>(j)].q;
    left -= weight[j] * then;
    size += std::abs(weight[j]) * then.cwiseAbs();
  }
  if (!(left.cwiseAbs().array() <= kResolved * size.array()).all()) return {};
  return weight;
}

void NodeDisplacements::enter(Stage& stage, int node, const Eigen::Vector3d& u, int age) {
  stage.u.col(node) = u;
  stage.age[static_cast<std::size_t>(node)] = static_cast<short>(age);
  stage.nodes.push_back(node);
}

// Displaces a node by the displacements of earlier stages, if it has been displaced in all of them.
bool NodeDisplacements::combine(int node) {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  int oldest = -1;
  for (Index j = 0; j < weight_.size(); ++j) {
    if (weight_[j] == 0) continue;
    const Stage& then = stages_[static_cast<std::size_t>(j) + 1];
    const int age = then.age[static_cast<std::size_t>(node)];
    if (age < 0 || age >= kOldest) return false;
    oldest = std::max(oldest, age);
    u += weight_[j] * then.u.col(node);
  }
  if (oldest < 0) return false;
  enter(stages_.front(), node, u, oldest + 1);
  return true;
}

Eigen::Vector3d NodeDisplacements::at(int node) {
  Stage& stage = stages_.front();
  if (!has(node) && !combine(node)) enter(stage, node, model::displacement(surface_->Phi, node, stage.q), 0);
  return stage.u.col(node);
}

void NodeDisplacements::serialize(Archive& archive) {
  auto n = static_cast<Index>(stages_.size());
  archive(n);
  archive(weight_);
  if (archive.is_loading()) stages_.clear();
  for (Index j = 0; j < n; ++j) {
    if (archive.is_loading()) stages_.push_back(empty_stage());
    Stage& stage = stages_[static_cast<std::size_t>(j)];
    archive(stage.q);
    std::vector<int> nodes = stage.nodes;
    archive(nodes);
    for (int node : nodes) {
      require(node >= 0 && node < surface_->X.cols(), "the stored state does not fit this run");
      Eigen::Vector3d u = stage.u.col(node);
      int age = stage.age[static_cast<std::size_t>(node)];
      archive(u);
      archive(age);
      if (archive.is_loading()) enter(stage, node, u, age);
    }
  }
}

}  // namespace elastogear::contact
