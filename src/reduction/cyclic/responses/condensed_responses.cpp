#include "reduction/cyclic/responses/condensed_responses.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "elastogear/base/rotation.h"
#include "reduction/dense/dense_blas.h"
#include "reduction/dense/dense_hermitian.h"
#include "reduction/dense/residual.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

constexpr int kDegree = 4;  // of the polynomials that are smooth displacements of a border

// A node of the sector for each orbit and sector: that one itself, or another of its orbit.
class NodeOfOrbit {
 public:
  explicit NodeOfOrbit(const fem::Sector& sector) : sector_(sector), nodes_(sector.n_orbits()) {
    for (std::size_t node = 0; node < sector.node_orbits.orbit.size(); ++node)
      if (const int orbit = sector.node_orbits.orbit[node]; orbit >= 0)
        nodes_[orbit].push_back(static_cast<int>(node));
  }

  int operator()(int orbit, int sector_index) const {
    for (int node : nodes_[orbit])
      if (sector_.node_orbits.sector_index[node] == sector_index) return node;
    return nodes_[orbit].front();
  }

 private:
  const fem::Sector& sector_;
  std::vector<std::vector<int>> nodes_;
};

// E T, E: rows by the displacements of the border's nodes.
MatrixXcd by_amplitudes(const MatrixXf& E, const HarmonicBorder& border) {
  MatrixXcd result = MatrixXcd::Zero(E.rows(), border.size());
  for (std::size_t a = 0; a < border.node.size(); ++a) {
    const auto& [first, T, on_axis] = border.node[a];
    result.middleCols(first, T.cols()) +=
        E.middleCols<3>(3 * static_cast<Index>(a)).cast<std::complex<double>>() * T;
  }
  return result;
}

// Displacements of the border's nodes, in their turned frames, that are polynomials of a low degree of their
// positions, orthonormal.
MatrixXd smooth_fields(const fem::Sector& sector, const std::vector<int>& border) {
  std::vector<Eigen::Vector3i> power;
  for (int i = 0; i <= kDegree; ++i)
    for (int j = 0; i + j <= kDegree; ++j)
      for (int k = 0; i + j + k <= kDegree; ++k) power.emplace_back(i, j, k);
  const auto n = static_cast<Index>(border.size());
  Eigen::Matrix3Xd x = sector.mesh.X(Eigen::all, border);
  x.colwise() -= Eigen::Vector3d(x.rowwise().mean());
  x /= x.cwiseAbs().maxCoeff();
  MatrixXd fields(3 * n, 3 * static_cast<Index>(power.size()));
  for (Index a = 0; a < n; ++a) {
    const double angle = 2 * std::numbers::pi / sector.turn.n_sectors *
                         sector.node_orbits.sector_index[border[static_cast<std::size_t>(a)]];
    const Eigen::Matrix3d into_frame = rotation_matrix(-angle * sector.turn.axis);
    for (std::size_t m = 0; m < power.size(); ++m) {
      double monomial = 1;
      for (int d = 0; d < 3; ++d) monomial *= std::pow(x(d, a), power[m][d]);
      fields.block<3, 3>(3 * a, 3 * static_cast<Index>(m)) = monomial * into_frame;
    }
  }
  if (fields.rows() < fields.cols()) return MatrixXd(3 * n, 0);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(fields);
  return qr.householderQ() * MatrixXd::Identity(fields.rows(), qr.rank());
}

// Re and Im of the columns T Z beside each other.
MatrixXd at_nodes(const HarmonicBorder& border, const MatrixXcd& Z) {
  MatrixXd X(3 * static_cast<Index>(border.node.size()), 2 * Z.cols());
  for (std::size_t a = 0; a < border.node.size(); ++a) {
    const auto& [first, T, on_axis] = border.node[a];
    const MatrixXcd x = T * Z.middleRows(first, T.cols());
    X.middleRows<3>(3 * static_cast<Index>(a)) << x.real(), x.imag();
  }
  return X;
}

}  // namespace

