#pragma once
// All harmonics of a body that repeats from one factor of its sector (docs/theory.md, Eq. (2.11a)).

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "elastogear/fem/sector_assembly.h"
#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// exp(i turns k alpha), the factor of an amplitude that is turned by so many sectors. Eq. (2.10).
std::complex<double> phase_after(const fem::Harmonic& harmonic, int turns);

/// Nodes of the sector cut open: those of the border, where it meets its images, and on the axis come last in
/// every harmonic; all others are the same in all of them.
struct SectorNodes {
  std::vector<int> inner, border;  ///< local nodes of the sector, ascending
  std::vector<int> row;            ///< of each local node, its first one in the matrices; -1: held
};

SectorNodes sort_nodes(const fem::Sector& sector);

/// Rows of the border's nodes, in their order.
std::vector<int> border_rows(const SectorNodes& nodes);

/// K and M of the sector cut open. Sequential.
fem::Matrices assemble_open(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions,
                            const model::Formulation& formulation);

/// Whether harmonics take less work by the border alone than each by itself.
bool condensing_pays(const fem::Sector& sector);

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

/// The border of a harmonic: amplitudes of its nodes' orbits, one after the other, and how the nodes follow
/// from them.
struct HarmonicBorder {
  struct Node {
    int first;           ///< of its orbit's amplitudes
    Eigen::MatrixXcd T;  ///< 3 x these
    bool on_axis;        ///< else T is a multiple of the unit matrix
  };
  std::vector<Node> node;       ///< in the order of SectorNodes::border
  std::vector<int> coordinate;  ///< of each amplitude its real coordinate in the harmonic
  std::vector<int> imaginary;   ///< and its imaginary one; -1: the harmonic is real

  Eigen::Index size() const { return static_cast<Eigen::Index>(coordinate.size()); }
};

HarmonicBorder make_border(const fem::Sector& sector, const SectorNodes& nodes,
                           const fem::Harmonic& harmonic);

/// T^H S T, of which the lower triangle is set. S: of the border's nodes; its upper triangle counts.
Eigen::MatrixXcd fold(const HarmonicBorder& border, const Eigen::MatrixXd& S);

/// The factor of one harmonic. Several of one sector must not be used in turn at different shifts often, for
/// the sector keeps one factor only.
class HarmonicFactor : public ShiftedSolver {
 public:
  /// Both are borrowed.
  HarmonicFactor(CondensedSector& sector, const fem::Harmonic& harmonic);

  /// Counts double eigenvalues of harmonics that are not real twice.
  int factorise(double sigma) override;
  void solve(Eigen::Ref<Eigen::MatrixXd> B) override;
  FactorSize size() const override;

 private:
  struct Inner {
    int row;                    // in the matrices of the sector
    int coordinate, imaginary;  // in the harmonic
    std::complex<double> phase;
  };

  CondensedSector& sector_;
  const fem::Harmonic& harmonic_;
  HarmonicBorder border_;
  std::vector<Inner> inner_ = {};
  double sigma_ = 0;
  Eigen::MatrixXcd S_ = {};  // L D L^H of the border
  std::vector<int> pivot_ = {};
};

}  // namespace elastogear::reduction
