#pragma once
// L D L' of K - sigma M for one shift after another (MUMPS), with the order of elimination by METIS.

#include <Eigen/Core>
#include <memory>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

enum class Ordering { metis, mumps };  ///< mumps: its own choice

/// Size of a factor, estimated from the sparsity.
struct FactorSize {
  double entries = 0;  ///< of L
  double flops = 0;    ///< of one factorisation
};

/// The order of elimination is found once, in the constructor; every factorise() then replaces the factor.
/// K and M are borrowed and symmetric; M may be null, for zero. All members are collective. They throw Error
/// when MUMPS fails, naming its code.
class ShiftedFactor {
 public:
  ShiftedFactor(Mat K, Mat M, Ordering ordering = Ordering::metis);
  ~ShiftedFactor();
  ShiftedFactor(const ShiftedFactor&) = delete;
  ShiftedFactor& operator=(const ShiftedFactor&) = delete;

  /// Returns the number of eigenvalues of (K, M) below sigma: the negative pivots (Sylvester's law of
  /// inertia).
  int factorise(double sigma);
  /// B := (K - sigma M)^-1 B. B: own rows x columns. All columns go through the factor together.
  void solve(Eigen::Ref<Eigen::MatrixXd> B);
  FactorSize size() const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace elastogear::reduction
