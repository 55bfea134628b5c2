#include "elastogear/dynamics/residual_flexibility.h"

#include <cmath>
#include <limits>

namespace elastogear::dynamics {
namespace {

constexpr std::size_t kMostBlocks = 4'000'000;  // that are kept: 288 MB

const model::DenseRows& modes(const model::ElasticBody& body) {
  return std::get<model::DenseRows>(body.surface.Phi);
}

}  // namespace

ResidualFlexibility::ResidualFlexibility(const model::ElasticBody& body) : body_(&body) {
  for (std::size_t i = 0; i < body.flexibility.node.size(); ++i) {
    diagonal_.push_back(diagonal(static_cast<int>(i)));
    largest_ = std::max(largest_, diagonal_.back());
  }
}

double ResidualFlexibility::diagonal(int position) const {
  const auto Phi = modes(*body_).middleRows<3>(3 * body_->flexibility.node[position]);
  return (model::answer(body_->flexibility, position, position) -
          Phi * body_->K_r.diagonal().cwiseInverse().asDiagonal() * Phi.transpose())
      .norm();
}

int ResidualFlexibility::number(int node) {
  const auto [at, is_new] = number_of_.emplace(node, -1);
  if (!is_new) return at->second;
  const int position = model::find_loaded(body_->flexibility, node);
  if (position < 0) return -1;
  at->second = static_cast<int>(loaded_.size());
  loaded_.push_back(
      {position, modes(*body_).middleRows<3>(3 * node) * body_->K_r.diagonal().cwiseInverse().asDiagonal()});
  return at->second;
}

ResidualFlexibility::Row& ResidualFlexibility::row(int node) {
  if (rows_.size() * loaded_.size() > kMostBlocks) rows_.clear();
  Row& row = rows_[node];
  row.resize(loaded_.size(), Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  return row;
}

// The same to the bit whenever it is worked out.
const Eigen::Matrix3d& ResidualFlexibility::block(Row& row, int a, int number) {
  Eigen::Matrix3d& R = row[number];
  if (!std::isnan(R(0, 0))) return R;
  const int position = model::find_loaded(body_->flexibility, a);
  if (position < 0) return R = Eigen::Matrix3d::Zero();
  const auto& [b, Phi_over_Lambda] = loaded_[number];
  R = model::answer(body_->flexibility, position, b);
  R -= modes(*body_).middleRows<3>(3 * a).lazyProduct(Phi_over_Lambda.transpose());
  return R;
}

void ResidualFlexibility::set_forces(const NodalForces& forces) {
  forces_ = forces;
  numbers_.clear();
  for (int node : forces.node) numbers_.push_back(number(node));
}

Eigen::Vector3d ResidualFlexibility::displacement(int node) {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  if (numbers_.empty()) return w;
  Row& known = row(node);
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    if (numbers_[i] >= 0)
      w += block(known, node, numbers_[i]) * forces_.f_B.col(static_cast<Eigen::Index>(i));
  return w;
}

// |R(a, b)|^2 <= |R(a, a)| |R(b, b)|, because R is positive semidefinite.
double ResidualFlexibility::bound(const NodalForces& forces) const {
  double sum = 0;
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    const int position = model::find_loaded(body_->flexibility, forces.node[i]);
    if (position >= 0)
      sum += std::sqrt(largest_ * diagonal_[position]) * forces.f_B.col(static_cast<Eigen::Index>(i)).norm();
  }
  return sum;
}

Eigen::MatrixXd ResidualFlexibility::among(const std::vector<int>& node) {
  const auto n = static_cast<Eigen::Index>(node.size());
  std::vector<int> numbers;
  for (int i : node) numbers.push_back(number(i));
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Row& known = row(node[i]);
    for (Eigen::Index j = 0; j <= i; ++j)
      if (numbers[j] >= 0) R.block<3, 3>(3 * i, 3 * j) = block(known, node[i], numbers[j]);
    for (Eigen::Index j = 0; j < i; ++j)
      R.block<3, 3>(3 * j, 3 * i) = R.block<3, 3>(3 * i, 3 * j).transpose();
  }
  return R;
}

}  // namespace elastogear::dynamics
