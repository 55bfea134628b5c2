#include "elastogear/dynamics/residual_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

// share a + (1 - share) b
NodalForces mean(const NodalForces& a, const NodalForces& b, double share) {
  NodalForces result;
  std::set_union(a.node.begin(), a.node.end(), b.node.begin(), b.node.end(), std::back_inserter(result.node));
  result.f_B.setZero(3, static_cast<Eigen::Index>(result.node.size()));
  const auto add = [&](const NodalForces& part, double factor) {
    for (std::size_t i = 0; i < part.node.size(); ++i) {
      const auto at = std::lower_bound(result.node.begin(), result.node.end(), part.node[i]);
      result.f_B.col(at - result.node.begin()) += factor * part.f_B.col(static_cast<Eigen::Index>(i));
    }
  };
  add(a, share);
  add(b, 1 - share);
  return result;
}

NodalForces difference(const NodalForces& a, const NodalForces& b) {
  NodalForces result = mean(a, b, 0.5);
  NodalForces minus_b = b;
  minus_b.f_B *= -1;
  result = mean(a, minus_b, 0.5);
  result.f_B *= 2;
  return result;
}

// Columns that change the force at an unchanged closest point: along n, or in all directions where it has no
// potential. They stand first.
Eigen::Index leading_columns(const contact::ContactPoint& point) { return point.V_dot.cols() == 0 ? 1 : 3; }

Eigen::Index column_count(const std::vector<PairContacts>& pairs) {
  Eigen::Index r = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) r += leading_columns(point);
  return r;
}

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
      const Eigen::Index n = leading_columns(point);
      for (int i = 0; i < kLocalNodes; ++i) {
        const LocalNode local = local_node(point, i);
        if (pair.body[local.side] != static_cast<int>(b)) continue;
        const auto row = 3 * (std::lower_bound(node.begin(), node.end(), local.node) - node.begin());
        add(R_WB.transpose() * point.W.block(3 * i, 0, 3, n), row, column, L);
        add(R_WB.transpose() * point.V.block(3 * i, 0, 3, n), row, column, L_V);
      }
      column += n;
    }
  Columns columns;
  for (auto [matrix, entries] : {std::pair{&columns.L, &L}, std::pair{&columns.L_V, &L_V}}) {
    matrix->resize(3 * static_cast<Eigen::Index>(node.size()), column);
    matrix->setFromTriplets(entries->begin(), entries->end());
  }
  return columns;
}

Eigen::SparseMatrix<double> stiffness(const std::vector<PairContacts>& pairs, Eigen::Index r) {
  Triplets k;
  Eigen::Index column = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      const Eigen::Index n = leading_columns(point);
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) k.emplace_back(column + i, column + j, point.k(i, j));
      column += n;
    }
  Eigen::SparseMatrix<double> K(r, r);
  K.setFromTriplets(k.begin(), k.end());
  return K;
}

}  // namespace

ResidualContact::ResidualContact(const std::vector<const model::ElasticBody*>& bodies)
    : flexibility_(bodies.size()), change_(bodies.size(), 0) {
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

double ResidualContact::misfit(const std::vector<NodalForces>& found) const {
  double missing = 0, all = 0;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    missing += difference(found[b], flexibility_[b]->forces()).f_B.squaredNorm();
    all += found[b].f_B.squaredNorm();
  }
  return missing > 0 ? std::sqrt(missing / std::max(all, missing)) : 0;
}

void ResidualContact::answer_to(std::size_t b, const NodalForces& forces) {
  ResidualFlexibility& R = *flexibility_[b];
  change_[b] += R.bound(difference(forces, R.forces()));
  R.set_forces(forces);
}

// With w = R (f - L k lambda), lambda = L_V' (w - w_now) of all bodies: (I + H k) lambda = L_V' (R f -
// w_now), H = L_V' R L.
void ResidualContact::improve(const std::vector<PairContacts>& pairs,
                              const std::vector<contact::SurfaceState>& surfaces,
                              const std::vector<NodalForces>& found, double share) {
  const Eigen::Index r = column_count(pairs);
  const Eigen::SparseMatrix<double> k = stiffness(pairs, r);
  std::vector<Columns> columns(found.size());
  MatrixXd H = MatrixXd::Zero(r, r);
  VectorXd right = VectorXd::Zero(r);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    const std::vector<int>& node = found[b].node;
    columns[b] = columns_of(b, pairs, surfaces[b].R_WB, node);
    const MatrixXd R = among(b, node);
    VectorXd w(R.rows());
    for (std::size_t i = 0; i < node.size(); ++i)
      w.segment<3>(static_cast<Eigen::Index>(3 * i)) = displacement(b, node[i]);
    H += columns[b].L_V.transpose() * MatrixXd(R * columns[b].L);
    right += columns[b].L_V.transpose() * VectorXd(R * found[b].f_B.reshaped() - w);
  }
  const VectorXd lambda = (MatrixXd::Identity(r, r) + H * k).partialPivLu().solve(right), change = k * lambda;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!yields(b)) continue;
    NodalForces next = found[b];
    next.f_B.reshaped() -= columns[b].L * change;
    answer_to(b, mean(next, flexibility_[b]->forces(), share));
  }
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
  for (std::size_t b = 0; b < flexibility_.size(); ++b) {
    if (!yields(b)) continue;
    NodalForces forces = flexibility_[b]->forces();
    tape(forces.node);
    tape(forces.f_B);
    if (tape.plays()) flexibility_[b]->set_forces(forces);
  }
}

}  // namespace elastogear::dynamics
