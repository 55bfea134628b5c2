#pragma once
// Block L D L' of K - sigma M over the parts of a nested dissection (docs/theory, Eq. (2.10a)).

#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <vector>

#include "elastogear/base/petsc.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/eigensolver/shifted_solver.h"
#include "reduction/eigensolver/tall_basis.h"
#include "reduction/nested/elimination_tree.h"
#include "reduction/nested/front.h"

namespace elastogear::reduction {

/// Pivots are the matrices of whole parts, dense blocks. Where one of them is as good as singular the factor
/// is that of MUMPS, which takes pivots from several parts. On one rank.
class NestedFactor : public ShiftedSolver {
 public:
  static constexpr int kLargestLeaf = 160;  ///< rows

  /// K and M are borrowed, symmetric and sequential; M has no entries where K has none.
  NestedFactor(Mat K, Mat M, int largest_leaf = kLargestLeaf);

  int factorise(double sigma) override { return eliminate(sigma, true); }
  int count(double sigma) override { return eliminate(sigma, false); }
  void solve(Eigen::Ref<Eigen::MatrixXd> B) override;
  FactorSize size() const override;
  /// Is the last factor that of MUMPS?
  bool by_mumps() const { return whole_ != nullptr; }

 private:
  int eliminate(double sigma, bool keep);
  std::optional<int> eliminate_parts(double sigma, bool keep);
  Front make_front(const TreePart& part, double sigma);
  void add(int child, Front& front);

  Mat K_, M_;
  EliminationTree tree_;
  std::vector<int> place_;             // of rows of K in the matrices of the part at hand
  std::vector<Condensed> condensed_;   // of parts whose parent comes later
  std::vector<TallBasis> panel_ = {};  // of each part: -S_BI S_II^-1 above S_II^-1
  std::unique_ptr<ShiftedFactor> whole_ = {};
};

}  // namespace elastogear::reduction
