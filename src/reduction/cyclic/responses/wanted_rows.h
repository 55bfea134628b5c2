#pragma once
// Rows of the static responses of a cyclically symmetric body that `reduce` stores, and the responses of one
// harmonic.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace elastogear::reduction {

/// Loaded nodes and wanted rows in terms of a sector, for the first node of each orbit. Of stresses as many
/// rows are wanted as are independent at a node (independent_rows.h).
struct WantedRows {
  std::vector<int> surface_orbit,
      surface_sector_index;  ///< in the sector: of the loaded nodes; orbit -1: held
  std::vector<int> row, orbit, direction, sector_index;  ///< of stresses, entry by entry
  std::vector<double> value;
  std::vector<int> first_stress_row{0};       ///< n_orbits + 1: of each node
  std::vector<std::array<double, 6>> stress;  ///< which stress each of its rows stands for

  int n_loads() const { return static_cast<int>(3 * surface_orbit.size()); }
  int n_rows() const { return n_loads() + static_cast<int>(stress.size()); }
};

constexpr Eigen::Index kPiece =
    3 * 170;  ///< columns of responses, of whole nodes, that are put together at a time

/// Columns of the responses of one harmonic: of the fields z and, of a complex harmonic, below of the fields
/// i z.
struct Amplitudes {
  bool real;
  int k;
  std::vector<Eigen::MatrixXf> piece;  ///< kPiece columns each
};

}  // namespace elastogear::reduction
