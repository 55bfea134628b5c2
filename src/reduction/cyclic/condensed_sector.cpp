#include "reduction/cyclic/condensed_sector.h"

#include <algorithm>
#include <utility>

#include "reduction/dense/dense_hermitian.h"

namespace elastogear::reduction {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kTile = 64;  // rows and columns that fit into the cache with those that mirror them

// Adds T_a^H S_ab T_b, S_ab at `row` and `column` of S.
void add_block(const HarmonicBorder::Node& a, const HarmonicBorder::Node& b, const MatrixXd& S,
               std::pair<Index, Index> at, MatrixXcd& S_k) {
  const auto S_ab = S.block<3, 3>(at.first, at.second);
  if (a.on_axis || b.on_axis) {
    S_k.block(a.first, b.first, a.T.cols(), b.T.cols()) += a.T.adjoint() * S_ab.cast<Complex>() * b.T;
    return;
  }
  const Complex turn = std::conj(a.T(0, 0)) * b.T(0, 0);
  for (Index j = 0; j < 3; ++j) {
    const double* s = &S(at.first, at.second + j);
    Complex* sum = &S_k(a.first, b.first + j);
    for (Index i = 0; i < 3; ++i) sum[i] += turn * s[i];
  }
}

// The lower triangle := that of A + A^H.
void add_mirrored(MatrixXcd& A) {
  for (Index j = 0; j < A.cols(); j += kTile)
    for (Index i = j; i < A.rows(); i += kTile) {
      const Index m = std::min(kTile, A.rows() - i), n = std::min(kTile, A.cols() - j);
      const MatrixXcd mirrored = A.block(j, i, n, m).adjoint();
      if (i == j)
        A.block(i, j, m, n).triangularView<Eigen::Lower>() += mirrored;
      else
        A.block(i, j, m, n) += mirrored;
    }
}

}  // namespace

fem::Matrices assemble_open(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                            const model::Formulation& formulation) {
  const fem::Sector open = fem::cut_open(sector);
  return fem::assemble(PETSC_COMM_SELF, open, fem::make_harmonic(open, 0), regions, formulation);
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

MatrixXcd fold(const HarmonicBorder& border, const MatrixXd& S) {
  MatrixXcd S_k = MatrixXcd::Zero(border.size(), border.size());
  for (std::size_t b = 0; b < border.node.size(); ++b) {
    const HarmonicBorder::Node& of_b = border.node[b];
    const Index j = 3 * static_cast<Index>(b);
    for (std::size_t a = 0; a < b; ++a)
      add_block(border.node[a], of_b, S, {3 * static_cast<Index>(a), j}, S_k);
    Eigen::Matrix3d own = S.block<3, 3>(j, j).triangularView<Eigen::Upper>();
    own.diagonal() /= 2;
    S_k.block(of_b.first, of_b.first, of_b.T.cols(), of_b.T.cols()) +=
        of_b.T.adjoint() * own.cast<Complex>() * of_b.T;
  }
  add_mirrored(S_k);
  return S_k;
}

HarmonicFactor::HarmonicFactor(CondensedSector& sector, const fem::Harmonic& harmonic)
    : sector_(sector),
      harmonic_(harmonic),
      border_(make_border(sector.sector(), sector.nodes(), harmonic)),
      nodes_(sector.sector(), sector.nodes(), harmonic) {}

int HarmonicFactor::factorise(double sigma) {
  const ShiftedFactor& inner = sector_.factor_at(sigma);
  sigma_ = sigma;
  S_ = fold(border_, inner.schur());
  const int n_negative = sector_.n_negative() + factorise_hermitian(S_, pivot_);
  return harmonic_.real ? n_negative : 2 * n_negative;
}

void HarmonicFactor::solve(Eigen::Ref<MatrixXd> B) {
  MatrixXd F = nodes_.forces(B);
  solve_together(sector_, {{this, F.cols()}}, F);
  B = nodes_.coordinates(F);
}

void HarmonicFactor::solve_border(Eigen::Ref<MatrixXd> at_nodes) const {
  const int parts = nodes_.parts();
  const Index n = at_nodes.cols() / parts;
  MatrixXcd amplitudes = MatrixXcd::Zero(border_.size(), n), x(at_nodes.rows(), n);
  for (Index j = 0; j < n; ++j) {
    x.col(j).real() = at_nodes.col(parts * j);
    x.col(j).imag() = parts == 2 ? VectorXd(at_nodes.col(2 * j + 1)) : VectorXd(VectorXd::Zero(x.rows()));
  }
  for (std::size_t a = 0; a < border_.node.size(); ++a) {
    const auto& [first, T, on_axis] = border_.node[a];
    amplitudes.middleRows(first, T.cols()) += T.adjoint() * x.middleRows<3>(3 * static_cast<Index>(a));
  }
  solve_hermitian(S_, pivot_, amplitudes);
  for (std::size_t a = 0; a < border_.node.size(); ++a) {
    const auto& [first, T, on_axis] = border_.node[a];
    x.middleRows<3>(3 * static_cast<Index>(a)) = T * amplitudes.middleRows(first, T.cols());
  }
  for (Index j = 0; j < n; ++j) {
    at_nodes.col(parts * j) = x.col(j).real();
    if (parts == 2) at_nodes.col(2 * j + 1) = x.col(j).imag();
  }
}

FactorSize HarmonicFactor::size() const {
  const auto n = static_cast<double>(border_.size());
  const double parts = harmonic_.real ? 1 : 2;
  const FactorSize inner = sector_.factor_size();
  return {parts * inner.entries + 2 * parts * n * n / 2, inner.flops + 4. / 3 * n * n * n};
}

void solve_together(CondensedSector& sector, const std::vector<Share>& shares, Eigen::Ref<MatrixXd> F) {
  if (F.cols() == 0) return;
  ShiftedFactor& inner = sector.factor_at(shares.front().factor->sigma());
  MatrixXd at_border = inner.condense(F);
  Index first = 0;
  for (const auto& [factor, n] : shares) {
    factor->solve_border(at_border.middleCols(first, n));
    first += n;
  }
  inner.expand(std::move(at_border), F);
}

}  // namespace elastogear::reduction
