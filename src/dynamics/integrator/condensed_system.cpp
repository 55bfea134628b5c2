#include "elastogear/dynamics/condensed_system.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "dynamics/contact/low_rank_columns.h"
#include "dynamics/integrator/gmres.h"
#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr Index kDenseUnknowns = 64;   // unknowns up to which all columns are factorised
constexpr double kMostLeading = 0.6;   // share of the columns beyond which all are
constexpr double kWeakCoupling = 0.5;  // k times compliance of a column that does not lead
constexpr int kMostSteps = 30;         // of GMRES

// Columns of A, those of `columns`.
Sparse select_columns(const Sparse& A, const std::vector<Index>& columns) {
  Sparse B(A.rows(), static_cast<Index>(columns.size()));
  Index entries = 0;
  for (Index j : columns) entries += A.outerIndexPtr()[j + 1] - A.outerIndexPtr()[j];
  B.reserve(entries);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    B.startVec(static_cast<Index>(c));
    for (Sparse::InnerIterator it(A, columns[c]); it; ++it)
      B.insertBack(it.row(), static_cast<Index>(c)) = it.value();
  }
  B.finalize();
  return B;
}

// k between leading columns, r x l, and what else there is of it.
std::pair<Sparse, Sparse> split(const Sparse& k, const std::vector<Index>& leading) {
  std::vector<Index> slot(static_cast<std::size_t>(k.cols()), -1);
  for (std::size_t i = 0; i < leading.size(); ++i)
    slot[static_cast<std::size_t>(leading[i])] = static_cast<Index>(i);
  Sparse of_leading(k.rows(), static_cast<Index>(leading.size())), rest(k.rows(), k.cols());
  for (Sparse* part : {&of_leading, &rest}) part->reserve(k.nonZeros());
  for (Index j = 0; j < k.cols(); ++j) {
    const Index column = slot[static_cast<std::size_t>(j)];
    rest.startVec(j);
    if (column >= 0) of_leading.startVec(column);
    for (Sparse::InnerIterator it(k, j); it; ++it)
      if (column >= 0 && slot[static_cast<std::size_t>(it.row())] >= 0)
        of_leading.insertBack(it.row(), column) = it.value();
      else if (it.value() != 0)
        rest.insertBack(it.row(), j) = it.value();
  }
  for (Sparse* part : {&of_leading, &rest}) part->finalize();
  return {std::move(of_leading), std::move(rest)};
}

// A, and below it the last n rows of B.
Sparse stacked(const Sparse& A, const Sparse& B, Index n) {
  const Index first = B.rows() - n;
  Sparse all(A.rows() + n, A.cols());
  all.reserve(A.nonZeros() + B.nonZeros());
  for (Index j = 0; j < A.cols(); ++j) {
    all.startVec(j);
    for (Sparse::InnerIterator it(A, j); it; ++it) all.insertBack(it.row(), j) = it.value();
    for (Sparse::InnerIterator it(B, j); it; ++it)
      if (it.row() >= first) all.insertBack(A.rows() + it.row() - first, j) = it.value();
  }
  all.finalize();
  return all;
}

// |column|^2 of each column of A.
VectorXd squares(const Sparse& A) {
  const int *first = A.outerIndexPtr(), *count = A.innerNonZeroPtr();
  VectorXd sum(A.cols());
  for (Index j = 0; j < A.cols(); ++j)
    sum[j] = Eigen::Map<const VectorXd>(A.valuePtr() + first[j], count ? count[j] : first[j + 1] - first[j])
                 .squaredNorm();
  return sum;
}

// The largest |k_ij| |W_i| |V_j| in row and column of each column, W and V of the rows of the bodies' own
// nodes with the largest compliance there.
struct Weights {
  VectorXd W, V;

