#include "reduction/cyclic/condensed_sector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "elastogear/base/error.h"
#include "reduction/dense/dense_hermitian.h"

namespace elastogear::reduction {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kLargestBorder = 0.25;  // of a sector's nodes, so that condensing to it pays

// The displacements of a node of the border, in the frame turned with it, from the amplitudes of its orbit.
MatrixXcd from_amplitudes(const fem::Harmonic& harmonic, bool on_axis, int sector_index) {
  if (!on_axis) return phase_after(harmonic, sector_index) * Eigen::Matrix3cd::Identity();
  const MatrixXd& P = harmonic.on_axis;
  if (harmonic.real) return P.cast<Complex>();
  MatrixXcd T(3, P.cols() / 2);
  T.real() = P.topLeftCorner(3, T.cols());
  T.imag() = P.bottomLeftCorner(3, T.cols());
  return T;
}

// Adds T_a^H S_ab T_b and the block that mirrors it, as far as they are in the lower triangle.
void add_block(const HarmonicBorder::Node& a, const HarmonicBorder::Node& b, const Eigen::Matrix3d& S_ab,
               MatrixXcd& S) {
  if (!a.on_axis && !b.on_axis) {
    const Complex turn = std::conj(a.T(0, 0)) * b.T(0, 0);
    if (a.first >= b.first) S.block<3, 3>(a.first, b.first) += turn * S_ab;
    if (b.first >= a.first) S.block<3, 3>(b.first, a.first) += std::conj(turn) * S_ab.transpose();
    return;
  }
  const MatrixXcd T_S_T = a.T.adjoint() * S_ab.cast<Complex>() * b.T;
  if (a.first >= b.first) S.block(a.first, b.first, T_S_T.rows(), T_S_T.cols()) += T_S_T;
  if (b.first >= a.first) S.block(b.first, a.first, T_S_T.cols(), T_S_T.rows()) += T_S_T.adjoint();
}

int n_amplitudes(const fem::Harmonic& harmonic, int orbit) {
  const int n = harmonic.first[orbit + std::size_t{1}] - harmonic.first[orbit];
  return harmonic.real ? n : n / 2;
}

}  // namespace

fem::Matrices assemble_open(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                            const model::Formulation& formulation) {
  const fem::Sector open = fem::cut_open(sector);
  return fem::assemble(PETSC_COMM_SELF, open, fem::make_harmonic(open, 0), regions, formulation);
}

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

CondensedSector::CondensedSector(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                                 const model::Formulation& formulation)
    : sector_(sector),
      nodes_(sort_nodes(sector)),
      matrices_(assemble_open(sector, regions, formulation)),
      kept_(border_rows(nodes_)),
      factor_(matrices_.K, matrices_.M, kept_) {}

ShiftedFactor& CondensedSector::factor_at(double sigma) {
  if (sigma_ == sigma) return factor_;
  sigma_.reset();
  n_negative_ = factor_.factorise(sigma);
  sigma_ = sigma;
  return factor_;
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
    border.node.push_back(
        {at->second, from_amplitudes(harmonic, on_axis, sector.node_orbits.sector_index[node]), on_axis});
  }
  return border;
}

MatrixXcd fold(const HarmonicBorder& border, const MatrixXd& S) {
  MatrixXcd S_k = MatrixXcd::Zero(border.size(), border.size());
  for (std::size_t b = 0; b < border.node.size(); ++b) {
    const HarmonicBorder::Node& of_b = border.node[b];
    const Index j = 3 * static_cast<Index>(b);
    for (std::size_t a = 0; a < b; ++a)
      add_block(border.node[a], of_b, S.block<3, 3>(3 * static_cast<Index>(a), j), S_k);
    const Eigen::Matrix3d own = S.block<3, 3>(j, j).selfadjointView<Eigen::Upper>();
    S_k.block(of_b.first, of_b.first, of_b.T.cols(), of_b.T.cols()) +=
        of_b.T.adjoint() * own.cast<Complex>() * of_b.T;
  }
  return S_k;
}

