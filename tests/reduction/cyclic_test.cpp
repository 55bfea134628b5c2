#include "cyclic_body.h"

#include <gmock/gmock.h>

#include "../mesh/disc.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "reduction/cyclic/condensed_sector.h"
#include "reduction/cyclic/cyclic_masses.h"
#include "reduction/cyclic/harmonic_krylov.h"
#include "reduction/modes/cutoff.h"

namespace elastogear::cyclic_test {
namespace {

using namespace test;

Body even_disc() { return {shuffled(disc({6, 2, 3, 2})), {"bottom"}, kSteelBody, 6}; }

TEST(Cyclic, modes_of_an_even_disc_are_those_of_the_whole) {
  expect_equals_the_general_path(even_disc(), 60);
}

TEST(Cyclic, modes_of_discs_with_few_sectors_are_those_of_the_whole) {
  for (int Z : {2, 3, 4, 5}) {
    SCOPED_TRACE(Z);
    expect_equals_the_general_path({disc({Z, 3, 2, 2}), {"bottom"}, kSteelBody, Z}, 30);
  }
}

// Sectors of many cells, which are condensed to their border.
TEST(Cyclic, modes_of_discs_with_large_sectors_are_those_of_the_whole) {
  for (int Z : {3, 4}) {
    SCOPED_TRACE(Z);
    expect_equals_the_general_path({shuffled(disc({Z, 10, 3, 2})), {"bottom"}, kSteelBody, Z}, 60);
  }
}

// A body whose harmonics are solved together unless SLEPc's options are given.
TEST(Cyclic, obeys_the_options_of_the_eigensolver) {
  const Body body{disc({4, 10, 3, 2}), {"bottom"}, kSteelBody, 4};
  reduction::CyclicOptions options;
  options.eigen.window = reduction::kAutomaticWindow;
  const Solution together = solve_cyclic(PETSC_COMM_SELF, body, 20, options);
  options.eigen.prefix = "loose_";
  check(PetscOptionsInsertString(nullptr, "-loose_eps_tol 1e-2 -loose_eps_monitor -loose_eps_view"));
  testing::internal::CaptureStdout();
  const Solution loose = solve_cyclic(PETSC_COMM_SELF, body, 20, options);
  const std::string printed = testing::internal::GetCapturedStdout();
  for (const char* name : {"-loose_eps_tol", "-loose_eps_monitor", "-loose_eps_view"})
    check(PetscOptionsClearValue(nullptr, name));
  EXPECT_THAT(printed, testing::HasSubstr("tolerance: 0.01"));
  EXPECT_THAT(printed, testing::HasSubstr("first unconverged value"));
  EXPECT_LT((loose.modes.eigenvalue.cwiseQuotient(together.modes.eigenvalue).array() - 1).abs().maxCoeff(),
            1e-2);
  EXPECT_GT(loose.modes.residual.maxCoeff(), 1e-5);  // as much as the mesh may add to it
}

// A sector of many cells.
struct LargeSector {
  Body body{disc({4, 10, 3, 2}), {"bottom"}, kSteelBody, 4};
  model::Formulation formulation{model::Element::incompatible};
  fem::Sector sector = make();

  fem::Matrices matrices(const fem::Harmonic& harmonic) const {
    return fem::assemble(PETSC_COMM_SELF, sector, harmonic, body.regions, formulation);
  }

 private:
  fem::Sector make() const {
    const std::vector<int> region = fem::cell_regions(body.mesh, body.regions);
    const std::vector<bool> is_free = fem::free_nodes(body.mesh, body.restrained);
    const mesh::Repetition repetition = *mesh::find_repetition(body.mesh, {region, is_free}).found;
    return fem::make_sector(body.mesh, repetition, region, fem::free_node_orbits(repetition, is_free));
  }
};

TEST(CondensedSector, counts_and_solves_as_each_harmonic_by_itself) {
  const LargeSector large;
  ASSERT_TRUE(reduction::condensing_pays(large.sector));
  reduction::CondensedSector condensed(large.sector, large.body.regions, large.formulation);
  for (int k = 0; k <= 2; ++k) {
    SCOPED_TRACE(k);
    const fem::Harmonic harmonic = fem::make_harmonic(large.sector, k);
    const fem::Matrices matrices = large.matrices(harmonic);
    reduction::HarmonicFactor factor(condensed, harmonic);
    reduction::ShiftedFactor whole(matrices.K, matrices.M);
    for (double sigma : {0.0, 3e8, 2e9}) {
      const int below = whole.factorise(sigma);
      EXPECT_EQ(factor.factorise(sigma), below) << sigma;
      EXPECT_EQ(below > 0, sigma > 0) << "a count that says nothing";
      MatrixXd expected = MatrixXd::Random(harmonic.size(), 3), found = expected;
      whole.solve(expected);
      factor.solve(found);
      EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << sigma;
    }
  }
}

class Together : public testing::Test {
 protected:
  static constexpr double kCutoff = 2e9;  // rad^2/s^2

