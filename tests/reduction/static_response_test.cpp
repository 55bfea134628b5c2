// Static answers of the unreduced body against those of its full and modal bases.

#include "elastogear/reduction/static_response.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <filesystem>

#include "../fem/brick.h"
#include "elastogear/base/error.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::static_response_test {
namespace {

constexpr double kRoundoff = 1e-10;    // of a factorisation, relative
constexpr double kEigensolver = 1e-7;  // of mode shapes, relative

reduction::ReductionOptions options(model::Basis basis, int n_modes) {
  reduction::ReductionOptions o;
  o.name = "bar";
  o.regions = {{"", test::kSteel}};
  o.restrain = {"xmin"};
  o.surface = {"zmax"};
  o.stress_nodes = {"xmax", "ymax"};
  o.basis = basis;
  o.n_modes = n_modes;
  return o;
}

class StaticResponse : public testing::Test {
 protected:
  mesh::Mesh mesh_ = test::distorted(test::brick({4, 2, 2}, {1, 0.4, 0.3}), 0.02);
  std::string path_ = testing::TempDir() + "static_response.h5";

  model::ElasticBody reduce(model::Basis basis, int n_modes = 1) {
    reduction::reduce(MPI_COMM_SELF, mesh_, options(basis, n_modes), path_);
    return io::read_body(path_);
  }
  void expect_that_of_full_basis(const std::vector<std::string>& restrain) {
    auto o = options(model::Basis::full, 1);
    o.restrain = restrain;
    reduction::reduce(MPI_COMM_SELF, mesh_, o, path_);
    const model::ElasticBody body = io::read_body(path_);
    const io::BodySource source = io::read_body_source(path_);
    reduction::StaticResponse response(source);
    const std::vector<int> loaded{body.surface.node.back(), body.surface.node[body.surface.node.size() / 2]};
    const Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Random(3, 2) * 1e3;

    Eigen::VectorXd h = Eigen::VectorXd::Zero(body.n_q());
    model::add_force(body.surface.Phi, static_cast<int>(body.surface.node.size()) - 1, f.col(0), h);
    model::add_force(body.surface.Phi, static_cast<int>(body.surface.node.size() / 2), f.col(1), h);
    const Eigen::VectorXd q = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(body.K_r).solve(h);

    const Eigen::Matrix3Xd u = io::read_displacement_field(path_, q);
    EXPECT_LT((response.displacement(loaded, f.reshaped()) - u.reshaped()).norm(), kRoundoff * u.norm());
    const Eigen::VectorXd sigma = model::multiply(body.stress.Psi, q);
    const Eigen::VectorXd found = response.stress(loaded, body.stress.node) * f.reshaped();
    EXPECT_LT((found - sigma).norm(), kRoundoff * sigma.norm());
  }
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_F(StaticResponse, is_that_of_the_full_basis) { expect_that_of_full_basis({"xmin"}); }

TEST_F(StaticResponse, of_nodes_held_in_single_directions_is_that_of_the_full_basis) {
  expect_that_of_full_basis({"xmin:x", "ymin:y", "zmin:z", "zmax:xz"});
}

TEST_F(StaticResponse, of_all_modes_together_is_that_of_the_body) {
  const int n_free = 3 * 4 * 3 * 3;
  const model::ElasticBody body = reduce(model::Basis::modal, n_free);
  const io::BodySource source = io::read_body_source(path_);
  const int node = static_cast<int>(body.surface.node.size()) - 1;
  Eigen::VectorXd h = Eigen::VectorXd::Zero(body.n_q());
  const Eigen::Vector3d f(100, -300, 200);
  model::add_force(body.surface.Phi, node, f, h);
  const Eigen::VectorXd q = body.K_r.diagonal().cwiseInverse().cwiseProduct(h);
  const Eigen::VectorXd sigma = model::multiply(body.stress.Psi, q);
  const Eigen::VectorXd found =
      reduction::StaticResponse(source).stress({body.surface.node[node]}, body.stress.node) * f;
  EXPECT_LT((found - sigma).norm(), kEigensolver * sigma.norm());
}

TEST_F(StaticResponse, asks_for_three_forces_on_each_node) {
  reduce(model::Basis::full);
  const io::BodySource source = io::read_body_source(path_);
  EXPECT_THROW(reduction::StaticResponse(source).displacement({0, 1}, Eigen::Matrix3Xd::Ones(3, 2)), Error);
}

TEST_F(StaticResponse, to_a_force_on_a_restrained_node_is_nothing) {
  reduce(model::Basis::full);
  const io::BodySource source = io::read_body_source(path_);
  reduction::StaticResponse response(source);
  const int held = mesh::node_set(source.mesh, "xmin").front();
  EXPECT_EQ(response.displacement({held}, Eigen::Vector3d(1, 2, 3)).norm(), 0);
}

}  // namespace
}  // namespace elastogear::static_response_test
