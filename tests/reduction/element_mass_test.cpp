// Bodies whose mass has the incompatible modes of their hexahedra: all that the file holds of mass agrees.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "../fem/brick.h"
#include "../mesh/disc.h"
#include "../message_of.h"
#include "elastogear/base/petsc.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"
#include "full_basis.h"

namespace elastogear::element_mass_test {
namespace {

using model::ElementMass;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double kRoundoff = 1e-12;
constexpr double kEigensolver = 1e-9;

int rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

// A file of this test, another one for each number of ranks.
std::string output_path(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return fs::temp_directory_path() / ("element_mass_" + name + std::to_string(size) + ".h5");
}

mesh::Mesh bar() {
  auto mesh = test::distorted(test::brick({5, 3, 2}, {1, 0.4, 0.2}), 0.02);
  mesh.cell_sets["rim"] = {4, 9, 14};
  return mesh;
}

reduction::ReductionOptions bar_options() {
  reduction::ReductionOptions o;
  o.name = "bar";
  o.regions = {{"", test::kSteel}, {"rim", test::kFibre}};
  o.element_mass = ElementMass::condensed;
  o.restrain = {"xmin"};
  o.n_modes = 12;
  o.window = reduction::kAutomaticWindow;
  o.invariants = reduction::Invariants::full;
  return o;
}

reduction::ReductionReport run(const mesh::Mesh& mesh, const reduction::ReductionOptions& o,
                               const std::string& output) {
  return reduction::reduce(PETSC_COMM_WORLD, rank() == 0 ? mesh : mesh::Mesh(), o, output);
}

Eigen::MatrixXd trace(const model::ElasticBody& body) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(body.n_q(), body.n_q());
  for (int i = 0; i < 3; ++i)
    model::with_rows(body.inertia.S_2[i], [&](const auto& S) { sum += Eigen::MatrixXd(S); });
  return sum;
}

TEST(ElementMass, is_the_same_in_all_that_both_bases_hold_of_it) {
  auto o = bar_options();
  o.point_mass = {{"xmax", 3}};
  const std::string modal = output_path("modal"), full = output_path("full");
  run(bar(), o, modal);
  o.basis = model::Basis::full;
  run(bar(), o, full);
  if (rank() != 0) return;
  const auto a = io::read_body(full), b = io::read_body(modal);
  EXPECT_EQ(io::read_body_source(modal).element_mass, ElementMass::condensed);
  const Eigen::MatrixXd Phi = test::modes_in_full_basis(modal, full);
  EXPECT_LT((Phi.transpose() * a.M_r * Phi - b.M_r.toDense()).norm(), kEigensolver);
  EXPECT_LT((Phi.transpose() * a.inertia.C_l - b.inertia.C_l).norm(), kRoundoff * b.inertia.C_l.norm());
  EXPECT_LT((Phi.transpose() * a.inertia.C_r - b.inertia.C_r).norm(), kRoundoff * b.inertia.C_r.norm());
  EXPECT_LT((a.inertia.S_1 * Phi - b.inertia.S_1).norm(), kRoundoff * b.inertia.S_1.norm());
  for (int i = 0; i < 6; ++i) {
    const Eigen::MatrixXd S = std::get<model::SparseRows>(a.inertia.S_2[i]),
                          S_r = std::get<model::DenseRows>(b.inertia.S_2[i]);
    EXPECT_LT((Phi.transpose() * S * Phi - S_r).norm(), kRoundoff * S_r.norm()) << i;
  }
  EXPECT_LT((trace(a) - a.M_r.toDense()).norm(), kRoundoff * trace(a).norm());
  EXPECT_LT((trace(b) - b.M_r.toDense()).norm(), kEigensolver);
}

// Coarse cells that move along chords have too little kinetic energy at antinodes: their frequencies are
// higher.
TEST(ElementMass, leaves_mass_and_inertia_and_changes_frequencies) {
  auto o = bar_options();
  const auto condensed = run(bar(), o, output_path("condensed"));
  o.element_mass = ElementMass::compatible;
  const auto nodal = run(bar(), o, output_path("nodal"));
  if (rank() != 0) return;
  EXPECT_NEAR(condensed.m, nodal.m, kRoundoff * nodal.m);
  EXPECT_LT((condensed.c - nodal.c).norm(), kRoundoff);
  EXPECT_LT((condensed.J - nodal.J).norm(), kRoundoff * nodal.J.norm());
  EXPECT_LT(condensed.frequency.sum(), 0.99 * nodal.frequency.sum());
  EXPECT_EQ(io::read_body_source(output_path("nodal")).element_mass, ElementMass::compatible);
}

TEST(ElementMass, does_not_depend_on_the_number_of_ranks) {
  const std::string output = output_path("ranks"), serial = output + ".serial";
  run(bar(), bar_options(), output);
  if (rank() != 0) return;
  reduction::reduce(PETSC_COMM_SELF, bar(), bar_options(), serial);
  const auto a = io::read_body(output), b = io::read_body(serial);
  EXPECT_LT((a.frequency - b.frequency).cwiseQuotient(b.frequency).norm(), kEigensolver);
  EXPECT_LT((a.inertia.C_r - b.inertia.C_r).norm(), 1e-6 * b.inertia.C_r.norm());
}

// The modes of sectors are put back into the element matrices of the whole mesh, whose mass is the same.
TEST(ElementMass, is_the_same_in_one_sector_as_in_the_whole_body) {
  const auto mesh = test::disc({5, 1, 3, 2});
  auto o = bar_options();
  model::Material wound = test::kFibre;
  wound.orthotropic->orientation = {.system = model::Orientation::System::cylindrical};
  for (const model::Material& material : {test::kSteel, wound}) {
    o.regions = {{"", material}};
    o.restrain = {"bottom"};
    o.symmetry = reduction::Symmetry::automatic;
    const std::string sector = output_path("sector"), whole = output_path("whole");
    const auto with = run(mesh, o, sector);
    o.symmetry = reduction::Symmetry::none;
    run(mesh, o, whole);
    if (rank() != 0) continue;
    EXPECT_EQ(with.symmetry.find("5 sectors"), 0U) << with.symmetry;
    const auto a = io::read_body(sector), b = io::read_body(whole);
    EXPECT_LT((a.frequency - b.frequency).cwiseQuotient(b.frequency).norm(), kEigensolver);
    const Eigen::Matrix3d C_a = a.inertia.C_r.transpose() * a.inertia.C_r,
                          C_b = b.inertia.C_r.transpose() * b.inertia.C_r;
    EXPECT_LT((C_a - C_b).norm(), kEigensolver * C_b.norm());
    EXPECT_LT((trace(a) - a.M_r.toDense()).norm(), kEigensolver);
  }
}

// A free body neither moves its centre of mass nor turns when it vibrates: modes and couplings have one mass.
TEST(ElementMass, lets_free_modes_neither_move_nor_turn_the_body) {
  auto o = bar_options();
  o.restrain.clear();
  o.floating = o.frame_at_center = true;
  run(bar(), o, output_path("free"));
  if (rank() != 0) return;
  const auto body = io::read_body(output_path("free"));
  EXPECT_LT(body.inertia.C_l.norm(), 1e-7 * std::sqrt(body.inertia.m));
  EXPECT_LT(body.inertia.C_r.norm(), 1e-7 * std::sqrt(body.inertia.J.norm()));
}

TEST(ElementMass, condensed_is_refused_where_no_modes_are_condensed) {
  const std::string output = output_path("refused");
  auto o = bar_options();
  o.element = model::Element::bbar;
  EXPECT_THAT(test::message_of([&] { run(bar(), o, output); }), HasSubstr("-element incompatible"));
  o.element = model::Element::incompatible;
  o.imported = reduction::ImportedFiles{.stiffness = "k.mtx", .mass = "m.mtx"};
  EXPECT_THAT(test::message_of([&] { run(bar(), o, output); }), HasSubstr("m.mtx"));
}

}  // namespace
}  // namespace elastogear::element_mass_test
