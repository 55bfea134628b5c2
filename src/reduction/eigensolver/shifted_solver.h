#pragma once
// The interface of a factorisation that the shift-and-invert transformation works with.

#include <Eigen/Core>

namespace elastogear::reduction {

/// Size of a factor, estimated from the sparsity.
struct FactorSize {
  double entries = 0;  ///< of L
  double flops = 0;    ///< of one factorisation
};

/// A factor of K - sigma M for one shift after another. All members are collective.
class ShiftedSolver {
 public:
  virtual ~ShiftedSolver() = default;

  /// Returns the number of eigenvalues of (K, M) below sigma: the negative pivots (Sylvester's law of
  /// inertia).
  virtual int factorise(double sigma) = 0;
  /// The same number; solve() then needs factorise() first.
  virtual int count(double sigma) { return factorise(sigma); }
  /// B := (K - sigma M)^-1 B. B: own rows x columns. All columns go through the factor together.
  virtual void solve(Eigen::Ref<Eigen::MatrixXd> B) = 0;
  virtual FactorSize size() const = 0;
};

}  // namespace elastogear::reduction
