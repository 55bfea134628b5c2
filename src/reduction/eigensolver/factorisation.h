#pragma once
// L D L' of K - sigma M for one shift after another (MUMPS), with the order of elimination by METIS.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastogear/base/petsc.h"
#include "reduction/eigensolver/shifted_solver.h"

namespace elastogear::reduction {

enum class Ordering { metis, mumps };  ///< mumps: its own choice

/// The order of elimination is found once, in the constructor; every factorise() then replaces the factor.
/// K and M are borrowed and symmetric; M may be null, for zero. All members are collective. They throw Error
/// when MUMPS fails, naming its code.
class ShiftedFactor : public ShiftedSolver {
 public:
  ShiftedFactor(Mat K, Mat M, Ordering ordering = Ordering::metis);
  /// Rows `kept`, ascending, are not eliminated: factorise() counts the pivots of the others. K: sequential.
  ShiftedFactor(Mat K, Mat M, const std::vector<int>& kept);
  ~ShiftedFactor() override;
  ShiftedFactor(const ShiftedFactor&) = delete;
  ShiftedFactor& operator=(const ShiftedFactor&) = delete;

  int factorise(double sigma) override;
  void solve(Eigen::Ref<Eigen::MatrixXd> B) override;
  FactorSize size() const override;

  /// Schur complement of the kept rows, whose upper triangle counts.
  const Eigen::MatrixXd& schur() const;
  /// What the right-hand sides B leave at the kept rows, kept rows x columns. Next comes expand().
  Eigen::MatrixXd condense(Eigen::Ref<Eigen::MatrixXd> B);
  /// B := the solution for the right-hand sides that were condensed last, of which the kept rows are X.
  void expand(Eigen::MatrixXd X, Eigen::Ref<Eigen::MatrixXd> B);

 private:
  void start_up();
  void analyse_in_order(std::vector<int> position);

  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace elastogear::reduction
