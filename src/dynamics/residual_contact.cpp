#include "elastogear/dynamics/residual_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

// share_a a + share_b b
NodalForces sum(const NodalForces& a, double share_a, const NodalForces& b, double share_b) {
  NodalForces result;
  std::set_union(a.node.begin(), a.node.end(), b.node.begin(), b.node.end(), std::back_inserter(result.node));
  result.f_B.setZero(3, static_cast<Eigen::Index>(result.node.size()));
  const auto add = [&](const NodalForces& part, double factor) {
    for (std::size_t i = 0; i < part.node.size(); ++i) {
      const auto at = std::lower_bound(result.node.begin(), result.node.end(), part.node[i]);
      result.f_B.col(at - result.node.begin()) += factor * part.f_B.col(static_cast<Eigen::Index>(i));
    }
  };
  add(a, share_a);
  add(b, share_b);
  return result;
}

NodalForces mean(const NodalForces& a, const NodalForces& b, double share) {
  return sum(a, share, b, 1 - share);
}
NodalForces difference(const NodalForces& a, const NodalForces& b) { return sum(a, 1, b, -1); }

// df = -L k L_V' dw of the nodes of one body that are touched, in its frame.
struct Columns {
  Eigen::SparseMatrix<double> L, L_V;  // 3 n x r
};

void add(const Eigen::Ref<const MatrixXd>& rows, Eigen::Index first_row, Eigen::Index column,
         Triplets& triplets) {
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    for (Eigen::Index d = 0; d < 3; ++d) triplets.emplace_back(first_row + d, column + j, rows(d, j));
}

Columns columns_of(std::size_t b, const std::vector<PairContacts>& pairs, const Eigen::Matrix3d& R_WB,
                   const std::vector<int>& node) {
  Triplets L, L_V;
  Eigen::Index column = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      for (int i = 0; i < kLocalNodes; ++i) {
        const LocalNode local = local_node(point, i);
        if (pair.body[local.side] != static_cast<int>(b)) continue;
        const auto row = 3 * (std::lower_bound(node.begin(), node.end(), local.node) - node.begin());
        add(R_WB.transpose() * point.W.middleRows(3 * i, 3), row, column, L);
        add(R_WB.transpose() * point.V.middleRows(3 * i, 3), row, column, L_V);
      }
      column += point.W.cols();
    }
  Columns columns;
  for (auto [matrix, entries] : {std::pair{&columns.L, &L}, std::pair{&columns.L_V, &L_V}}) {
    matrix->resize(3 * static_cast<Eigen::Index>(node.size()), column);
    matrix->setFromTriplets(entries->begin(), entries->end());
  }
  return columns;
}

// (I + H k) lambda = right with H = sum over the bodies of L_V' R L.
struct Answering {
  std::vector<Columns> columns;
  std::vector<MatrixXd> R;
  Eigen::SparseMatrix<double> k;
  VectorXd right;
  std::vector<Eigen::Index> leading;  // columns that change the force at an unchanged closest point

  VectorXd multiply(const VectorXd& lambda) const {
    VectorXd y = lambda;
    const VectorXd k_lambda = k * lambda;
    for (std::size_t b = 0; b < R.size(); ++b)
      if (R[b].size() > 0) y += columns[b].L_V.transpose() * (R[b] * (columns[b].L * k_lambda));
    return y;
  }
  MatrixXd leading_block() const {
    const auto n = static_cast<Eigen::Index>(leading.size());
    MatrixXd A = MatrixXd::Identity(n, n);
    Eigen::SparseMatrix<double> unit(right.size(), n);
    for (Eigen::Index j = 0; j < n; ++j) unit.insert(leading[j], j) = 1;
    const Eigen::SparseMatrix<double> k_unit = k * unit;
    for (std::size_t b = 0; b < R.size(); ++b) {
      if (R[b].size() == 0) continue;
      const MatrixXd R_L = R[b] * (columns[b].L * k_unit);
      A += (columns[b].L_V.transpose() * R_L)(leading, Eigen::all);
    }
    return A;
  }
};