  VectorXd strength(const Sparse& k) const {
    VectorXd largest = VectorXd::Zero(k.rows());
    for (Index j = 0; j < k.cols(); ++j)
      for (Sparse::InnerIterator it(k, j); it; ++it) {
        const double s = std::abs(it.value()) * W[it.row()] * V[j];
        largest[it.row()] = std::max(largest[it.row()], s);
        largest[j] = std::max(largest[j], s);
      }
    return largest;
  }
};

double largest_compliance(const BodyTerms& terms, const MatrixXd& compliance) {
  const Index n = 3 * static_cast<Index>(terms.node.size()), n_e = compliance.cols();
  if (n == 0) return 0;
  double largest = compliance.topRows(n_e).diagonal().tail(n).maxCoeff();
  if (compliance.rows() > n_e) largest += compliance.bottomRows(n).rightCols(n).diagonal().maxCoeff();
  return largest;
}

// Are the entries of A and B in the same places?
bool is_alike(const Sparse& A, const Sparse& B) {
  if (A.rows() != B.rows() || A.cols() != B.cols() || !A.isCompressed() || !B.isCompressed()) return false;
  return std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), B.innerIndexPtr());
}

// Adds the displacements by a load: a symmetric matrix, and rows below it for its last columns alone.
void add_compliance(const MatrixXd& compliance, const VectorXd& load, VectorXd& displacement) {
  const Index n_e = compliance.cols(), n = compliance.rows() - n_e;
  add_symmetric_product(compliance.topRows(n_e), load, displacement);
  if (n > 0) displacement.tail(n).noalias() += compliance.bottomRightCorner(n, n) * load.tail(n);
}

}  // namespace

CondensedSystem::Body CondensedSystem::make_body(const BodyTerms& terms, CondensedBody given) {
  const Index n = terms.R.rows(), n_e = terms.beta.rows();
  if (n == 0) return {given.joint, given.n_s, std::move(given.G), terms.rho};
  const Index n_own = terms.L_x.rows() > 0 ? n : 0;  // rows of the residual displacement
  MatrixXd compliance = MatrixXd::Zero(n_e + n_own, n_e), rho(n_e + n_own, given.n_s);
  compliance.topRows(n_e) = *given.G;
  compliance.bottomRightCorner(n, n) += terms.R;
  rho << terms.rho, terms.rho.bottomRows(n_own);
  return {given.joint, given.n_s, std::make_shared<const MatrixXd>(std::move(compliance)), std::move(rho),
          n_own > 0 ? stacked(terms.L_V, terms.L_x, n) : Sparse()};
}

// Rows of V on the displacements of a body.
const Sparse& CondensedSystem::V(const EffectiveMatrix& A, std::size_t b) const {
  return body_[b].V_own.cols() > 0 ? body_[b].V_own : displacement_rows(A.body[b]);
}

// Leading are columns that are not of contact, and those of contact that are not weak, Eq. (8.16a). Returns
// whether that leaves enough out.
bool CondensedSystem::choose_leading(const EffectiveMatrix& A) {
  const Index r = A.k.rows();
  leading_.clear();
  if (n_s_ + r <= kDenseUnknowns) return false;
  Weights weights{VectorXd::Zero(r), VectorXd::Zero(r)};
  weight_.setZero(r);
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const double g = largest_compliance(A.body[b], *body_[b].compliance);
    const Sparse &L = A.body[b].L, &V_b = V(A, b);
    const VectorXd L_squares = squares(L);
    weight_ += L_squares;
    weights.W += g * L_squares;
    weights.V += g * (&V_b == &L ? L_squares : squares(V_b));
  }
  for (VectorXd* w : {&weight_, &weights.W, &weights.V}) *w = w->cwiseSqrt().eval();
  const VectorXd strength = weights.strength(A.k);
  for (Index j = 0; j < r; ++j)
    if (j >= A.n_contact || !(strength[j] < kWeakCoupling)) leading_.push_back(j);
  return static_cast<double>(leading_.size()) <= kMostLeading * static_cast<double>(r);
}

