#pragma once
// All harmonics of a cyclically symmetric body from one factor of its sector (docs/theory, Eq. (2.11a)).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastogear/fem/sector_assembly.h"
#include "reduction/cyclic/sector_nodes.h"
#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// K and M of the sector cut open. Sequential.
fem::Matrices assemble_open(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                            const model::Formulation& formulation);

/// A = K - sigma M of the sector cut open, factorised but for its border.
class CondensedSector {
 public:
  /// sector: borrowed. Sequential.
  CondensedSector(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                  const model::Formulation& formulation);

  const fem::Sector& sector() const { return sector_; }
  const SectorNodes& nodes() const { return nodes_; }
  const fem::Matrices& matrices() const { return matrices_; }
  /// The factor at sigma; only another sigma takes another factorisation.
  ShiftedFactor& factor_at(double sigma);
  FactorSize factor_size() const { return factor_.size(); }
  /// Negative pivots of the inner rows of the last factor.
  int n_negative() const { return n_negative_; }

 private:
  const fem::Sector& sector_;
  SectorNodes nodes_;
  fem::Matrices matrices_;
  std::vector<int> kept_;
  ShiftedFactor factor_;
  std::optional<double> sigma_ = {};
  int n_negative_ = 0;
};

/// T^H S T, of which the lower triangle is set. S: of the border's nodes; its upper triangle counts.
Eigen::MatrixXcd fold(const HarmonicBorder& border, const Eigen::MatrixXd& S);

/// The factor of one harmonic. Several of one sector must not be used in turn at different shifts often, for
/// the sector keeps one factor only.
class HarmonicFactor : public ShiftedSolver {
 public:
  /// Both are borrowed.
  HarmonicFactor(CondensedSector& sector, const fem::Harmonic& harmonic);

  const HarmonicNodes& nodes() const { return nodes_; }
  double sigma() const { return sigma_; }
  /// Counts double eigenvalues of harmonics that are not real twice.
  int factorise(double sigma) override;
  void solve(Eigen::Ref<Eigen::MatrixXd> B) override;
  FactorSize size() const override;
  /// At the border's nodes: forces f become displacements T S_k^-1 T^H f.
  void solve_border(Eigen::Ref<Eigen::MatrixXd> at_nodes) const;

 private:
  CondensedSector& sector_;
  const fem::Harmonic& harmonic_;
  HarmonicBorder border_;
  HarmonicNodes nodes_;
  double sigma_ = 0;
  Eigen::MatrixXcd S_ = {};  // L D L^H of the border
  std::vector<int> pivot_ = {};
};

/// Columns of forces that belong to a harmonic.
struct Share {
  const HarmonicFactor* factor;
  Eigen::Index n_columns;
};

/// Forces F at the sector's nodes become displacements T_k (K_k - sigma M_k)^-1 T_k^H F: all columns, those
/// of one harmonic after those of another, go through the sector's factor together. All have one shift. Eq.
/// (2.11b).
void solve_together(CondensedSector& sector, const std::vector<Share>& shares, Eigen::Ref<Eigen::MatrixXd> F);

}  // namespace elastogear::reduction
