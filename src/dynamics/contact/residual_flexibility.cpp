#include "dynamics/contact/residual_flexibility.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::dynamics {
using body::CreepState;

namespace {

constexpr std::size_t kMostBlocks = 4'000'000;  // that are kept: 288 MB

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
      history_(body::creep_laws(body), body.surface.node.size()),
      rows_(body.surface.node.size()) {
  const model::Flexibility& flexibility = body.flexibility;
  if (flexibility.empty()) return;
  set_bounds();
  if (relaxes_alike()) return;
  C_ = body::creep_coefficients(flexibility);
  for (const model::RelaxedResponse& relaxed : flexibility.relaxed)
    states_.push_back({body::relaxed_stiffness(body, relaxed.share)
                           .llt()
                           .solve(Eigen::MatrixXd::Identity(body.n_q(), body.n_q()))});
}

// The static response grows as the body relaxes: the largest is that of a state.
void ResidualFlexibility::set_bounds() {
  const model::Flexibility& flexibility = body_->flexibility;
  largest_ = largest_R_0_ = flexibility.self.maxCoeff();
  if (!laws().creeps()) return;
  if (relaxes_alike()) largest_ *= 1 + laws()[0].long_term();
  for (const model::RelaxedResponse& relaxed : flexibility.relaxed)
    largest_ = std::max(largest_, relaxed.self.maxCoeff());
}

const ResidualFlexibility::Columns& ResidualFlexibility::columns(int orbit) {
  const auto [at, is_new] = columns_.try_emplace(orbit);
  if (is_new) at->second = model::displacement_columns(body_->flexibility, orbit);
  return at->second;
}

int ResidualFlexibility::number(int node) {
  const auto [at, is_new] = number_of_.emplace(node, -1);
  if (!is_new) return at->second;
  const model::Flexibility& flexibility = body_->flexibility;
  const int position = model::find_loaded(flexibility, node);
  if (position < 0) return -1;
  at->second = static_cast<int>(loaded_.size());
  const int orbit = flexibility.surface.orbit[position];
  const auto Phi =
      Eigen::Map<const model::DenseRows>(model::node_rows(body_->surface.Phi, node), 3, body_->n_q());
  loaded_.push_back(
      {position, {&columns(orbit), Phi * body_->K_r.diagonal().cwiseInverse().asDiagonal()}, {}});
  for (std::size_t k = 0; k < states_.size(); ++k) {
    auto& [K_inverse, columns] = states_[k];
    if (!columns.contains(orbit)) columns[orbit] = model::displacement_columns(flexibility.relaxed[k], orbit);
    loaded_.back().relaxed.push_back({&columns.at(orbit), Phi * K_inverse});
  }
  return at->second;
}

ResidualFlexibility::Row& ResidualFlexibility::row(int node) {
  std::vector<Eigen::Matrix3d>& R = rows_[node].R;
  if (R.size() == loaded_.size()) return rows_[node];
  if (n_rows_ * loaded_.size() * (1 + states_.size()) > kMostBlocks) {
    n_rows_ = 0;
    for (Row& row : rows_) row = Row();
  }
  n_rows_ += R.empty();
  R.resize(loaded_.size(), Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  if (!relaxes_alike()) rows_[node].D.resize(loaded_.size());
  return rows_[node];
}

Eigen::Matrix3d ResidualFlexibility::residual(int a, const Response& b, int position_b) const {
  const int position = model::find_loaded(body_->flexibility, a);
  if (position < 0) return Eigen::Matrix3d::Zero();
  return model::displacement_response(body_->flexibility, position, position_b, *b.F) -
         product(model::node_rows(body_->surface.Phi, a), b.Phi_over_K.data(), b.Phi_over_K.cols());
}

// Block R_0(a, b) of the node with this number. It is the same to the bit whenever it is computed.
const Eigen::Matrix3d& ResidualFlexibility::block(Row& row, int a, int number) {
  Eigen::Matrix3d& R = row.R[number];
  if (std::isnan(R(0, 0))) R = residual(a, loaded_[number].response, loaded_[number].position);
  return R;
}

// Blocks D_j(a, b) of a viscoelastic body in different ratios. Eq. (2.23).
ResidualFlexibility::Blocks ResidualFlexibility::creep_blocks(int a, const Loaded& b,
                                                              const Eigen::Matrix3d& R_0) const {
  Blocks D = Blocks::Zero(3, 3 * laws().size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const Eigen::Matrix3d grown = residual(a, b.relaxed[k], b.position) - R_0;
    for (Eigen::Index j = 0; j < laws().size(); ++j)
      D.middleCols<3>(3 * j) += C_(static_cast<Eigen::Index>(k) + 1, j + 1) * grown;
  }
  return D;
}

const ResidualFlexibility::Blocks& ResidualFlexibility::creep_blocks(Row& row, int a, int number) {
  Blocks& D = row.D[number];
  if (D.cols() == 0) D = creep_blocks(a, loaded_[number], block(row, a, number));
  return D;
}

// Block of what forces add to R_0 within the step. Eq. (6.34).
Eigen::Matrix3d ResidualFlexibility::at_once(Row& row, int a, int number) {
  if (relaxes_alike()) return laws()[0].at_once() * block(row, a, number);
  const Blocks& D = creep_blocks(row, a, number);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Eigen::Index j = 0; j < laws().size(); ++j) sum += laws()[j].at_once() * D.middleCols<3>(3 * j);
  return sum;
}

void ResidualFlexibility::set_forces(const NodalForces& forces) {
  bearing_.clear();
  for (std::size_t i = 0; i < forces.node.size(); ++i) {
    const Eigen::Vector3d f = forces.f_B.col(static_cast<Eigen::Index>(i));
    const int loaded = number(forces.node[i]);
    if (loaded >= 0 && !f.isZero(0)) bearing_.push_back({loaded, f});
  }
  forces_ = forces;
}

ResidualFlexibility::Displaced ResidualFlexibility::displaced(int node) {
  Displaced by{Eigen::Vector3d::Zero(), Eigen::Matrix3Xd::Zero(3, laws().size())};
  if (bearing_.empty()) return by;
  Row& known = row(node);
  for (const Bearing& b : bearing_) by.by_R += block(known, node, b.number) * b.f;
  if (relaxes_alike()) {
    by.by_D.colwise() = by.by_R;
    return by;
  }
  for (const Bearing& b : bearing_) {
    const Blocks& D = creep_blocks(known, node, b.number);
    for (Eigen::Index j = 0; j < laws().size(); ++j) by.by_D.col(j) += D.middleCols<3>(3 * j) * b.f;
  }
  return by;
}

// Eq. (6.34).
Eigen::Vector3d ResidualFlexibility::displacement(int node) {
  const auto [by_R, by_D] = displaced(node);
  if (!laws().creeps()) return by_R;
  Eigen::Vector3d w = by_R;
  for (Eigen::Index j = 0; j < laws().size(); ++j) w += laws()[j].at_once() * by_D.col(j);
  return w + lag(node);
}

Eigen::Vector3d ResidualFlexibility::lag(int node) {
  return creeps() ? history_.lag(node, response()) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

CreepHistory::Response ResidualFlexibility::response() {
  return {[this](int a, int b, const CreepState& force) { return displaced_by(a, b, force); },
          [this](int node) { return displaced(node).by_D; }};
}

// D_j(a, b) times a state of forces. Blocks are found for this alone: they are asked for once.
CreepState ResidualFlexibility::displaced_by(int a, int b, const CreepState& force) {
  const int i = number(b);
  if (i < 0) return CreepState::Zero(3, force.cols());
  const Eigen::Matrix3d R_0 = residual(a, loaded_[i].response, loaded_[i].position);
  if (relaxes_alike()) return R_0 * force;
  const Blocks D = creep_blocks(a, loaded_[i], R_0);
  CreepState displaced(3, force.cols());
  const Eigen::Index n = force.cols() / laws().size();
  for (Eigen::Index j = 0; j < laws().size(); ++j)
    displaced.middleCols(j * n, n) = D.middleCols<3>(3 * j) * force.middleCols(j * n, n);
  return displaced;
}

// R_0 - sum_j D_j, of what stays as it is.
Eigen::Matrix3d ResidualFlexibility::never_creeping(Row& row, int a, int number) {
  if (relaxes_alike()) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rest = block(row, a, number);
  const Blocks& D = creep_blocks(row, a, number);
  for (Eigen::Index j = 0; j < laws().size(); ++j) rest -= D.middleCols<3>(3 * j);
  return rest;
}

// |R(a, :) f|^2 <= |R(a, a)| f'R f, because R is positive semidefinite.
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
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (numbers[j] < 0) continue;
      R.block<3, 3>(3 * i, 3 * j) = block(known, node[i], numbers[j]);
      if (laws().creeps()) R.block<3, 3>(3 * i, 3 * j) += at_once(known, node[i], numbers[j]);
    }
    for (Eigen::Index j = 0; j < i; ++j)
      R.block<3, 3>(3 * j, 3 * i) = R.block<3, 3>(3 * i, 3 * j).transpose();
  }
  return R;
}