model::SparseRows CondensedResponses::sector_rows() {
  const NodeOfOrbit node_of(sector_);
  const int Z = sector_.turn.n_sectors;
  std::vector<Eigen::Triplet<double>> entries;
  std::map<std::pair<int, int>, int> row_at;  // of wanted rows and turns
  const auto add = [&](int wanted, int orbit, int sector_index, const Eigen::RowVector3d& weight) {
    const int node = node_of(orbit, sector_index);
    const bool on_axis = sector_.on_axis[orbit] != 0;
    const int turns = on_axis ? 0 : (sector_index - sector_.node_orbits.sector_index[node] + Z) % Z;
    const auto [at, is_new] = row_at.try_emplace({wanted, turns}, static_cast<int>(row_.size()));
    if (is_new) row_.push_back({wanted, turns});
    const double angle = on_axis ? 0 : 2 * std::numbers::pi / Z * sector_index;
    const Eigen::RowVector3d values = weight * rotation_matrix(angle * sector_.turn.axis);
    for (int d = 0; d < 3; ++d) entries.emplace_back(at->second, nodes_.row[node] + d, values[d]);
    return at->second;
  };
  for (int i = 0; i < wanted_.n_loads(); ++i) {
    const int orbit = wanted_.surface_orbit[i / 3];
    load_.push_back(orbit < 0 ? -1
                              : add(i, orbit, wanted_.surface_sector_index[i / 3],
                                    Eigen::Vector3d::Unit(i % 3).transpose()));
  }
  for (std::size_t i = 0; i < wanted_.row.size(); ++i)
    add(wanted_.n_loads() + wanted_.row[i], wanted_.orbit[i], wanted_.sector_index[i],
        wanted_.value[i] * Eigen::Vector3d::Unit(wanted_.direction[i]).transpose());
  const auto n_nodes = static_cast<Index>(nodes_.inner.size() + nodes_.border.size());
  model::SparseRows P(static_cast<Index>(row_.size()), 3 * n_nodes);
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

CondensedResponses::CondensedResponses(const fem::Sector& sector, const WantedRows& wanted,
                                       const std::vector<model::MaterialRegion>& regions,
                                       const model::Formulation& formulation)
    : sector_(sector), wanted_(wanted), nodes_(sort_nodes(sector)) {
  const model::SparseRows P = sector_rows();
  const fem::Matrices matrices = assemble_open(sector, regions, formulation);
  std::vector<int> loads;
  for (std::size_t i = 0; i < load_.size(); ++i)
    if (load_[i] >= 0) loads.push_back(load_[i]);
  KeptRows left;
  NestedResponse response(matrices.K, P, loads, border_rows(nodes_), left);
  std::vector<Index> column_of(row_.size(), -1);  // of loads that are not held
  for (std::size_t i = 0; i < load_.size(); ++i)
    if (load_[i] >= 0) column_of[load_[i]] = static_cast<Index>(i);
  fixed_.setZero(P.rows(), wanted.n_loads());
  for (const std::vector<int>& group : response.groups()) {
    const MatrixXf Y = response.next();
    for (std::size_t i = 0; i < group.size(); ++i)
      fixed_.col(column_of[group[i]]) = Y.col(static_cast<Index>(i));
  }
  fill_symmetric(response.groups(), [&](int load) { return fixed_.col(column_of[load]).data(); });
  S_ = std::move(left.S);
  E_ = left.E.cast<float>();
  smooth_ = smooth_fields(sector, nodes_.border);
  E_smooth_ = left.E * smooth_;
}

Amplitudes CondensedResponses::find(const fem::Harmonic& harmonic) const {
  const HarmonicBorder border = make_border(sector_, nodes_, harmonic);
  MatrixXcd S = fold(border, S_);
  if (!cholesky_hermitian(S)) fail_singular("a part of it is not positive definite");
  const Index n = wanted_.n_loads(), n_rows = wanted_.n_rows();
  MatrixXf E_load = MatrixXf::Zero(n, E_.cols());
  for (Index j = 0; j < n; ++j)
    if (load_[j] >= 0) E_load.row(j) = E_.row(load_[j]);
  MatrixXcd X = by_amplitudes(E_load, border).adjoint();
  solve_cholesky(S, X);
  // Smooth displacements of the border move the sector far more than they strain it. Large numbers cancel in
  // their stresses, which are found in double precision.
  MatrixXd exact = at_nodes(border, X);
  MatrixXd smooth(smooth_.cols(), exact.cols()), strained(E_smooth_.rows(), exact.cols());
  multiply(Op::transposed, Op::plain, 1, smooth_, exact, 0, smooth);
  multiply(Op::plain, Op::plain, -1, smooth_, smooth, 1, exact);
  multiply(Op::plain, Op::plain, 1, E_smooth_, smooth, 0, strained);
  const MatrixXf moved = exact.cast<float>(), of_smooth = strained.cast<float>();
  std::vector<std::complex<double>> phase_of;
  for (int turns = 0; turns < harmonic.n_sectors; ++turns) phase_of.push_back(phase_after(harmonic, turns));
  const auto scale = static_cast<float>((harmonic.real ? 1.0 : 2.0) / harmonic.n_sectors);
  Amplitudes amplitudes{harmonic.real, harmonic.k, {}};
  MatrixXf re, im;
  for (Index first = 0; first < n; first += kPiece) {
    const Index width = std::min(kPiece, n - first);
    re = fixed_.middleCols(first, width) + of_smooth.middleCols(first, width);
    im = of_smooth.middleCols(n + first, width);
    multiply(Op::plain, Op::plain, 1.0F, E_, moved.middleCols(first, width), 1.0F, re);
    multiply(Op::plain, Op::plain, 1.0F, E_, moved.middleCols(n + first, width), 1.0F, im);
    MatrixXf& Y = amplitudes.piece.emplace_back(MatrixXf::Zero(harmonic.real ? n_rows : 2 * n_rows, width));
    for (Index j = 0; j < width; ++j) {
      const int load = load_[first + j];
      const std::complex<double> of_load = load < 0 ? 0 : std::conj(phase_of[row_[load].turns]);
      for (std::size_t i = 0; i < row_.size(); ++i) {
        const auto at = static_cast<Index>(i);
        const std::complex<float> z = std::complex<float>(re(at, j), im(at, j)) *
                                      std::complex<float>(phase_of[row_[i].turns] * of_load);
        Y(row_[i].wanted, j) += scale * z.real();
        if (!harmonic.real) Y(n_rows + row_[i].wanted, j) -= scale * z.imag();
      }
    }
  }
  return amplitudes;
}

}  // namespace elastogear::reduction
