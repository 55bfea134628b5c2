#pragma once
// Static responses P K^-1 P' are a sum over parts of K; a contribution is one term of it
// (docs/theory, Eqs. (6.20a) and (6.20c)).

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace elastogear::reduction {

template <class T>
using Dense = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// From a matrix that is one part `response` of all rows to its loads; from one of many parts C C'. T: float,
/// as responses are stored, or double, where what is stored is a small difference of responses.
template <class T>
struct Contribution {
  std::vector<int> row = {};   ///< of P
  std::vector<int> load = {};  ///< of a whole matrix: rows of P, ascending
  Dense<T> response = {};      ///< of a whole matrix: rows x loads
  Dense<T> C = {};             ///< of a part: rows x its rows of K
  bool is_ordered = false;     ///< columns of C come in about ascending order of their lengths
  /// Of an ordered one, rows x steps: length of each row of C, over its scale, in the columns that are
  /// left out when those of so many steps, the last ones, count.
  Eigen::MatrixXf left_out = {};
};

template <class T>
using Contributions = std::vector<Contribution<T>>;

/// Of each of n_rows rows of P the root of its own response by all parts, the scale of what may be
/// neglected of it; 0: not in any.
template <class T>
Eigen::VectorXd row_scales(const Contributions<T>& contributions, int n_rows);

/// Orders the rows of a contribution whose columns are ordered such that far rows know of few columns, Eq.
/// (6.20c).
template <class T>
void order_rows(const Eigen::VectorXd& scale, Contribution<T>& contribution);

/// Y, rows of P x loads (rows of P): adds the contribution's responses to these loads. column: of each row of
/// P its column of Y, -1: none.
template <class T>
void add_responses(const Contribution<T>& contribution, const std::vector<int>& column, Dense<T>& Y);

/// Forgets the rows of P that are marked; what a leaf adds to loads stays.
template <class T>
void remove_rows(const std::vector<char>& marked, Contribution<T>& contribution);

/// Enters the responses of earlier groups of loads to the loads of later ones, which are those of the later
/// to the earlier: the matrix is symmetric. Load i is row i of P. column: where the responses to a load are
/// stored, in the order of the rows of P.
void fill_symmetric(const std::vector<std::vector<int>>& groups,
                    const std::function<float*(int load)>& column);

}  // namespace elastogear::reduction
