#pragma once
// Dense matrices of a part of a sparse one while it is eliminated (docs/theory, Eq. (6.20a)).

#include <Eigen/Core>
#include <vector>

namespace elastogear::reduction {

/// What an eliminated part leaves at its border.
struct Condensed {
  Eigen::MatrixXd S = {};  ///< Schur complement, of which the lower triangle is set
  Eigen::MatrixXd E = {};  ///< wanted rows by the displacements of the border
};

/// Schur complements S and wanted rows E of a part I and of the border B around it.
struct Front {
  Eigen::MatrixXd S_II, S_BI, S_BB;  ///< lower triangle
  Eigen::MatrixXd E_I, E_B;

  /// All zero.
  Front(Eigen::Index n_inner, Eigen::Index n_border, Eigen::Index n_wanted);
  Eigen::Index n_inner() const { return S_II.rows(); }
};

/// Adds what a child has left. place: of the child's border in I, or behind it in B, ascending; row: of its
/// wanted rows in those of the front, ascending.
void add_child(const Condensed& child, const std::vector<int>& place, const std::vector<int>& row,
               Front& front);

/// Eliminates I, whose factor L stands in S_II: E_I := C, S_BB := S_BB - S_BI S_II^-1 S_IB, E_B := E_B -
/// E_I S_II^-1 S_IB. V: orthonormal, C = E_I L^-T V; empty: the unit matrix.
void eliminate_inner(const Eigen::MatrixXd& V, Front& front);

}  // namespace elastogear::reduction