// The matrix of Eq. (8.16).
void CondensedSystem::factorise_all(const EffectiveMatrix& A) const {
  const Index r = A.k.rows();
  MatrixXd small = MatrixXd::Zero(n_s_ + r, n_s_ + r);
  small.bottomRightCorner(r, r).setIdentity();
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const BodyTerms& t = A.body[b];
    const Index joint = body_[b].joint, n_s = body_[b].n_s;
    const MatrixXd &compliance = *body_[b].compliance, &rho = body_[b].rho;
    // Products of a sparse matrix that run down the columns of the dense one are the fast ones.
    const MatrixXd compliance_t = compliance.transpose(), V_responses = (compliance_t * V(A, b)).transpose(),
                   rho_responses = rho.transpose() * compliance;
    const Sparse L_k = t.L * A.k;
    small.block(joint, joint, n_s, n_s) += t.C - rho_responses * t.beta;
    small.block(joint, n_s_, n_s, r) += t.W_s * A.k - rho_responses * L_k;
    small.block(n_s_, joint, r, n_s) += V_responses * t.beta - t.V_s.transpose();
    small.bottomRightCorner(r, r) += V_responses * L_k;
  }
  require(small.allFinite(), "the effective matrix is not finite");
  all_.emplace();
  all_->set(std::move(small));
}

// Factorises the matrix of Eq. (8.16) of the leading columns, with k_leading in place of k.
void CondensedSystem::factorise_leading(const EffectiveMatrix& A) {
  const Index l = n_leading();
  MatrixXd small = MatrixXd::Zero(n_s_ + l, n_s_ + l);
  small.bottomRightCorner(l, l).setIdentity();
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const BodyTerms& t = A.body[b];
    Body& body = body_[b];
    const Index n_s = body.n_s;
    body.L_runs = ColumnRuns(t.L);
    body.V_runs = is_alike(V(A, b), t.L) ? body.L_runs : ColumnRuns(V(A, b));
    body.V_leading = select_columns(V(A, b), leading_);
    body.response.resize(body.compliance->rows(), n_s + l);
    body.response.leftCols(n_s).noalias() = *body.compliance * t.beta;
    body.response.rightCols(l) = *body.compliance * Sparse(t.L * k_leading_);
    const MatrixXd response_t = body.response.transpose(), of_leading = response_t * body.V_leading;
    const MatrixXd of_joint = body.rho.transpose() * body.response;
    small.block(body.joint, body.joint, n_s, n_s) += t.C - of_joint.leftCols(n_s);
    small.block(body.joint, n_s_, n_s, l) += t.W_s * k_leading_ - of_joint.rightCols(l);
    small.block(n_s_, body.joint, l, n_s) +=
        of_leading.topRows(n_s).transpose() - t.V_s(Eigen::all, leading_).transpose();
    small.bottomRightCorner(l, l) += of_leading.bottomRows(l).transpose();
  }
  require(small.allFinite(), "the effective matrix is not finite");
  lu_.set(std::move(small));
}

void CondensedSystem::set(const EffectiveMatrix& A, std::vector<CondensedBody> bodies) {
  body_.clear();
  n_s_ = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    n_s_ += bodies[b].n_s;
    body_.push_back(make_body(A.body[b], std::move(bodies[b])));
  }
  all_.reset();
  n_steps_ = 0;
  if (!choose_leading(A)) return factorise_all(A);
  std::tie(k_leading_, k_weak_) = split(A.k, leading_);
  weak_runs_ = ColumnRuns(k_weak_);
  factorise_leading(A);
}

// Adds the displacements by x_s and the leading columns.
void CondensedSystem::add_response(const Body& body, const VectorXd& small, VectorXd& displacement) const {
  VectorXd of_body(body.n_s + n_leading());
  of_body << small.segment(body.joint, body.n_s), small.tail(n_leading());
  add_product(body.response, of_body, displacement);
}

