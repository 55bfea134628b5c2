#include "dynamics/contact/complementarity.h"

#include <Eigen/LU>
#include <algorithm>

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRoundoff = 1e-12;  // of the largest entry of q, and of C p

struct Split {
  std::vector<Index> closed, open;
};

Split split(const std::vector<bool>& closed) {
  Split s;
  for (std::size_t i = 0; i < closed.size(); ++i)
    (closed[i] ? s.closed : s.open).push_back(static_cast<Index>(i));
  return s;
}

// p of closed contacts that leaves no gap there; open ones have none.
VectorXd closing_forces(const MatrixXd& C, const VectorXd& q, const Split& s) {
  VectorXd p = VectorXd::Zero(q.size());
  if (s.closed.empty()) return p;
  const MatrixXd C_closed = C(s.closed, s.closed);
  p(s.closed) = -C_closed.partialPivLu().solve(VectorXd(q(s.closed)));
  return p;
}

// Closed contacts that are pulled, and open ones that are entered.
std::vector<Index> wrong(const MatrixXd& C, const VectorXd& q, const VectorXd& p, const Split& s) {
  std::vector<Index> indices;
  const VectorXd y = q + C * p;
  const double length = kRoundoff * q.cwiseAbs().maxCoeff();
  for (Index i : s.closed)
    if (p[i] * C(i, i) < -length) indices.push_back(i);
  for (Index i : s.open)
    if (y[i] < -length) indices.push_back(i);
  return indices;
}

}  // namespace

std::optional<VectorXd> solve_complementarity(const MatrixXd& C, const VectorXd& q,
                                              std::vector<bool> closed) {
  constexpr int kBlocks = 5;  // exchanges of all wrong entries at once that may fail to lessen their number
  if (q.size() == 0) return VectorXd();
  const auto most = static_cast<int>(20 + 10 * q.size());
  std::size_t least = closed.size() + 1;
  int blocks = kBlocks;
  for (int pivot = 0; pivot < most; ++pivot) {
    const Split s = split(closed);
    const VectorXd p = closing_forces(C, q, s);
    if (!p.allFinite()) return {};
    std::vector<Index> indices = wrong(C, q, p, s);
    if (indices.empty()) return p.cwiseMax(0);
    if (indices.size() < least) {
      least = indices.size();
      blocks = kBlocks;
    } else if (--blocks < 0) {  // one at a time, by the largest index, ends
      indices = {*std::max_element(indices.begin(), indices.end())};
    }
    for (Index i : indices) closed[static_cast<std::size_t>(i)].flip();
  }
  return {};
}

}  // namespace elastogear::dynamics