  std::vector<reduction::HarmonicTask> tasks(int more) {
    std::vector<reduction::HarmonicTask> tasks;
    for (const fem::Harmonic& harmonic : harmonics) {
      const int below = reduction::HarmonicFactor(condensed, harmonic).factorise(kCutoff);
      tasks.push_back({&harmonic, (harmonic.real ? below : below / 2) + more});
    }
    return tasks;
  }

  LargeSector large;
  reduction::CondensedSector condensed{large.sector, large.body.regions, large.formulation};
  std::vector<fem::Harmonic> harmonics{fem::make_harmonic(large.sector, 0),
                                       fem::make_harmonic(large.sector, 1),
                                       fem::make_harmonic(large.sector, 2)};
};

TEST_F(Together, harmonics_have_the_modes_of_each_by_itself) {
  const auto all = reduction::find_modes_together(condensed, tasks(0), {.cutoff = kCutoff});
  ASSERT_EQ(all.size(), harmonics.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    ASSERT_TRUE(all[k]);
    const reduction::HarmonicModes& found = *all[k];
    ASSERT_GT(found.eigenvalue.size(), 1) << "a comparison that says nothing";
    const int parts = harmonics[k].real ? 1 : 2;
    reduction::EigenOptions options;
    options.n_modes = parts * static_cast<int>(found.eigenvalue.size());
    const reduction::HarmonicModes expected =
        reduction::find_harmonic_modes(large.matrices(harmonics[k]), harmonics[k], 0, options);
    EXPECT_LT((found.eigenvalue.cwiseQuotient(expected.eigenvalue).array() - 1).abs().maxCoeff(), 1e-9);
    EXPECT_LT((found.z - expected.z).norm(), 1e-6 * expected.z.norm());
    EXPECT_LT(found.residual.maxCoeff(), 1e-8);
    EXPECT_LT(found.orthogonality, 1e-10);
    EXPECT_EQ(found.cutoff, kCutoff);
  }
}

TEST_F(Together, a_harmonic_without_as_many_modes_has_none) {
  for (const auto& found : reduction::find_modes_together(condensed, tasks(1), {.cutoff = kCutoff}))
    EXPECT_FALSE(found);
}

TEST(Cyclic, modes_of_a_small_body_can_be_all_it_has) {
  const Body body{disc({3, 1, 1, 1}), {"bottom"}, kSteelBody, 3};
  expect_equals_the_general_path(body, 12);
}

TEST(Cyclic, modes_of_a_prism_with_cells_around_the_axis_are_those_of_the_whole) {
  Body body{brick({3, 3, 4}, {1, 1, 2}), {"zmin"}, {{"", kSteel}, {"core", {3e9, 0.35, 1200}}}, 4};
  body.mesh.cell_sets["core"] = {4, 13};
  expect_equals_the_general_path(body, 40);
}

TEST(Cyclic, modes_of_a_wound_disc_are_those_of_the_whole) {
  model::Material wound = kFibre;
  wound.orthotropic->orientation = {.system = model::Orientation::System::cylindrical,
                                    .rotation = {0.5, 0, 0}};
  expect_equals_the_general_path({disc({5, 2, 2, 2}), {"bottom"}, {{"", wound}}, 5}, 30);
}

TEST(Cyclic, modes_do_not_depend_on_the_number_of_ranks) {
  const Body body = even_disc();
  const Solution many = solve_cyclic(PETSC_COMM_WORLD, body, 33);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const Solution one = solve_cyclic(PETSC_COMM_SELF, body, 33);
  for (int i = 0; i < 33; ++i) {
    EXPECT_NEAR(many.modes.eigenvalue(i) / one.modes.eigenvalue(i), 1, kFrequency);
    EXPECT_LT((many.phi.col(i) - one.phi.col(i)).norm(), 1e-6 * one.phi.col(i).norm()) << i;
  }
}

// The axis is oblique to the coordinates, so that all directions have parts of both harmonics.
TEST(Cyclic, mobile_masses_are_those_of_the_whole) {
  for (int Z : {2, 3, 6}) {
    SCOPED_TRACE(Z);
    Body body{disc({Z, 2, 3, 2}), {"bottom"}, kSteelBody, Z};
    body.mesh.X = rotation_matrix({0.3, -0.5, 0.2}) * body.mesh.X;
    const std::vector<int> region = fem::cell_regions(body.mesh, body.regions);
    const std::vector<bool> is_free = fem::free_nodes(body.mesh, body.restrained);
    const mesh::Repetition repetition = *mesh::find_repetition(body.mesh, {region, is_free}).found;
    ASSERT_EQ(repetition.turn.n_sectors, Z);
    const fem::MassMoments moments = fem::mass_moments(body.mesh, body.regions);
    const Eigen::Vector3d c = fem::rigid_inertia(body.mesh, moments).c;
    const System system = assemble(body.mesh, body.restrained, PETSC_COMM_WORLD, body.regions);
    UniqueVec layout;
    check(MatCreateVecs(system.matrices.M, layout.out(), nullptr));
    const fem::VectorGather gather(layout, system.rows);
    const reduction::SixDirections whole = reduction::mobile_masses(system.matrices.M, gather, moments, c);
    const reduction::SixDirections sectors = reduction::cyclic_mobile_masses(
        PETSC_COMM_WORLD, {body.mesh, body.regions, region, is_free, {}}, repetition, moments, c);
    EXPECT_LT((sectors.cwiseQuotient(whole).array() - 1).abs().maxCoeff(), 1e-9);
  }
}

TEST(Cyclic, harmonics_that_are_known_are_not_solved_again) {
  std::map<int, reduction::HarmonicModes> kept;
  reduction::CyclicOptions options;
  options.done = [&](const reduction::HarmonicModes& modes) { kept[modes.k] = modes; };
  const Solution first = solve_cyclic(PETSC_COMM_WORLD, even_disc(), 20, options);
  const auto n_kept = kept.size();
  options.known = [&](int k, double cutoff) -> std::optional<reduction::HarmonicModes> {
    if (!kept.contains(k)) return std::nullopt;
    EXPECT_EQ(kept.at(k).cutoff, cutoff);
    return kept.at(k);
  };
  options.done = [&](const reduction::HarmonicModes&) { ADD_FAILURE() << "solved again"; };
  const Solution second = solve_cyclic(PETSC_COMM_WORLD, even_disc(), 20, options);
  EXPECT_EQ(first.modes.eigenvalue, second.modes.eigenvalue);
  EXPECT_EQ(first.phi, second.phi);
  if (rank_of(PETSC_COMM_WORLD) == 0) {
    EXPECT_GT(n_kept, 0U);
  }
}

TEST(Cyclic, modes_of_a_body_that_can_turn_are_an_error_on_all_ranks) {
  Body body{disc({3, 2, 2, 2}), {"axis"}, kSteelBody, 3};
  for (int node = 0; node < body.mesh.n_nodes(); ++node)
    if (body.mesh.X.col(node).head<2>().norm() == 0) body.mesh.node_sets["axis"].push_back(node);
  std::string message;
  try {
    solve_cyclic(PETSC_COMM_WORLD, body, 5);
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

// Eigenvalues 1, 2, 3, ..., the tenth of them hundredfold.
int count_with_a_cluster(double sigma) {
  const int below = static_cast<int>(std::ceil(sigma)) - 1;
  return std::max(0, below) + (below >= 10 ? 99 : 0);
}

TEST(Cutoff, has_a_wanted_number_of_eigenvalues_below) {
  for (int n : {1, 5, 200, 5000})
    for (double start : {1e-3, 3.0, 1e6}) {
      const double sigma = reduction::find_cutoff(count_with_a_cluster, {n, n + n / 20}, start);
      EXPECT_GE(count_with_a_cluster(sigma), n) << start;
      EXPECT_LE(count_with_a_cluster(sigma), n + n / 20) << start;
    }
}

TEST(Cutoff, takes_more_where_eigenvalues_are_equal) {
  const double sigma = reduction::find_cutoff(count_with_a_cluster, {50, 55}, 2);
  EXPECT_EQ(count_with_a_cluster(sigma), 109);
}

}  // namespace
}  // namespace elastogear::cyclic_test