// Solves with k_leading in place of k. All lambda follow from x_s and the leading ones.
VectorXd CondensedSystem::solve_leading(const EffectiveMatrix& A, const VectorXd& right) const {
  VectorXd small(n_s_ + n_leading()), x = right;
  small << right.head(n_s_), right.tail(A.k.rows())(leading_);
  small = lu_.solve(std::move(small));
  x.head(n_s_) = small.head(n_s_);
  auto lambda = x.tail(A.k.rows());
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const Body& body = body_[b];
    VectorXd displacement = VectorXd::Zero(body.compliance->rows());
    add_response(body, small, displacement);
    lambda += A.body[b].V_s.transpose() * small.segment(body.joint, body.n_s);
    body.V_runs.subtract_transposed(V(A, b), displacement, lambda);
  }
  return x;
}

// Returns the [x_s; lambda] that given forces along the columns cause, while the leading columns respond by
// k_leading. Eq. (8.16b).
VectorXd CondensedSystem::moved_by(const EffectiveMatrix& A, const VectorXd& forces) const {
  const Index l = n_leading();
  VectorXd small = VectorXd::Zero(n_s_ + l), x = VectorXd::Zero(n_s_ + A.k.rows());
  std::vector<VectorXd> displacement;
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const Body& body = body_[b];
    displacement.push_back(VectorXd::Zero(body.compliance->rows()));
    add_compliance(*body.compliance, body.L_runs.multiply(A.body[b].L, forces), displacement[b]);
    small.segment(body.joint, body.n_s) -= A.body[b].W_s * forces - body.rho.transpose() * displacement[b];
    small.tail(l) -= body.V_leading.transpose() * displacement[b];
  }
  small = lu_.solve(std::move(small));
  x.head(n_s_) = small.head(n_s_);
  for (std::size_t b = 0; b < body_.size(); ++b) {
    const Body& body = body_[b];
    add_response(body, small, displacement[b]);
    x.tail(A.k.rows()) += A.body[b].V_s.transpose() * small.segment(body.joint, body.n_s);
    body.V_runs.subtract_transposed(V(A, b), displacement[b], x.tail(A.k.rows()));
  }
  return x;
}

// Finds the forces phi = k_weak lambda, with lambda of the leading columns and of these forces: Eq. (8.16b).
std::optional<VectorXd> CondensedSystem::solve_by_steps(const EffectiveMatrix& A, const VectorXd& right,
                                                        double left) const {
  const Index r = A.k.rows();
  VectorXd x = solve_leading(A, right);
  const VectorXd unweighted = weight_.unaryExpr([](double w) { return w > 0 ? 1 / w : 0; });
  const auto weak = [&](const VectorXd& of) -> VectorXd {
    return weight_.cwiseProduct(weak_runs_.multiply(k_weak_, of.tail(r)));
  };
  std::vector<VectorXd> moved;  // by each of the vectors that GMRES takes
  const auto multiply = [&](const VectorXd& f) -> VectorXd {
    moved.push_back(moved_by(A, unweighted.cwiseProduct(f)));
    return weak(moved.back());
  };
  const double forces = weight_.cwiseProduct(A.k * x.tail(r)).norm();
  const auto share = gmres(multiply, weak(x), {left * forces, kMostSteps});
  if (!share) return {};
  n_steps_ = static_cast<int>(share->size());
  for (std::size_t j = 0; j < moved.size(); ++j) x += (*share)[static_cast<Index>(j)] * moved[j];
  return x;
}

VectorXd CondensedSystem::solve(const EffectiveMatrix& A, const VectorXd& right, double left) const {
  if (!all_) {
    const std::optional<VectorXd> x = solve_by_steps(A, right, left);
    if (x && x->allFinite()) return *x;
    n_steps_ = 0;
    factorise_all(A);
  }
  return all_->solve(right);
}

}  // namespace elastogear::dynamics