// How much larger the factor of a law has become by which forces act at once; of all laws the largest.
double ResidualFlexibility::growth(const Eigen::VectorXd& before) const {
  double most = 0;
  for (Eigen::Index j = 0; j < laws().size(); ++j)
    most = std::max(most, std::abs(laws()[j].at_once() - before[j]));
  return most;
}

// |D(a, :) h|^2 <= |D(a, a)| h'D h in a viscoelastic body in one ratio, whose D = R_0 is positive
// semidefinite. In others the D_j are not: twice the largest lag of the nodes that have been loaded stands
// for it, because what modes leave out is largest under the forces.
double ResidualFlexibility::set_point(body::Moduli moduli, const body::StepPoint& at) {
  constexpr double kElsewhere = 2;
  if (!laws().creeps()) return 0;
  Eigen::VectorXd before(laws().size());
  for (Eigen::Index j = 0; j < laws().size(); ++j) before[j] = laws()[j].at_once();
  const CreepHistory::Lag lag = history_.set_point(moduli, at, response());
  moduli_ = moduli;
  const double grown = growth(before);
  if (grown > 0) among_ = {};
  const double at_once = grown > 0 ? grown * std::max(1.0, largest_R_0_ / largest_) * bound(forces_) : 0;
  lag_bound_ = relaxes_alike() ? std::sqrt(largest_R_0_ * lag.product) : kElsewhere * lag.largest;
  return (relaxes_alike() ? std::sqrt(largest_R_0_ * lag.product_change) : kElsewhere * lag.largest_change) +
         at_once;
}