// Those that change the force at an unchanged closest point stand first: along n, or in all directions where
// the force has no potential. At an open end any change of the closest point does.
Eigen::Index leading_columns(const contact::ContactPoint& point) {
  if (point.V_dot.cols() == 0) return 1;
  return point.W.cols() == contact::kColumns ? contact::kColumns : 3;
}

// k, and the columns that stand first.
void set_stiffness(const std::vector<PairContacts>& pairs, Answering& a) {
  Triplets k;
  Eigen::Index column = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      for (Eigen::Index i = 0; i < point.k.rows(); ++i)
        for (Eigen::Index j = 0; j < point.k.cols(); ++j)
          if (point.k(i, j) != 0) k.emplace_back(column + i, column + j, point.k(i, j));
      for (Eigen::Index i = 0; i < leading_columns(point); ++i) a.leading.push_back(column + i);
      column += point.W.cols();
    }
  a.k.resize(column, column);
  a.k.setFromTriplets(k.begin(), k.end());
  a.right = VectorXd::Zero(column);
}

// The other columns are of the order of the penetration over the radius of curvature: they converge fast.
VectorXd solve(const Answering& a) {
  constexpr int kMostRounds = 20;
  constexpr double kTolerance = 1e-8;
  const Eigen::PartialPivLU<MatrixXd> lu(a.leading_block());
  VectorXd lambda = VectorXd::Zero(a.right.size()), rest = a.right;
  for (int round = 0; round < kMostRounds && rest.norm() > kTolerance * a.right.norm(); ++round) {
    const VectorXd leading = lu.solve(VectorXd(rest(a.leading)));
    VectorXd change = rest;
    change(a.leading) = leading;
    lambda += change;
    rest = a.right - a.multiply(lambda);
  }
  return lambda;
}

}  // namespace

ResidualContact::ResidualContact(const std::vector<const model::ElasticBody*>& bodies)
    : flexibility_(bodies.size()), left_(bodies.size()), change_(bodies.size(), 0) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b]->flexibility.empty()) flexibility_[b].emplace(*bodies[b]);
}

bool ResidualContact::any() const {
  return std::any_of(flexibility_.begin(), flexibility_.end(), [](const auto& f) { return f.has_value(); });
}

contact::Yield ResidualContact::yield(std::size_t b) {
  if (!yields(b)) return {};
  ResidualFlexibility& R = *flexibility_[b];
  return {[&R](int node) { return R.displacement(node); }, R.bound(R.forces()), change_[b]};
}

void ResidualContact::seen() { std::fill(change_.begin(), change_.end(), 0); }

MatrixXd ResidualContact::among(std::size_t b, const std::vector<int>& node) {
  return yields(b) ? flexibility_[b]->among(node) : MatrixXd();
}

ResidualContact::Misfit ResidualContact::misfit(const std::vector<NodalForces>& found) const {
  double missing = 0, all = 0;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    missing += difference(found[b], flexibility_[b]->forces()).f_B.squaredNorm();
    all += found[b].f_B.squaredNorm();
  }
  return {std::sqrt(missing), missing > 0 ? std::sqrt(missing / std::max(all, missing)) : 0};
}

void ResidualContact::answer_to(std::size_t b, const NodalForces& forces) {
  ResidualFlexibility& R = *flexibility_[b];
  change_[b] += R.bound(difference(forces, R.forces()));
  R.set_forces(forces);
}

