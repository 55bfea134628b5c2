#include "reduction/second_moments.h"

#include <algorithm>
#include <array>

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array<std::array<int, 2>, 6> kPairs = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

// Some modes, n_nodes x columns for each direction.
using Block = std::array<MatrixXd, 3>;

Block by_direction(const MatrixXd& Phi) {
  Block block;
  for (int a = 0; a < 3; ++a) block[a] = Phi(Eigen::seqN(a, Phi.rows() / 3, 3), Eigen::all);
  return block;
}

}  // namespace

std::vector<model::BasisRows> second_moments(const WaitingModes& modes, const model::SparseRows& M_s) {
  const Index n_q = modes.size(), width = modes.block_width(3 * M_s.rows());
  std::vector<model::DenseRows> S(kPairs.size(), model::DenseRows(n_q, n_q));
  for (Index l = 0; l < n_q; l += width) {
    Block mass_times = by_direction(modes.block(l, std::min(width, n_q - l)));
    for (MatrixXd& x : mass_times) x = (M_s * x).eval();
    for (Index k = 0; k < n_q; k += width) {
      const Block phi = by_direction(modes.block(k, std::min(width, n_q - k)));
      for (std::size_t i = 0; i < kPairs.size(); ++i) {
        const auto [a, b] = kPairs[i];
        S[i].block(k, l, phi[a].cols(), mass_times[b].cols()).noalias() = phi[a].transpose() * mass_times[b];
      }
    }
  }
  return {std::make_move_iterator(S.begin()), std::make_move_iterator(S.end())};
}

std::vector<model::BasisRows> unit_second_moments(const model::SparseRows& M_s,
                                                  const std::vector<int>& free_dof) {
  std::vector<int> coordinate(static_cast<std::size_t>(3 * M_s.rows()), -1);
  for (std::size_t j = 0; j < free_dof.size(); ++j) coordinate[free_dof[j]] = static_cast<int>(j);
  const auto n_q = static_cast<Index>(free_dof.size());
  std::vector<model::BasisRows> moments;
  for (const auto [a, b] : kPairs) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < M_s.rows(); ++i)
      for (model::SparseRows::InnerIterator it(M_s, i); it; ++it) {
        const int k = coordinate[3 * i + a], l = coordinate[3 * it.col() + b];
        if (k >= 0 && l >= 0) entries.emplace_back(k, l, it.value());
      }
    model::SparseRows S(n_q, n_q);
    S.setFromTriplets(entries.begin(), entries.end());
    moments.emplace_back(std::move(S));
  }
  return moments;
}

}  // namespace elastogear::reduction