void ResidualFlexibility::accept() {
  if (!creeps()) return;
  history_.accept(forces_, response());
  set_point(moduli_, {0, 1});
  history_.gather(response());
}

Eigen::Vector3d ResidualFlexibility::change_since(const NodalForces& then, int node) {
  Eigen::Vector3d before = history_.displaced_at_start(node, response());
  std::vector<int> numbers;
  for (int b : then.node) numbers.push_back(number(b));
  Row& own = row(node);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < 0) continue;
    before += never_creeping(own, node, numbers[i]) * then.f_B.col(static_cast<Eigen::Index>(i));
  }
  return displacement(node) - before;
}

double ResidualFlexibility::energy() {
  double twice = creeps() ? history_.twice_energy(forces_, response()) : 0;
  for (std::size_t i = 0; i < forces_.node.size(); ++i) {
    const Eigen::Vector3d f = forces_.f_B.col(static_cast<Eigen::Index>(i));
    if (!creeps()) {
      twice += f.dot(displacement(forces_.node[i]));
      continue;
    }
    const auto [by_R, by_D] = displaced(forces_.node[i]);
    twice += f.dot(by_R - by_D.rowwise().sum());
  }
  return 0.5 * twice;
}

void ResidualFlexibility::set_history(const model::RelaxedState& state) {
  if (state.node.empty() || !laws().creeps()) return;
  const Eigen::Index n = laws().n_columns(), n_nodes = static_cast<Eigen::Index>(state.node.size());
  require(state.force.rows() == 3 && state.force.cols() == n * n_nodes && state.force.allFinite() &&
              std::is_sorted(state.node.begin(), state.node.end()) && state.node.front() >= 0 &&
              state.node.back() < static_cast<int>(rows_.size()),
          "body '", body_->name, "': the history of its contact forces is not one of this body");
  history_.set(state);
}

void ResidualFlexibility::serialize(Archive& archive) {
  NodalForces forces = forces_;
  archive(forces.node);
  archive(forces.f_B);
  if (archive.is_loading()) set_forces(forces);
  if (laws().creeps()) history_.serialize(archive);
}

}  // namespace elastogear::dynamics
