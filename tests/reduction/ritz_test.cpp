// What each basis beside eigenmodes promises, against the dense matrices of a small body, on any number of
// ranks.
#include "reduction/bases/ritz.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>

#include "../fem/brick.h"
#include "elastogear/base/error.h"
#include "elastogear/reduction/reduce.h"
#include "elastogear/reduction/surface_load.h"
#include "full_basis.h"

namespace elastogear::ritz_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using reduction::RitzKind;

constexpr double kSolves = 1e-9;   // of factorisations and the dense eigenproblem, relative
constexpr double kDropped = 1e-7;  // what a column may lack when it is left out, energy norm, relative
constexpr double kVisible = 1e-4;  // a difference that is none of the above
constexpr int kModes = 12;

// Of this test, another one for each number of ranks.
std::string file(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return testing::TempDir() + name + std::to_string(size) + ".h5";
}

int rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

class Ritz : public testing::Test {
 protected:
  mesh::Mesh mesh_ = test::distorted(test::brick({4, 3, 2}, {1, 0.4, 0.25}), 0.02);
  std::string path_ = file("ritz"), full_ = file("ritz_full");
  reduction::ReductionReport report_;
  // Rank 0, in the coordinates of the full basis:
  MatrixXd K_, M_, Phi_;
  model::ElasticBody body_;
  std::vector<int> dof_;

  reduction::ReductionOptions options(RitzKind kind) const {
    reduction::ReductionOptions o;
    o.name = "bar";
    o.regions = test::kSteelBody;
    o.restrain = {"xmin"};
    o.surface = {"xmax", "zmax"};
    o.loaded = {"xmax"};
    o.n_modes = kModes;
    o.window = kModes;
    o.ritz = reduction::RitzOptions{kind};
    return o;
  }
  void reduce(const reduction::ReductionOptions& o) {
    const mesh::Mesh none;
    report_ = reduction::reduce(PETSC_COMM_WORLD, rank() == 0 ? mesh_ : none, o, path_);
    if (rank() != 0) return;
    reduction::ReductionOptions full = o;
    full.ritz.reset();
    full.basis = model::Basis::full;
    reduction::reduce(PETSC_COMM_SELF, mesh_, full, full_);
    const model::ElasticBody reference = io::read_body(full_);
    K_ = reference.K_r;
    M_ = reference.M_r;
    body_ = io::read_body(path_);
    dof_ = io::read_body_source(full_).free_dof;
    Phi_ = test::modes_in_full_basis(path_, full_);
  }
  void TearDown() override {
    if (rank() != 0) return;
    std::filesystem::remove(path_);
    std::filesystem::remove(full_);
  }

  VectorXd eigenvalues() const { return body_.K_r.diagonal(); }
  VectorXd exact_eigenvalues() const {
    return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K_, M_, Eigen::EigenvaluesOnly).eigenvalues();
  }
  // Coordinates on the nodes of a set.
  std::vector<int> rows_on(const std::string& set) const {
    const std::vector<int>& nodes = mesh_.node_sets.at(set);
    std::vector<int> rows;
    for (std::size_t i = 0; i < dof_.size(); ++i)
      if (std::find(nodes.begin(), nodes.end(), dof_[i] / 3) != nodes.end())
        rows.push_back(static_cast<int>(i));
    return rows;
  }
  VectorXd forces_on(const std::string& set) const {
    VectorXd f = VectorXd::Zero(K_.rows());
    int k = 0;
    for (int row : rows_on(set)) f(row) = std::sin(1.0 + k++);
    return f;
  }
  // |K^-1 f - Phi Lambda^-1 Phi' f| / |K^-1 f|, energy norm.
  double static_error(const VectorXd& f) const {
    const VectorXd u = K_.llt().solve(f), h = Phi_.transpose() * f;
    const VectorXd rest = u - Phi_ * h.cwiseQuotient(eigenvalues());
    return std::sqrt(rest.dot(K_ * rest) / f.dot(u));
  }
};

