#pragma once
// Nodes of a sector that is cut open, and how their displacements follow from a harmonic's coordinates
// (docs/theory, Eqs. (2.10) to (2.12), (2.11a)).

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "elastogear/fem/sector.h"

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

/// Whether harmonics take less work by the border alone than each by itself.
bool condensing_pays(const fem::Sector& sector);

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

/// v = T z: displacements v of all nodes of the sector cut open, each in the frame turned with its node, from
/// real coordinates z of a harmonic. v has the rows of the sector's matrices, and is two columns, its real
/// part and then its imaginary one, or one column where the harmonic is real.
class HarmonicNodes {
 public:
  HarmonicNodes(const fem::Sector& sector, const SectorNodes& nodes, const fem::Harmonic& harmonic);

  int n_rows() const { return n_rows_; }
  int parts() const { return real_ ? 1 : 2; }
  /// Forces F at one node of each orbit, T^H F = Z.
  Eigen::MatrixXd forces(const Eigen::Ref<const Eigen::MatrixXd>& Z) const;
  /// T^H F.
  Eigen::MatrixXd fold(const Eigen::Ref<const Eigen::MatrixXd>& F) const { return add_up(F, false); }
  /// z of V = T z.
  Eigen::MatrixXd coordinates(const Eigen::Ref<const Eigen::MatrixXd>& V) const { return add_up(V, true); }

 private:
  struct Node {
    int row, coordinate, n_amplitudes;
    bool first, on_axis;        // first: of those of its orbit
    std::complex<double> turn;  // T of a node off the axis, times the unit matrix
  };
  Eigen::MatrixXcd from_amplitudes(const Node& node) const;
  Eigen::MatrixXd add_up(const Eigen::Ref<const Eigen::MatrixXd>& F, bool first_only) const;

  bool real_;
  int n_rows_ = 0, n_coordinates_;
  Eigen::MatrixXcd on_axis_;  // T of a node on the axis
  std::vector<Node> node_ = {};
};

}  // namespace elastogear::reduction
