#pragma once
// Shift-and-invert of SLEPc's ST for whole blocks of columns, and the inertia of what it factorised.

#include <slepcst.h>

#include <Eigen/Core>

#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// st: STSINVERT of (K, M), set up, borrowed. All members are collective and throw Error when PETSc, SLEPc or
/// the factorisation fails.
class SpectralTransform {
 public:
  explicit SpectralTransform(ST st) : st_(st) {}

  /// Moves the shift. Returns the number of eigenvalues of (K, M) below sigma: the negative pivots of
  /// K - sigma M. The solver of st must be the PC type "ldl", or a factorisation that knows its inertia.
  int factorise(double sigma);
  /// (K - sigma M)^-1 B. B: own rows x columns. All columns go through the factor together.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B);
  /// Size of the factor; a guess by the number of rows when the solver is not "ldl".
  FactorSize size() const;

 private:
  ST st_;
};

}  // namespace elastogear::reduction
