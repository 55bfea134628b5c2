#include "elastogear/dynamics/elastic_block.h"

#include <petscblaslapack.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "dynamics/integrator/rigid_fields.h"
#include "dynamics/integrator/vec_view.h"
#include "elastogear/base/error.h"
#include "elastogear/body/tangent.h"

namespace elastogear::dynamics {
namespace {

// Nodes whose compliance is kept before the store is emptied: bounds it to about 300 MB a body.
constexpr std::size_t kMaxKeptNodes = 2000;
// Nodes whose responses of a full basis are solved for together: 0.5 GB for each copy at a million
// displacements.
constexpr std::size_t kNodesAtOnce = 16;
// Responses that are kept, in numbers: 512 MB a body.
constexpr std::size_t kMaxKeptNumbers = std::size_t{1} << 26;

bool is_diagonal(const Eigen::SparseMatrix<double>& A) {
  for (int j = 0; j < A.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it)
      if (it.row() != it.col() && it.value() != 0) return false;
  return true;
}

bool is_factorisation(KSP ksp, PC pc) {
  PetscBool once = PETSC_FALSE, factor = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &once));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &factor, PCCHOLESKY, PCLU, ""));
  return once && factor;
}

// The rows of the nodes times X, 3 n x m, into the last rows of P.
void project_on(const model::BasisRows& Phi, const std::vector<int>& node, const Eigen::MatrixXd& X,
                Eigen::MatrixXd& P) {
  model::DenseRows rows(3 * static_cast<Eigen::Index>(node.size()), model::column_count(Phi));
  P.bottomRows(rows.rows()).setZero();
  if (rows.size() == 0) return;
  for (std::size_t i = 0; i < node.size(); ++i)
    std::copy_n(model::node_rows(Phi, node[i]), 3 * rows.cols(),
                rows.row(3 * static_cast<Eigen::Index>(i)).data());
  const auto n = static_cast<PetscBLASInt>(rows.rows()), m = static_cast<PetscBLASInt>(X.cols()),
             n_q = static_cast<PetscBLASInt>(rows.cols()), ld = static_cast<PetscBLASInt>(P.rows());
  const double one = 1, none = 0;
  BLASgemm_("T", "N", &n, &m, &n_q, &one, rows.data(), &n_q, X.data(), &n_q, &none,
            P.data() + (P.rows() - rows.rows()), &ld);
}

void project_on(const model::SparseRows& Phi, const std::vector<int>& node, const Eigen::MatrixXd& X,
                Eigen::MatrixXd& P) {
  const Eigen::Index first = P.rows() - 3 * static_cast<Eigen::Index>(node.size());
  for (std::size_t i = 0; i < node.size(); ++i)
    P.middleRows(first + 3 * static_cast<Eigen::Index>(i), 3) = Phi.middleRows(3 * node[i], 3) * X;
}

}  // namespace

BorderColumns::BorderColumns(const body::Equations& eq, const Eigen::MatrixXd& markers)
    : Phi_(&eq.body->surface.Phi) {
  const Eigen::MatrixXd U = body::border(eq);
  U_.resize(eq.n_q(), U.cols() + markers.cols());
  U_.leftCols(U.cols()) = U;
  if (markers.cols() > 0) U_.rightCols(markers.cols()) = markers;  // none: 0 x 0
}

Eigen::Index BorderColumns::size(const std::vector<int>& node) const {
  return n_u() + 3 * static_cast<Eigen::Index>(node.size());
}

Eigen::MatrixXd BorderColumns::project(const std::vector<int>& node, const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd P(size(node), X.cols());
  P.topRows(n_u()) = U_.transpose() * X;
  if (X.cols() == 1) {
    const Eigen::VectorXd x = X.col(0);  // once, as displacement() takes vectors
    for (std::size_t i = 0; i < node.size(); ++i)
      P.col(0).segment<3>(n_u() + 3 * static_cast<Eigen::Index>(i)) = model::displacement(*Phi_, node[i], x);
    return P;
  }
  if (const auto* sparse = std::get_if<model::SparseRows>(Phi_))
    project_on(*sparse, node, X, P);
  else
    project_on(*Phi_, node, X, P);
  return P;
}