TEST_F(Ritz, vectors_diagonalise_both_matrices_and_lie_above_the_eigenvalues) {
  for (RitzKind kind : {RitzKind::modal_attachment, RitzKind::krylov, RitzKind::craig_bampton}) {
    reduce(options(kind));
    if (rank() != 0) continue;
    const MatrixXd I = MatrixXd::Identity(Phi_.cols(), Phi_.cols()), Lambda = eigenvalues().asDiagonal();
    EXPECT_LT((Phi_.transpose() * M_ * Phi_ - I).norm(), kSolves);
    EXPECT_LT((Phi_.transpose() * K_ * Phi_ - Lambda).norm(), kSolves * Lambda.norm());
    const VectorXd exact = exact_eigenvalues();
    for (Eigen::Index k = 0; k < Phi_.cols(); ++k)
      EXPECT_GE(body_.K_r.coeff(k, k), (1 - kSolves) * exact(k)) << k;
    EXPECT_EQ(report_.residual.size(), 0);
    EXPECT_LT(report_.orthogonality, kSolves);
  }
}

TEST_F(Ritz, modal_attachment_keeps_the_eigenmodes_and_answers_forces_on_its_nodes_exactly) {
  reduce(options(RitzKind::modal_attachment));
  if (rank() != 0) return;
  EXPECT_EQ(Phi_.cols(), kModes + static_cast<Eigen::Index>(rows_on("xmax").size()));
  const VectorXd exact = exact_eigenvalues().head(kModes);
  EXPECT_LT((eigenvalues().head(kModes) - exact).cwiseQuotient(exact).norm(), kSolves);
  EXPECT_LT(static_error(forces_on("xmax")), kDropped);
  EXPECT_GT(static_error(forces_on("zmax")), kVisible);
}

TEST_F(Ritz, craig_bampton_with_all_interface_modes_answers_forces_there_exactly) {
  reduction::ReductionOptions o = options(RitzKind::craig_bampton);
  o.ritz->interface_modes = 36;
  o.n_modes = 40;
  reduce(o);
  if (rank() != 0) return;
  EXPECT_EQ(Phi_.cols(), 40);
  EXPECT_LT(static_error(forces_on("xmax")), kDropped);
  EXPECT_GT(static_error(forces_on("zmax")), kVisible);
}

// Guyan's condensation: K_bb - K_bi K_ii^-1 K_ib, and M likewise with the constraint modes.
TEST_F(Ritz, interface_modes_are_the_lowest_of_the_condensed_pencil) {
  reduction::ReductionOptions o = options(RitzKind::craig_bampton);
  o.ritz->interface_modes = o.n_modes;
  reduce(o);
  if (rank() != 0) return;
  const std::vector<int> b = rows_on("xmax");
  std::vector<int> i;
  for (int row = 0; row < K_.rows(); ++row)
    if (std::find(b.begin(), b.end(), row) == b.end()) i.push_back(row);
  MatrixXd Psi = MatrixXd::Zero(K_.rows(), static_cast<Eigen::Index>(b.size()));
  Psi(b, Eigen::all).setIdentity();
  Psi(i, Eigen::all) = -MatrixXd(K_(i, i)).llt().solve(MatrixXd(K_(i, b)));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> condensed(Psi.transpose() * K_ * Psi,
                                                                     Psi.transpose() * M_ * Psi);
  const VectorXd lowest = condensed.eigenvalues().head(o.n_modes);
  EXPECT_LT((eigenvalues() - lowest).cwiseQuotient(lowest).norm(), kSolves);
}

TEST_F(Ritz, with_all_columns_is_the_body_itself) {
  reduction::ReductionOptions o = options(RitzKind::craig_bampton);
  o.n_modes = 144;
  reduce(o);
  if (rank() != 0) return;
  ASSERT_EQ(K_.rows(), o.n_modes);
  const VectorXd exact = exact_eigenvalues();
  EXPECT_LT((eigenvalues() - exact).cwiseQuotient(exact).norm(), kSolves);
  EXPECT_LT(static_error(forces_on("zmax")), kDropped);
}

TEST_F(Ritz, bases_do_not_depend_on_the_number_of_ranks) {
  for (RitzKind kind : {RitzKind::modal_attachment, RitzKind::krylov, RitzKind::craig_bampton}) {
    reduce(options(kind));
    if (rank() != 0) continue;
    const VectorXd here = eigenvalues();
    reduction::reduce(PETSC_COMM_SELF, mesh_, options(kind), path_);
    const VectorXd serial = io::read_body(path_).K_r.diagonal();
    ASSERT_EQ(here.size(), serial.size());
    EXPECT_LT((here - serial).cwiseQuotient(serial).norm(), kSolves);
  }
}

