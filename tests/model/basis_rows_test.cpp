#include <gtest/gtest.h>

#include "elastogear/model/elastic_body.h"

namespace elastogear::basis_rows_test {
using namespace model;

namespace {

constexpr double kRoundoff = 1e-15;
constexpr int kNodes = 3;

TEST(BasisRows, displacement_of_a_node_is_its_part_of_the_whole_product) {
  for (Eigen::Index n_q = 0; n_q < 11; ++n_q) {
    const DenseRows dense = DenseRows::Random(3 * kNodes, n_q);
    const SparseRows sparse = dense.sparseView();
    const Eigen::VectorXd q = Eigen::VectorXd::Random(n_q);
    const Eigen::VectorXd all = dense * q;
    for (int node = 0; node < kNodes; ++node)
      for (const BasisRows& rows : {BasisRows(dense), BasisRows(sparse)})
        EXPECT_LE((displacement(rows, node, q) - all.segment<3>(3 * node)).norm(),
                  kRoundoff * static_cast<double>(n_q))
            << n_q << " coordinates, node " << node;
  }
}

}  // namespace
}  // namespace elastogear::basis_rows_test