Eigen::VectorXd BorderColumns::expand(const std::vector<int>& node, const Eigen::VectorXd& c) const {
  Eigen::VectorXd x = U_ * c.head(n_u());
  for (std::size_t i = 0; i < node.size(); ++i)
    model::add_force(*Phi_, node[i], c.segment<3>(n_u() + 3 * static_cast<Eigen::Index>(i)), x);
  return x;
}

Eigen::MatrixXd BorderColumns::node_columns(const std::vector<int>& node) const {
  Eigen::MatrixXd columns(U_.rows(), 3 * static_cast<Eigen::Index>(node.size()));
  const auto* sparse = std::get_if<model::SparseRows>(Phi_);
  for (std::size_t i = 0; i < node.size(); ++i) {
    auto three = columns.middleCols(3 * static_cast<Eigen::Index>(i), 3);
    if (sparse)
      three = sparse->middleRows(3 * node[i], 3).transpose();
    else
      three = Eigen::Map<const model::DenseRows>(model::node_rows(*Phi_, node[i]), 3, U_.rows()).transpose();
  }
  return columns;
}

std::array<int, 3> BorderColumns::coordinates(int node) const {
  std::array<int, 3> found{-1, -1, -1};
  const auto* rows = std::get_if<model::SparseRows>(Phi_);
  for (int d = 0; d < 3 && rows; ++d) {
    model::SparseRows::InnerIterator entry(*rows, 3 * node + d);
    if (entry && entry.value() == 1) found[static_cast<std::size_t>(d)] = static_cast<int>(entry.col());
  }
  return found;
}

ElasticBlock::ElasticBlock(const body::Equations& eq, const Eigen::MatrixXd& markers)
    : body_(eq.body.get()), D_r_(eq.D_r), columns_(eq, markers), slot_(eq.body->surface.node.size(), -1) {
  diagonal_ = is_diagonal(body_->M_r) && is_diagonal(body_->K_r) &&
              std::all_of(body_->relaxing.begin(), body_->relaxing.end(),
                          [](const model::RelaxingPart& part) { return is_diagonal(part.K); });
  if (!diagonal_) make_solver();
}

void ElasticBlock::set_shifts(double shift_v, double shift_a, const Eigen::VectorXd& following) {
  const bool same = following.size() == following_.size() && following == following_;
  if (shift_v == shift_v_ && shift_a == shift_a_ && same) return;
  following_ = following;
  shift_v_ = shift_v;
  shift_a_ = shift_a;
  ksp_ = {};  // a full basis has no room for two factors
  D_mat_ = {};
  D_ = shift_a * body_->M_r + shift_v * D_r_ + body_->K_r;
  for (Eigen::Index p = 0; p < following.size(); ++p)
    D_ -= decltype(D_)(following[p] * body_->relaxing[static_cast<std::size_t>(p)].K);
  D_.makeCompressed();
  if (diagonal_) {
    inverse_ = D_.diagonal().cwiseInverse();
    require(inverse_.allFinite(), "body '", body_->name, "': the effective elastic matrix is singular");
  } else {
    factorise();
  }
  reset_compliance();
}

void ElasticBlock::make_solver() {
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp_.out()));
  check(KSPSetOptionsPrefix(ksp_, "elastic_"));
  check(KSPSetType(ksp_, KSPPREONLY));
  check(KSPGetPC(ksp_, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(KSPSetFromOptions(ksp_));
  exact_ = is_factorisation(ksp_, pc);
}

void ElasticBlock::attach_rigid_fields() {
  if (is_node_by_node(*body_)) check(MatSetBlockSize(D_mat_, 3));
  if (rigid_.size() == 0)
    rigid_ = Eigen::HouseholderQR<Eigen::MatrixXd>(rigid_fields(*body_)).householderQ() *
             Eigen::MatrixXd::Identity(body_->n_q(), 6);
  std::vector<UniqueVec> fields;
  std::vector<Vec> borrowed;
  for (Eigen::Index i = 0; i < rigid_.cols(); ++i) {
    fields.push_back(vector(rigid_.col(i)));
    borrowed.push_back(fields.back());
  }
  Handle<MatNullSpace, MatNullSpaceDestroy> space;
  check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(borrowed.size()),
                           borrowed.data(), space.out()));
  check(MatSetNearNullSpace(D_mat_, space));
}

