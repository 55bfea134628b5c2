#pragma once
// Static responses of the harmonics of a cyclically symmetric body, from one elimination of its sector
// (docs/theory, Eq. (6.20d)).

#include "elastogear/fem/sector_assembly.h"
#include "reduction/cyclic/condensed_sector.h"
#include "reduction/cyclic/responses/wanted_rows.h"
#include "reduction/static_response/nested_response.h"

namespace elastogear::reduction {

/// Of a held body. Memory: the wanted rows by the border's displacements, and by the loads.
class CondensedResponses {
 public:
  /// sector, wanted: borrowed.
  CondensedResponses(const fem::Sector& sector, const WantedRows& wanted,
                     const std::vector<model::MaterialRegion>& regions,
                     const model::Formulation& formulation);

  Amplitudes find(const fem::Harmonic& harmonic) const;

 private:
  // A row of the whole as far as it is one of the sector's: it adds to row `wanted`, turned by so many
  // sectors.
  struct Row {
    int wanted, turns;
  };

  model::SparseRows sector_rows();

  const fem::Sector& sector_;
  const WantedRows& wanted_;
  SectorNodes nodes_;
  std::vector<Row> row_ = {};
  std::vector<int> load_ = {};     // row_ of each load, -1: held
  Eigen::MatrixXf fixed_ = {};     // responses with the border held, rows x loads
  Eigen::MatrixXd S_ = {};         // of the border's nodes
  Eigen::MatrixXf E_ = {};         // rows by the border's displacements
  Eigen::MatrixXd smooth_ = {};    // orthonormal displacements of the border, polynomials of its positions
  Eigen::MatrixXd E_smooth_ = {};  // rows by these
};

}  // namespace elastogear::reduction
