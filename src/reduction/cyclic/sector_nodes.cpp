#include "reduction/cyclic/sector_nodes.h"

#include <cmath>
#include <map>
#include <numbers>

namespace elastogear::reduction {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kLargestBorder = 0.25;  // of a sector's nodes, so that condensing to it pays

// T of a node on the axis.
MatrixXcd directions_on_axis(const fem::Harmonic& harmonic) {
  const MatrixXd& P = harmonic.on_axis;
  if (harmonic.real) return P.cast<Complex>();
  MatrixXcd T(3, P.cols() / 2);
  T.real() = P.topLeftCorner(3, T.cols());
  T.imag() = P.bottomLeftCorner(3, T.cols());
  return T;
}

int n_amplitudes(const fem::Harmonic& harmonic, int orbit) {
  const int n = harmonic.first[orbit + std::size_t{1}] - harmonic.first[orbit];
  return harmonic.real ? n : n / 2;
}

}  // namespace

std::vector<int> border_rows(const SectorNodes& nodes) {
  std::vector<int> rows;
  for (int node : nodes.border)
    for (int d = 0; d < 3; ++d) rows.push_back(nodes.row[node] + d);
  return rows;
}

Complex phase_after(const fem::Harmonic& harmonic, int turns) {
  const double alpha = 2 * std::numbers::pi / harmonic.n_sectors;
  return std::polar(1.0,
                    alpha * static_cast<double>(static_cast<long>(turns) * harmonic.k % harmonic.n_sectors));
}

SectorNodes sort_nodes(const fem::Sector& sector) {
  SectorNodes nodes;
  std::vector<int> n_nodes(static_cast<std::size_t>(sector.n_orbits()), 0);
  const std::vector<int>& orbit = sector.node_orbits.orbit;
  for (int o : orbit)
    if (o >= 0) ++n_nodes[o];
  int row = 0;
  for (std::size_t node = 0; node < orbit.size(); ++node) {
    const int o = orbit[node];
    nodes.row.push_back(o < 0 ? -1 : row);
    if (o < 0) continue;
    row += 3;
    (n_nodes[o] > 1 || sector.on_axis[o] ? nodes.border : nodes.inner).push_back(static_cast<int>(node));
  }
  return nodes;
}

bool condensing_pays(const fem::Sector& sector) {
  const SectorNodes nodes = sort_nodes(sector);
  const auto n_border = static_cast<double>(nodes.border.size()),
             n_inner = static_cast<double>(nodes.inner.size());
  return sector.turn.n_sectors > 2 && n_border > 0 && n_border <= kLargestBorder * (n_border + n_inner);
}

HarmonicBorder make_border(const fem::Sector& sector, const SectorNodes& nodes,
                           const fem::Harmonic& harmonic) {
  HarmonicBorder border;
  std::map<int, int> first;  // amplitude of each orbit
  for (int node : nodes.border) {
    const int orbit = sector.node_orbits.orbit[node], n = n_amplitudes(harmonic, orbit);
    const auto [at, is_new] = first.try_emplace(orbit, static_cast<int>(border.size()));
    for (int i = 0; is_new && i < n; ++i) {
      border.coordinate.push_back(harmonic.first[orbit] + i);
      border.imaginary.push_back(harmonic.real ? -1 : harmonic.first[orbit] + n + i);
    }
    const bool on_axis = sector.on_axis[orbit] != 0;
    const Complex turn = phase_after(harmonic, sector.node_orbits.sector_index[node]);
    border.node.push_back(
        {at->second, on_axis ? directions_on_axis(harmonic) : MatrixXcd(turn * Eigen::Matrix3cd::Identity()),
         on_axis});
  }
  return border;
}

HarmonicNodes::HarmonicNodes(const fem::Sector& sector, const SectorNodes& nodes,
                             const fem::Harmonic& harmonic)
    : real_(harmonic.real), n_coordinates_(harmonic.size()), on_axis_(directions_on_axis(harmonic)) {
  std::vector<bool> known(static_cast<std::size_t>(sector.n_orbits()), false);
  for (std::size_t node = 0; node < nodes.row.size(); ++node) {
    if (nodes.row[node] < 0) continue;
    const int orbit = sector.node_orbits.orbit[node];
    node_.push_back({nodes.row[node], harmonic.first[orbit], n_amplitudes(harmonic, orbit), !known[orbit],
                     sector.on_axis[orbit] != 0,
                     phase_after(harmonic, sector.node_orbits.sector_index[node])});
    known[orbit] = true;
    n_rows_ += 3;
  }
}

MatrixXcd HarmonicNodes::from_amplitudes(const Node& node) const {
  return node.on_axis ? on_axis_ : MatrixXcd(node.turn * Eigen::Matrix3cd::Identity());
}

MatrixXd HarmonicNodes::forces(const Eigen::Ref<const MatrixXd>& Z) const {
  MatrixXd F = MatrixXd::Zero(n_rows_, Z.cols() * parts());
  for (const Node& node : node_) {
    if (!node.first) continue;
    const int n = node.n_amplitudes;
    MatrixXcd z(n, Z.cols());
    z.real() = Z.middleRows(node.coordinate, n);
    z.imag() = real_ ? MatrixXd(MatrixXd::Zero(n, Z.cols())) : MatrixXd(Z.middleRows(node.coordinate + n, n));
    const MatrixXcd f = from_amplitudes(node) * z;
    for (Index j = 0; j < Z.cols(); ++j) {
      F.block<3, 1>(node.row, j * parts()) = f.col(j).real();
      if (!real_) F.block<3, 1>(node.row, 2 * j + 1) = f.col(j).imag();
    }
  }
  return F;
}

MatrixXd HarmonicNodes::add_up(const Eigen::Ref<const MatrixXd>& F, bool first_only) const {
  const Index n_vectors = F.cols() / parts();
  MatrixXd Z = MatrixXd::Zero(n_coordinates_, n_vectors);
  for (Index j = 0; j < n_vectors; ++j)
    for (const Node& node : node_) {
      if (first_only && !node.first) continue;
      const int n = node.n_amplitudes;
      Eigen::Vector3cd f = Eigen::Vector3cd::Zero(), z = f;
      f.real() = F.block<3, 1>(node.row, j * parts());
      if (!real_) f.imag() = F.block<3, 1>(node.row, 2 * j + 1);
      if (node.on_axis)
        z.head(n) = on_axis_.adjoint() * f;
      else
        z = std::conj(node.turn) * f;
      Z.col(j).segment(node.coordinate, n) += z.head(n).real();
      if (!real_) Z.col(j).segment(node.coordinate + n, n) += z.head(n).imag();
    }
  return Z;
}

}  // namespace elastogear::reduction
