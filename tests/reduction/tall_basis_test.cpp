#include "reduction/eigensolver/tall_basis.h"

#include <gtest/gtest.h>

#include <vector>

namespace elastogear::tall_basis_test {
namespace {

using namespace reduction;
using Eigen::MatrixXd;

constexpr double kRoundoff = 1e-14;  // relative

std::vector<Instructions> supported() {
  std::vector<Instructions> all{Instructions::portable};
  for (Instructions better : {Instructions::avx2, Instructions::avx512})
    if (better <= best_instructions()) all.push_back(better);
  return all;
}

// Numbers of rows, columns and vectors that fill slabs and tiles, and that do not.
struct Size {
  int n_rows, n_columns, n_vectors;
};
const std::vector<Size> kSizes{{1, 1, 1}, {128, 4, 4}, {127, 3, 5}, {129, 8, 16}, {1000, 37, 13}};

TEST(TallBasis, multiplies_like_a_plain_matrix_with_all_instructions) {
  for (Instructions instructions : supported())
    for (const Size& size : kSizes) {
      const MatrixXd V = MatrixXd::Random(size.n_rows, size.n_columns);
      const MatrixXd W = MatrixXd::Random(size.n_rows, size.n_vectors);
      const MatrixXd C = MatrixXd::Random(size.n_columns, size.n_vectors);
      TallBasis basis(size.n_rows, size.n_columns + 5, instructions);
      basis.set(0, V);
      EXPECT_LE((basis.dot(size.n_columns, W) - V.transpose() * W).norm(), kRoundoff * V.norm() * W.norm());
      MatrixXd Y = W;
      basis.add_product(0, C, Y);
      EXPECT_LE((Y - W - V * C).norm(), kRoundoff * (W.norm() + V.norm() * C.norm()));
    }
}

TEST(TallBasis, uses_the_asked_columns_alone) {
  const int n_rows = 300, n_columns = 20, first = 7, count = 6;
  const MatrixXd V = MatrixXd::Random(n_rows, n_columns), C = MatrixXd::Random(count, 3);
  TallBasis basis(n_rows, n_columns);
  for (int begin = 0; begin < n_columns; begin += 5) basis.set(begin, V.middleCols(begin, 5));
  MatrixXd Y = MatrixXd::Zero(n_rows, 3);
  basis.add_product(first, C, Y);
  EXPECT_LE((Y - V.middleCols(first, count) * C).norm(), kRoundoff * V.norm() * C.norm());
  EXPECT_LE((basis.dot(count, V) - V.leftCols(count).transpose() * V).norm(), kRoundoff * V.squaredNorm());
}

TEST(TallBasis, of_a_rank_without_rows_gives_zeros) {
  TallBasis basis(0, 8);
  basis.set(0, MatrixXd(0, 8));
  EXPECT_EQ(basis.dot(8, MatrixXd(0, 3)), MatrixXd::Zero(8, 3));
}

}  // namespace
}  // namespace elastogear::tall_basis_test
