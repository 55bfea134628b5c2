#include "reduction/eigensolver/block_product.h"

#include <gtest/gtest.h>

#include "../fem/system.h"

namespace elastogear::block_product_test {
namespace {

constexpr double kRoundoff = 1e-14;  // relative

// Column by column, by PETSc.
Eigen::MatrixXd product(Mat A, const Eigen::MatrixXd& X) {
  UniqueVec x, y;
  check(MatCreateVecs(A, x.out(), y.out()));
  Eigen::MatrixXd Y(X.rows(), X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    PetscScalar* values = nullptr;
    check(VecGetArray(x, &values));
    std::copy(X.col(j).begin(), X.col(j).end(), values);
    check(VecRestoreArray(x, &values));
    check(MatMult(A, x, y));
    check(VecGetArray(y, &values));
    std::copy(values, values + Y.rows(), Y.col(j).begin());
    check(VecRestoreArray(y, &values));
  }
  return Y;
}

TEST(BlockProduct, is_that_of_each_column) {
  using Storage = reduction::BlockProduct::Storage;
  const test::System system = test::assemble(test::brick({5, 3, 2}, {1, 0.4, 0.2}), {"xmin"});
  for (Mat A : {system.matrices.K.get(), system.matrices.M.get()})
    for (Storage storage : {Storage::in_place, Storage::without_zeros}) {
      const reduction::BlockProduct times(A, storage);
      for (int columns : {1, 8, 13}) {
        const Eigen::MatrixXd X = Eigen::MatrixXd::Random(times.n_own(), columns), Y = product(A, X);
        EXPECT_LE((times(X) - Y).norm(), kRoundoff * Y.norm());
      }
    }
}

}  // namespace
}  // namespace elastogear::block_product_test
