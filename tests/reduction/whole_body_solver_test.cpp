// Displacements of cyclically symmetric bodies by the factors of their harmonics against those by one factor.

#include "reduction/static_response/whole_body_solver.h"

#include <gtest/gtest.h>

#include "../fem/other_cells.h"
#include "../mesh/disc.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/restraint.h"

namespace elastogear::whole_body_solver_test {
namespace {

constexpr double kRoundoff = 1e-9;  // of two factorisations, relative

io::BodySource held_at_the_bottom(const mesh::Mesh& mesh, const std::string& bottom) {
  io::BodySource source;
  source.mesh = mesh;
  source.regions = test::kSteelBody;
  source.free_dof = fem::free_dofs(fem::held_directions(mesh, {bottom}));
  return source;
}

mesh::Repetition repetition_of(const io::BodySource& source) {
  const std::vector<int> region = fem::cell_regions(source.mesh, source.regions);
  const std::vector<bool> is_free =
      fem::free_nodes(fem::held_directions(source.free_dof, source.mesh.n_nodes()));
  return mesh::find_repetition(source.mesh, {region, is_free}).found.value();
}

Eigen::MatrixXd sum_of_parts(reduction::WholeBodySolver& solver, const Eigen::MatrixXd& f) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(f.rows(), f.cols());
  solver.visit_parts([&](const reduction::Solve& part) { u += part(f); });
  return u;
}

// Under forces on all nodes that no turn leaves alike, and on one node.
void expect_that_of_one_factor(const io::BodySource& source, int n_sectors) {
  const mesh::Repetition repetition = repetition_of(source);
  ASSERT_EQ(repetition.turn.n_sectors, n_sectors);
  Eigen::MatrixXd f = Eigen::MatrixXd::Random(3 * source.mesh.n_nodes(), 2);
  f.col(1).setZero();
  f.col(1).segment<3>(3 * (source.free_dof.back() / 3)) << 1, -2, 3;
  const Eigen::MatrixXd expected = sum_of_parts(*reduction::factorise_whole(source, false), f),
                        found = sum_of_parts(*reduction::factorise_harmonics(source, repetition), f);
  for (Eigen::Index j = 0; j < 2; ++j) {
    ASSERT_GT(expected.col(j).norm(), 0) << "a comparison that says nothing";
    EXPECT_LT((found.col(j) - expected.col(j)).norm(), kRoundoff * expected.col(j).norm()) << j;
  }
  EXPECT_EQ((found.array() != 0).count(), (expected.array() != 0).count()) << "restrained nodes move";
}

// Large sectors are condensed to their border, others have a factor for each harmonic.
TEST(HarmonicFactors, of_discs_give_the_displacements_of_one_factor) {
  for (int Z : {2, 3, 4, 5, 6}) {
    SCOPED_TRACE(Z);
    expect_that_of_one_factor(held_at_the_bottom(test::shuffled(test::disc({Z, 2, 2, 2})), "bottom"), Z);
    expect_that_of_one_factor(held_at_the_bottom(test::disc({Z, 10, 3, 2}), "bottom"), Z);
  }
}

TEST(HarmonicFactors, of_a_prism_of_20_node_hexahedra_give_the_displacements_of_one_factor) {
  const mesh::Mesh prism = test::cells_of(mesh::CellType::hex20, test::brick({2, 2, 3}, {1, 1, 2}));
  expect_that_of_one_factor(held_at_the_bottom(prism, "zmin"), 4);
}

}  // namespace
}  // namespace elastogear::whole_body_solver_test