// With w = R (f - L k lambda), lambda = L_V' (w - w_now) of all bodies: (I + H k) lambda = L_V' (R f -
// w_now), H = L_V' R L.
VectorXd ResidualContact::step(const std::vector<PairContacts>& pairs,
                               const std::vector<contact::SurfaceState>& surfaces,
                               const std::vector<NodalForces>& found) {
  Answering a;
  set_stiffness(pairs, a);
  a.columns.resize(found.size());
  a.R.resize(found.size());
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    const std::vector<int>& node = found[b].node;
    a.columns[b] = columns_of(b, pairs, surfaces[b].R_WB, node);
    a.R[b] = among(b, node);
    VectorXd w(a.R[b].rows());
    for (std::size_t i = 0; i < node.size(); ++i)
      w.segment<3>(static_cast<Eigen::Index>(3 * i)) = displacement(b, node[i]);
    a.right += a.columns[b].L_V.transpose() * VectorXd(a.R[b] * found[b].f_B.reshaped() - w);
  }
  const VectorXd lambda = solve(a), change = a.k * lambda;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    NodalForces next = found[b];
    next.f_B.reshaped() -= a.columns[b].L * change;
    left_[b] = flexibility_[b]->forces();
    answer_to(b, next);
  }
  return lambda;
}

void ResidualContact::improve(const std::vector<PairContacts>& pairs,
                              const std::vector<contact::SurfaceState>& surfaces,
                              const std::vector<NodalForces>& found) {
  step(pairs, surfaces, found);
}

void ResidualContact::retreat() {
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (yields(b)) answer_to(b, mean(flexibility_[b]->forces(), left_[b], 0.5));
}

bool ResidualContact::settle(std::vector<PairContacts>& pairs,
                             const std::vector<contact::SurfaceState>& surfaces,
                             const std::vector<NodalForces>& found) {
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points)
      if (point.V_dot.cols() > 0) return false;
  const VectorXd lambda = step(pairs, surfaces, found);
  Eigen::Index column = 0;
  for (PairContacts& pair : pairs)
    for (contact::ContactPoint& point : pair.points) {
      const VectorXd change = lambda.segment(column, point.W.cols());
      point.F.reshaped() -= point.W * (point.k * change);
      point.f = point.F.col(0);
      point.g_n += change[0];
      point.energy = 0.5 * point.k(0, 0) * point.g_n * point.g_n;
      column += point.W.cols();
    }
  return true;
}

void ResidualContact::take_answered(const std::vector<contact::SurfaceState>& surfaces,
                                    std::vector<NodalForces>& found) const {
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    found[b] = flexibility_[b]->forces();
    found[b].x_B = surfaces[b].x_B(Eigen::all, found[b].node);
  }
}

void ResidualContact::predict(double time) {
  if (before_.forces.empty() || !(last_.time > before_.time)) return;
  const double share = (time - before_.time) / (last_.time - before_.time);
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (yields(b) && last_.forces[b].node == before_.forces[b].node)
      answer_to(b, mean(last_.forces[b], before_.forces[b], share));
}

void ResidualContact::accept(double time) {
  before_ = std::move(last_);
  last_ = {time, {}};
  for (const auto& flexibility : flexibility_)
    last_.forces.push_back(flexibility ? flexibility->forces() : NodalForces{});
}

double ResidualContact::energy(std::size_t b) {
  if (!yields(b)) return 0;
  ResidualFlexibility& R = *flexibility_[b];
  double energy = 0;
  for (std::size_t i = 0; i < R.forces().node.size(); ++i)
    energy += 0.5 * R.forces().f_B.col(static_cast<Eigen::Index>(i)).dot(R.displacement(R.forces().node[i]));
  return energy;
}

void ResidualContact::visit_memory(Tape& tape) {
  const auto visit = [&](NodalForces& forces) {
    tape(forces.node);
    tape(forces.f_B);
  };
  for (std::size_t b = 0; b < flexibility_.size(); ++b) {
    if (!yields(b)) continue;
    NodalForces forces = flexibility_[b]->forces();
    visit(forces);
    if (tape.plays()) flexibility_[b]->set_forces(forces);
  }
  for (Accepted* accepted : {&last_, &before_}) {
    tape(accepted->time);
    tape.each(accepted->forces, visit);
  }
}

}  // namespace elastogear::dynamics