HarmonicFactor::HarmonicFactor(CondensedSector& sector, const fem::Harmonic& harmonic)
    : sector_(sector), harmonic_(harmonic), border_(make_border(sector.sector(), sector.nodes(), harmonic)) {
  const fem::NodeOrbits& node_orbits = sector.sector().node_orbits;
  for (int node : sector.nodes().inner) {
    const int orbit = node_orbits.orbit[node];
    for (int d = 0; d < 3; ++d)
      inner_.push_back({sector.nodes().row[node] + d, harmonic.first[orbit] + d,
                        harmonic.real ? -1 : harmonic.first[orbit] + 3 + d,
                        phase_after(harmonic, node_orbits.sector_index[node])});
  }
}

int HarmonicFactor::factorise(double sigma) {
  const ShiftedFactor& inner = sector_.factor_at(sigma);
  sigma_ = sigma;
  S_ = fold(border_, inner.schur());
  const int n_negative = sector_.n_negative() + factorise_hermitian(S_, pivot_);
  return harmonic_.real ? n_negative : 2 * n_negative;
}

void HarmonicFactor::solve(Eigen::Ref<MatrixXd> B) {
  ShiftedFactor& inner = sector_.factor_at(sigma_);
  const Index n = B.cols(), n_rows = inner_.size() + 3 * border_.node.size();
  const Index n_parts = harmonic_.real ? n : 2 * n;  // real parts, then imaginary ones
  const auto value = [&](int coordinate, int imaginary, Index j) {
    return Complex(B(coordinate, j), imaginary < 0 ? 0 : B(imaginary, j));
  };
  const auto enter = [&](Complex z, int coordinate, int imaginary, Index j) {
    B(coordinate, j) = z.real();
    if (imaginary >= 0) B(imaginary, j) = z.imag();
  };
  MatrixXd loads = MatrixXd::Zero(n_rows, n_parts);
  for (Index j = 0; j < n; ++j)
    for (const auto& [row, coordinate, imaginary, phase] : inner_) {
      const Complex z = phase * value(coordinate, imaginary, j);
      loads(row, j) = z.real();
      if (n_parts > n) loads(row, n + j) = z.imag();
    }
  const MatrixXd left = inner.condense(loads);
  MatrixXcd amplitudes(border_.size(), n), at_nodes(left.rows(), n);
  at_nodes.real() = left.leftCols(n);
  at_nodes.imag() = n_parts > n ? left.rightCols(n) : MatrixXd(MatrixXd::Zero(left.rows(), n));
  for (Index j = 0; j < n; ++j)
    for (std::size_t i = 0; i < border_.coordinate.size(); ++i)
      amplitudes(static_cast<Index>(i), j) = value(border_.coordinate[i], border_.imaginary[i], j);
  for (std::size_t a = 0; a < border_.node.size(); ++a) {
    const auto& [first, T, on_axis] = border_.node[a];
    amplitudes.middleRows(first, T.cols()) += T.adjoint() * at_nodes.middleRows<3>(3 * static_cast<Index>(a));
  }
  solve_hermitian(S_, pivot_, amplitudes);
  for (std::size_t a = 0; a < border_.node.size(); ++a) {
    const auto& [first, T, on_axis] = border_.node[a];
    at_nodes.middleRows<3>(3 * static_cast<Index>(a)) = T * amplitudes.middleRows(first, T.cols());
  }
  MatrixXd moved(left.rows(), n_parts);
  moved.leftCols(n) = at_nodes.real();
  if (n_parts > n) moved.rightCols(n) = at_nodes.imag();
  inner.expand(std::move(moved), loads);
  for (Index j = 0; j < n; ++j) {
    for (const auto& [row, coordinate, imaginary, phase] : inner_)
      enter(std::conj(phase) * Complex(loads(row, j), n_parts > n ? loads(row, n + j) : 0), coordinate,
            imaginary, j);
    for (std::size_t i = 0; i < border_.coordinate.size(); ++i)
      enter(amplitudes(static_cast<Index>(i), j), border_.coordinate[i], border_.imaginary[i], j);
  }
}

FactorSize HarmonicFactor::size() const {
  const auto n = static_cast<double>(border_.size());
  const double parts = harmonic_.real ? 1 : 2;
  const FactorSize inner = sector_.factor_size();
  return {parts * inner.entries + 2 * parts * n * n / 2, inner.flops + 4. / 3 * n * n * n};
}

}  // namespace elastogear::reduction
