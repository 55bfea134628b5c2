// Bodies held in single directions in another program: the same mesh, holds and element.
#include <gtest/gtest.h>

#include <filesystem>

#include "../fem/other_cells.h"
#include "calculix.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::held_directions_calculix_test {
namespace {

const std::vector<std::string> kHolds = {"xmin:x", "ymin:y", "zmin:z", "xmax:yz"};
constexpr double kSameElement = 1e-4;  // of frequencies, relative: the same shape functions and quadrature
constexpr double kDigits = 1e-4;       // of stress, of the largest: six digits, and forces near the node

class InCalculix : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "held_in_calculix.h5";
  void SetUp() override {
    if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  }
  void TearDown() override { std::filesystem::remove(path_); }
  reduction::ReductionOptions options(int n_modes) const {
    reduction::ReductionOptions o;
    o.name = "block";
    o.regions = test::kSteelBody;
    o.restrain = kHolds;
    o.n_modes = n_modes;
    return o;
  }
};

TEST_F(InCalculix, the_frequencies_are_the_same) {
  const auto mesh =
      test::cells_of(mesh::CellType::hex20, test::distorted(test::brick({5, 2, 2}, {1, 0.2, 0.3}), 0.01));
  const auto expected = test::calculix_frequencies({mesh, test::kSteel, kHolds, "C3D20"}, 20);
  const auto report = reduction::reduce(MPI_COMM_SELF, mesh, options(20), path_);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(report.frequency(i) / expected[i], 1, kSameElement) << i;
}

TEST_F(InCalculix, the_static_answers_to_contact_forces_are_the_same) {
  const auto mesh = test::distorted(test::brick({6, 3, 3}, {0.6, 0.2, 0.3}), 0.01);
  auto o = options(8);
  o.element = model::Element::plain;
  o.flexibility = true;
  o.surface = {"ymax"};
  o.stress_nodes = {"zmax"};
  o.stress_recovery = reduction::RecoveryChoice::average;  // as CalculiX does
  reduction::reduce(MPI_COMM_SELF, mesh, o, path_);
  const model::ElasticBody body = io::read_body(path_);
  const int at = static_cast<int>(body.surface.node.size() / 2);
  const Eigen::Vector3d f(100, -300, 50);
  const Eigen::MatrixXd expected =
      test::calculix_stress({mesh, test::kSteel, kHolds, "C3D8"}, {{body.surface.node[at], f}});
  const int b = model::find_loaded(body.flexibility, at);
  const Eigen::MatrixXf G = io::read_stress_responses(path_, body.flexibility.surface.orbit[b]);
  const double largest = expected(Eigen::all, body.stress.node).cwiseAbs().maxCoeff();
  for (std::size_t e = 0; e < body.stress.node.size(); ++e) {
    const Eigen::VectorXd sigma = model::stress_responses(body.flexibility, {static_cast<int>(e)}, b, G) * f;
    EXPECT_LT((sigma - expected.col(body.stress.node[e])).cwiseAbs().maxCoeff(), kDigits * largest) << e;
  }
}

}  // namespace
}  // namespace elastogear::held_directions_calculix_test