void ElasticBlock::factorise() {
  const auto n = static_cast<PetscInt>(D_.rows());
  make_solver();
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, D_.outerIndexPtr(), D_.innerIndexPtr(),
                                  D_.valuePtr(), D_mat_.out()));
  check(MatSetOption(D_mat_, MAT_SPD, PETSC_TRUE));
  if (!exact_) attach_rigid_fields();
  check(KSPSetOperators(ksp_, D_mat_, D_mat_));
  check(KSPSetUp(ksp_));
}

Eigen::VectorXd ElasticBlock::multiply(const Eigen::VectorXd& x) const { return D_ * x; }

Eigen::MatrixXd ElasticBlock::solve(const Eigen::MatrixXd& Y) const {
  if (diagonal_) return inverse_.asDiagonal() * Y;
  const auto n = static_cast<PetscInt>(Y.rows()), m = static_cast<PetscInt>(Y.cols());
  Eigen::MatrixXd right = Y, X = Eigen::MatrixXd::Zero(n, m);
  if (m == 0) return X;
  UniqueMat right_mat, X_mat;
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, right.data(), right_mat.out()));
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, X.data(), X_mat.out()));
  check(KSPMatSolve(ksp_, right_mat, X_mat));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp_, &reason));
  require(reason >= 0 && X.allFinite(), "body '", body_->name,
          "': the effective elastic matrix could not be factorised (is it positive definite?)");
  return X;
}

// After a Newton step the forces that are not in balance on a linear body are those of contact.
Eigen::VectorXd ElasticBlock::solve_load(const Eigen::VectorXd& y) const {
  constexpr double kElsewhere = 1e-6;
  if (diagonal_ || !exact_) return solve(y);
  Eigen::VectorXd elsewhere = y;
  for (const std::array<int, 3>& of_node : coordinate_)
    for (int i : of_node)
      if (i >= 0) elsewhere[i] = 0;
  if (!(elsewhere.norm() <= kElsewhere * y.norm())) return solve(y);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(y.size());
  for (std::size_t slot = 0; slot < coordinate_.size(); ++slot)
    for (std::size_t d = 0; d < 3; ++d)
      if (const int i = coordinate_[slot][d]; i >= 0 && y[i] != 0)
        x += y[i] * response_[slot].col(static_cast<Eigen::Index>(d));
  return x;
}

void ElasticBlock::reset_compliance() {
  kept_.clear();
  batches_.clear();
  answer_.reset();
  std::fill(slot_.begin(), slot_.end(), -1);
  response_.clear();
  coordinate_.clear();
  U_response_ = solve(columns_.U());
  G_ = columns_.U().transpose() * U_response_;
}

void ElasticBlock::add_to_compliance(const std::vector<int>& node) {
  const Eigen::Index before = G_.rows();
  const Eigen::MatrixXd X = solve(columns_.node_columns(node));
  batches_.push_back(node);
  for (std::size_t i = 0; i < node.size(); ++i) {
    slot_[node[i]] = static_cast<int>(kept_.size());
    kept_.push_back(node[i]);
    const bool room = kept_.size() * 3 * static_cast<std::size_t>(X.rows()) <= kMaxKeptNumbers;
    if (diagonal_ || !room) continue;
    response_.push_back(X.middleCols<3>(3 * static_cast<Eigen::Index>(i)));
    coordinate_.push_back(columns_.coordinates(node[i]));
  }
  const Eigen::Index after = columns_.size(kept_);
  G_.conservativeResize(after, after);
  G_.rightCols(after - before) = columns_.project(kept_, X);
  G_.bottomLeftCorner(after - before, before) = G_.topRightCorner(before, after - before).transpose();
}

