#include "dynamics/contact/residual_flexibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::dynamics {
namespace {

constexpr std::size_t kMostBlocks = 4'000'000;  // that are kept: 288 MB

const model::DenseRows& modes(const model::ElasticBody& body) {
  return std::get<model::DenseRows>(body.surface.Phi);
}

// A B' of three rows each, n numbers one after the other. All nine sums at once: every number is read once.
Eigen::Matrix3d product(const double* A, const double* B, Eigen::Index n) {
  using Two = Eigen::Array2d;
  Two sum[3][3];
  for (auto& row : sum) std::fill(std::begin(row), std::end(row), Two(Two::Zero()));
  for (Eigen::Index k = 0; k + 1 < n; k += 2)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sum[i][j] += Eigen::Map<const Two>(A + i * n + k) * Eigen::Map<const Two>(B + j * n + k);
  Eigen::Matrix3d AB;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      AB(i, j) = sum[i][j].sum() + (n % 2 == 1 ? A[i * n + n - 1] * B[j * n + n - 1] : 0);
  return AB;
}

}  // namespace

ResidualFlexibility::ResidualFlexibility(const model::ElasticBody& body)
    : body_(&body),
      largest_(body.flexibility.empty() ? 0 : body.flexibility.self.maxCoeff()),
      rows_(body.surface.node.size()) {}

int ResidualFlexibility::number(int node) {
  const auto [at, is_new] = number_of_.emplace(node, -1);
  if (!is_new) return at->second;
  const int position = model::find_loaded(body_->flexibility, node);
  if (position < 0) return -1;
  at->second = static_cast<int>(loaded_.size());
  const int orbit = body_->flexibility.surface.orbit[position];
  if (!columns_.contains(orbit)) columns_[orbit] = model::displacement_columns(body_->flexibility, orbit);
  loaded_.push_back(
      {position, &columns_.at(orbit),
       modes(*body_).middleRows<3>(3 * node) * body_->K_r.diagonal().cwiseInverse().asDiagonal()});
  return at->second;
}

ResidualFlexibility::Row& ResidualFlexibility::row(int node) {
  std::vector<Eigen::Matrix3d>& R = rows_[node].R;
  if (R.size() == loaded_.size()) return rows_[node];
  if (n_rows_ * loaded_.size() > kMostBlocks) {
    n_rows_ = 0;
    for (Row& row : rows_) row = Row();
  }
  n_rows_ += R.empty();
  R.resize(loaded_.size(), Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  return rows_[node];
}

// Block R(a, b) of the node with this number. It is the same to the bit whenever it is computed.
const Eigen::Matrix3d& ResidualFlexibility::block(Row& row, int a, int number) {
  Eigen::Matrix3d& R = row.R[number];
  if (!std::isnan(R(0, 0))) return R;
  const int position = model::find_loaded(body_->flexibility, a);
  if (position < 0) return R = Eigen::Matrix3d::Zero();
  const auto& [b, F, Phi_over_Lambda] = loaded_[number];
  R = model::displacement_response(body_->flexibility, position, b, *F);
  R -= product(modes(*body_).row(3 * a).data(), Phi_over_Lambda.data(), Phi_over_Lambda.cols());
  return R;
}

void ResidualFlexibility::set_forces(const NodalForces& forces) {
  if (forces.node != forces_.node) {
    ++n_changes_;
    numbers_.clear();
    for (int node : forces.node) numbers_.push_back(number(node));
  }
  forces_ = forces;
}

// Copies the blocks of one row into contiguous memory, because all nodes that may touch are asked for at
// every stage.
void ResidualFlexibility::pack(Row& row, int a) {
  row.packed.setZero(3, 3 * static_cast<Eigen::Index>(numbers_.size()));
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    if (numbers_[i] >= 0)
      row.packed.middleCols<3>(static_cast<Eigen::Index>(3 * i)) = block(row, a, numbers_[i]);
  row.packed_at = n_changes_;
}

Eigen::Vector3d ResidualFlexibility::displacement(int node) {
  if (numbers_.empty()) return Eigen::Vector3d::Zero();
  Row& known = row(node);
  if (known.packed_at != n_changes_) pack(known, node);
  const Eigen::Map<const Eigen::VectorXd> f(forces_.f_B.data(), forces_.f_B.size());
  return {known.packed.row(0).dot(f), known.packed.row(1).dot(f), known.packed.row(2).dot(f)};
}

// |R(a, :) f|^2 <= |R(a, a)| f'R f, because R is positive semidefinite, and |R(a, a)| <= |F(a, a)|.
double ResidualFlexibility::bound(const NodalForces& forces) {
  const std::vector<int>& known = among_[0].node;
  if (!std::includes(known.begin(), known.end(), forces.node.begin(), forces.node.end())) among(forces.node);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(among_[0].R.rows());
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    const auto at = std::lower_bound(known.begin(), known.end(), forces.node[i]) - known.begin();
    f.segment<3>(3 * at) = forces.f_B.col(static_cast<Eigen::Index>(i));
  }
  return std::sqrt(largest_ * std::max(0.0, f.dot(among_[0].R * f)));
}

const Eigen::MatrixXd& ResidualFlexibility::among(const std::vector<int>& node) {
  if (node == among_[0].node) return among_[0].R;
  std::swap(among_[0], among_[1]);
  if (node == among_[0].node) return among_[0].R;
  const auto n = static_cast<Eigen::Index>(node.size());
  std::vector<int> numbers;
  for (int i : node) numbers.push_back(number(i));
  among_[0].node = node;
  Eigen::MatrixXd& R = among_[0].R;
  R.setZero(3 * n, 3 * n);
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
