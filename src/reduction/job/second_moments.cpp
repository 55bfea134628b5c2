#include "reduction/job/second_moments.h"

#include <algorithm>
#include <array>

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array<std::array<int, 2>, 6> kPairs = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

// Some modes in all fields of a mass, n x columns for each direction.
using Block = std::array<MatrixXd, 3>;

Block by_direction(const fem::FieldMass& mass, const MatrixXd& Phi) {
  const Index n_nodes = Phi.rows() / 3, n = mass.M_s.rows();
  const MatrixXd amplitudes = n > n_nodes ? MatrixXd(mass.T * Phi) : MatrixXd(0, Phi.cols());
  Block block;
  for (int a = 0; a < 3; ++a) {
    block[a].resize(n, Phi.cols());
    block[a].topRows(n_nodes) = Phi(Eigen::seqN(a, n_nodes, 3), Eigen::all);
    block[a].bottomRows(n - n_nodes) = amplitudes(Eigen::seqN(a, n - n_nodes, 3), Eigen::all);
  }
  return block;
}

// All fields in direction a from the free displacements, n x n_q.
model::SparseRows fields_of(const fem::FieldMass& mass, int a, const std::vector<int>& coordinate,
                            Index n_q) {
  const Index n = mass.M_s.rows(), n_nodes = static_cast<Index>(coordinate.size()) / 3;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index field, Index dof, double value) {
    if (const int k = coordinate[dof]; k >= 0) entries.emplace_back(static_cast<int>(field), k, value);
  };
  for (Index i = 0; i < n_nodes; ++i) add(i, 3 * i + a, 1);
  for (Index k = 0; k < n - n_nodes; ++k)
    for (model::SparseRows::InnerIterator it(mass.T, 3 * k + a); it; ++it)
      add(n_nodes + k, it.col(), it.value());
  model::SparseRows fields(n, n_q);
  fields.setFromTriplets(entries.begin(), entries.end());
  return fields;
}

// Number of the first displacements, those of the nodes.
std::size_t n_displacements(const fem::FieldMass& mass) {
  return static_cast<std::size_t>(mass.T.size() > 0 ? mass.T.cols() : 3 * mass.M_s.rows());
}

}  // namespace

MatrixXd times(const fem::FieldMass& mass, const MatrixXd& u) {
  if (u.size() == 0) return {};
  const Index n_nodes = u.rows() / 3, n_modes = mass.M_s.rows() - n_nodes;
  const Block fields = by_direction(mass, u);
  MatrixXd M_u(u.rows(), u.cols()), of_modes(3 * n_modes, u.cols());
  for (int a = 0; a < 3; ++a) {
    const MatrixXd momentum = mass.M_s * fields[a];
    M_u(Eigen::seqN(a, n_nodes, 3), Eigen::all) = momentum.topRows(n_nodes);
    of_modes(Eigen::seqN(a, n_modes, 3), Eigen::all) = momentum.bottomRows(n_modes);
  }
  if (n_modes > 0) M_u += mass.T.transpose() * of_modes;
  return M_u;
}

std::vector<model::BasisRows> second_moments(const WaitingModes& modes, const fem::FieldMass& mass) {
  const Index n_q = modes.size(), width = modes.block_width(3 * mass.M_s.rows());
  std::vector<model::DenseRows> S(kPairs.size(), model::DenseRows(n_q, n_q));
  for (Index l = 0; l < n_q; l += width) {
    Block mass_times = by_direction(mass, modes.block(l, std::min(width, n_q - l)));
    for (MatrixXd& x : mass_times) x = (mass.M_s * x).eval();
    for (Index k = 0; k < n_q; k += width) {
      const Block phi = by_direction(mass, modes.block(k, std::min(width, n_q - k)));
      for (std::size_t i = 0; i < kPairs.size(); ++i) {
        const auto [a, b] = kPairs[i];
        S[i].block(k, l, phi[a].cols(), mass_times[b].cols()).noalias() = phi[a].transpose() * mass_times[b];
      }
    }
  }
  return {std::make_move_iterator(S.begin()), std::make_move_iterator(S.end())};
}

std::vector<model::BasisRows> unit_second_moments(const fem::FieldMass& mass,
                                                  const std::vector<int>& free_dof) {
  std::vector<int> coordinate(n_displacements(mass), -1);
  for (std::size_t j = 0; j < free_dof.size(); ++j) coordinate[free_dof[j]] = static_cast<int>(j);
  std::array<model::SparseRows, 3> fields;
  for (int a = 0; a < 3; ++a) fields[a] = fields_of(mass, a, coordinate, static_cast<Index>(free_dof.size()));
  std::vector<model::BasisRows> moments;
  for (const auto [a, b] : kPairs) {
    const model::SparseRows momentum = mass.M_s * fields[b];
    moments.emplace_back(model::SparseRows(model::SparseRows(fields[a].transpose()) * momentum));
  }
  return moments;
}

}  // namespace elastogear::reduction