// Part of G_: the columns U and those of the given nodes, three by three.
Eigen::MatrixXd ElasticBlock::gathered(const std::vector<int>& node) const {
  const Eigen::Index n_u = columns_.n_u(), n = columns_.size(node);
  Eigen::MatrixXd G(n, n);
  const auto copy_column = [&](Eigen::Index from, Eigen::Index to) {
    G.col(to).head(n_u) = G_.col(from).head(n_u);
    for (std::size_t i = 0; i < node.size(); ++i)
      G.col(to).segment<3>(n_u + 3 * static_cast<Eigen::Index>(i)) =
          G_.col(from).segment<3>(n_u + 3 * slot_[node[i]]);
  };
  for (Eigen::Index u = 0; u < n_u; ++u) copy_column(u, u);
  for (std::size_t i = 0; i < node.size(); ++i)
    for (Eigen::Index d = 0; d < 3; ++d)
      copy_column(n_u + 3 * slot_[node[i]] + d, n_u + 3 * static_cast<Eigen::Index>(i) + d);
  return G;
}

std::shared_ptr<const Eigen::MatrixXd> ElasticBlock::compliance(const std::vector<int>& node) {
  if (answer_ && node == asked_) return answer_;
  std::vector<int> missing;
  std::copy_if(node.begin(), node.end(), std::back_inserter(missing), [&](int i) { return slot_[i] < 0; });
  if (kept_.size() + missing.size() > kMaxKeptNodes) {
    reset_compliance();
    missing = node;
  }
  const auto at_once = static_cast<std::ptrdiff_t>(diagonal_ ? missing.size() : kNodesAtOnce);
  for (auto part = missing.begin(); part != missing.end();) {
    const auto end = part + std::min(at_once, missing.end() - part);
    if (pulse_) pulse_();
    add_to_compliance({part, end});
    part = end;
  }
  asked_ = node;
  answer_ = std::make_shared<const Eigen::MatrixXd>(gathered(node));
  return answer_;
}

Eigen::VectorXd ElasticBlock::response(const std::vector<int>& node, const Eigen::VectorXd& c) const {
  const auto is_kept = [&](int i) { return slot_[i] < static_cast<int>(response_.size()); };
  if (diagonal_ || !std::all_of(node.begin(), node.end(), is_kept)) return solve(columns_.expand(node, c));
  Eigen::VectorXd x = U_response_ * c.head(columns_.n_u());
  for (std::size_t i = 0; i < node.size(); ++i)
    x += response_[static_cast<std::size_t>(slot_[node[i]])] *
         c.segment<3>(columns_.n_u() + 3 * static_cast<Eigen::Index>(i));
  return x;
}

void ElasticBlock::serialize(Archive& archive) {
  double shift_v = shift_v_, shift_a = shift_a_;
  std::vector<std::vector<int>> batches = batches_;
  archive(shift_v);
  archive(shift_a);
  Eigen::VectorXd following = following_;
  archive(following);
  archive(batches);
  if (!archive.is_loading() || std::isnan(shift_v)) return;
  const bool fits =
      following.size() == 0 || following.size() == static_cast<Eigen::Index>(body_->relaxing.size());
  require(fits, "body '", body_->name, "': the stored state has ", following.size(),
          " relaxing parts, the body ", body_->relaxing.size());
  set_shifts(shift_v, shift_a, following);
  for (const std::vector<int>& nodes : batches) {
    for (int node : nodes)
      require(node >= 0 && node < static_cast<int>(slot_.size()), "body '", body_->name,
              "': the stored state names node ", node, " of a surface of ", slot_.size(), " nodes");
    add_to_compliance(nodes);
  }
}

}  // namespace elastogear::dynamics
