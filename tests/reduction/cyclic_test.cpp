#include "cyclic_body.h"

#include "../mesh/disc.h"

namespace {

using namespace elastogear;
using namespace elastogear::test;

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

}  // namespace
