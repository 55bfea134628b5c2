// Anderson's extrapolation of fixed-point iterations.
#include <gtest/gtest.h>

#include "dynamics/contact/extrapolation.h"

namespace elastogear::dynamics::extrapolation_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(Extrapolation, solves_an_affine_map_of_low_rank_that_does_not_contract) {
  constexpr int n = 12, rank = 3;
  MatrixXd A = MatrixXd::Zero(n, n);
  for (int i = 0; i < rank; ++i) A(i, (i + 1) % rank) = -3 - i;
  const VectorXd b = VectorXd::LinSpaced(n, 1, 2);
  Extrapolation extrapolation;
  VectorXd z = VectorXd::Zero(n);
  for (int call = 0; call < rank + 2; ++call) z = extrapolation.next(z, A * z + b);
  EXPECT_LT((A * z + b - z).norm(), 1e-10);
}

TEST(Extrapolation, stays_at_a_fixed_point) {
  const VectorXd z = VectorXd::Ones(4);
  Extrapolation extrapolation;
  for (int call = 0; call < 3; ++call) EXPECT_EQ(extrapolation.next(z, z), z);
}

}  // namespace
}  // namespace elastogear::dynamics::extrapolation_test