class Krylov : public Ritz {
 protected:
  // Columns of the full basis.
  MatrixXd loads() const {
    const reduction::ReductionOptions o = options(RitzKind::krylov);
    model::Surface surface = body_.surface;
    const MatrixXd F = reduction::smooth_loads(surface, o.n_modes);
    MatrixXd B = MatrixXd::Zero(K_.rows(), F.cols());
    for (std::size_t i = 0; i < dof_.size(); ++i)
      for (std::size_t j = 0; j < surface.node.size(); ++j)
        if (surface.node[j] == dof_[i] / 3)
          B.row(static_cast<Eigen::Index>(i)) = F.row(static_cast<Eigen::Index>(3 * j) + dof_[i] % 3);
    return B;
  }
  // Relative deviation of the moment B' (K_s^-1 M)^order K_s^-1 B.
  double moment_error(double hz, int order) const {
    const double sigma = std::pow(2 * M_PI * hz, 2);
    const MatrixXd B = loads(), b = Phi_.transpose() * B;
    const Eigen::PartialPivLU<MatrixXd> factor(K_ - sigma * M_);
    MatrixXd X = factor.solve(B), x = b;
    for (int i = 0; i < order; ++i) X = factor.solve(M_ * X);
    for (int i = 0; i <= order; ++i) x = (eigenvalues().array() - sigma).inverse().matrix().asDiagonal() * x;
    const MatrixXd exact = B.transpose() * X;
    return (b.transpose() * x - exact).norm() / exact.norm();
  }
  // One area, whose five independent loads make blocks of five.
  reduction::ReductionOptions two_blocks() const {
    reduction::ReductionOptions o = options(RitzKind::krylov);
    o.surface = o.loaded = {"xmax"};
    o.n_modes = 10;
    return o;
  }
};

TEST_F(Krylov, matches_twice_as_many_moments_as_it_has_blocks) {
  for (double hz : {0.0, 1000.0}) {
    reduction::ReductionOptions o = two_blocks();
    o.ritz->shift = {hz};
    reduce(o);
    if (rank() != 0) continue;
    EXPECT_EQ(Phi_.cols(), o.n_modes);
    for (int order = 0; order < 4; ++order) EXPECT_LT(moment_error(hz, order), kDropped) << order;
    EXPECT_GT(moment_error(hz + 3000, 0), kDropped);
  }
}

TEST_F(Krylov, matches_the_moments_at_each_of_several_shifts) {
  reduction::ReductionOptions o = two_blocks();
  o.ritz->shift = {0, 1500};
  o.n_modes = 20;
  reduce(o);
  if (rank() != 0) return;
  EXPECT_EQ(Phi_.cols(), o.n_modes);
  for (double hz : o.ritz->shift)
    for (int order = 0; order < 4; ++order) EXPECT_LT(moment_error(hz, order), kDropped) << order;
}

TEST_F(Krylov, ends_where_its_space_ends) {
  reduction::ReductionOptions o = options(RitzKind::krylov);
  o.n_modes = 144;
  reduce(o);
  if (rank() != 0) return;
  EXPECT_LE(Phi_.cols(), o.n_modes);
  const VectorXd exact = exact_eigenvalues().head(kModes);
  EXPECT_LT((eigenvalues().head(kModes) - exact).cwiseQuotient(exact).norm(), kSolves);
}

TEST_F(Ritz, bases_that_cannot_be_are_refused) {
  const auto refused = [&](RitzKind kind, const auto& change) {
    reduction::ReductionOptions o = options(kind);
    change(o);
    EXPECT_THROW(reduce(o), Error);
  };
  refused(RitzKind::modal_attachment, [](auto& o) { o.loaded.clear(); });
  refused(RitzKind::modal_attachment, [](auto& o) { o.loaded = {"xmin"}; });  // restrained
  refused(RitzKind::krylov, [](auto& o) { o.loaded = o.surface = {}; });
  refused(RitzKind::krylov, [](auto& o) { o.ritz->shift = {-1}; });
  refused(RitzKind::krylov, [](auto& o) { o.loaded = {"xmin"}; });
  refused(RitzKind::krylov, [](auto& o) { o.loaded = {"xmax", "ymin"}, o.n_modes = 1; });
  refused(RitzKind::craig_bampton, [](auto& o) { o.ritz->interface_modes = 13; });
  refused(RitzKind::craig_bampton, [](auto& o) { o.ritz->interface_modes = 37, o.n_modes = 60; });
  refused(RitzKind::craig_bampton, [](auto& o) { o.floating = true, o.restrain = {}; });
  refused(RitzKind::craig_bampton, [](auto& o) { o.basis = model::Basis::full; });
}

}  // namespace
}  // namespace elastogear::ritz_test
