// Bodies with viscoelastic materials: the parts of their stiffness, in all bases, and their stress.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../fem/other_cells.h"
#include "../mesh/box_mesh.h"
#include "../message_of.h"
#include "elastogear/fem/relaxing_stiffness.h"
#include "elastogear/io/body_file.h"
#include "elastogear/recovery/stress.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::relaxing_test {
using testing::HasSubstr;

namespace {

constexpr double kRoundoff = 1e-11;
const model::Viscoelastic kTwoTerms{{0.3, 0.5}, {0.2, 0}, {1e-3, 10}};

model::MaterialRegion relaxing_region(const std::string& set, const model::Viscoelastic& series = kTwoTerms) {
  return {set, {3e9, 0.35, 1100, {}, series}};
}

// An elastic material with the long-term moduli.
model::Material long_term(const model::Material& m) {
  double g = 1, k = 1;
  for (double x : m.viscoelastic->g) g -= x;
  for (double x : m.viscoelastic->k) k -= x;
  const double G = g * m.E / (2 * (1 + m.nu)), K = k * m.E / (3 * (1 - 2 * m.nu));
  return {9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G)), m.rho};
}

struct Relaxing : testing::Test {
  mesh::Folder folder{"relaxing"};
  std::string file = folder / "bar.h5";

  static mesh::Mesh bar() {
    mesh::Mesh mesh = test::distorted(test::brick({4, 2, 2}, {1, 0.4, 0.3}), 0.02);
    for (int cell = 0; cell < mesh.cells.size(); ++cell)
      mesh.cell_sets[cell % 4 < 2 ? "left" : "right"].push_back(cell);
    return mesh;
  }
  static reduction::ReductionOptions options(const std::vector<model::MaterialRegion>& regions,
                                             model::Basis basis) {
    reduction::ReductionOptions o;
    o.regions = regions;
    o.restrain = {"xmin:x", "ymin:y", "zmin:z"};
    o.stress_nodes = {"surface"};
    o.basis = basis;
    o.n_modes = basis == model::Basis::full ? 1 : 12;
    return o;
  }
  model::ElasticBody reduce(const std::vector<model::MaterialRegion>& regions, model::Basis basis,
                            model::Element element = model::Element::incompatible) const {
    reduction::ReductionOptions o = options(regions, basis);
    o.element = element;
    reduction::reduce(MPI_COMM_SELF, bar(), o, file);
    return io::read_body(file);
  }
  // Coordinates in the full basis of a stretch e along x of a material with this Poisson's ratio.
  Eigen::VectorXd stretched(double e, double nu) const {
    const io::BodySource source = io::read_body_source(file);
    Eigen::VectorXd q(source.free_dof.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const int dof = source.free_dof[i];
      q[i] = (dof % 3 == 0 ? e : -nu * e) * source.mesh.X(dof % 3, dof / 3);
    }
    return q;
  }
};

TEST_F(Relaxing, parts_of_the_stiffness_sum_to_the_whole) {
  for (model::Element element : {model::Element::incompatible, model::Element::plain, model::Element::bbar}) {
    const model::ElasticBody body = reduce({relaxing_region("")}, model::Basis::full, element);
    ASSERT_EQ(body.relaxing.size(), 2u);
    EXPECT_EQ(body.relaxing[0].part, model::ModulusPart::shear);
    EXPECT_EQ(body.relaxing[1].part, model::ModulusPart::bulk);
    const Eigen::MatrixXd K = body.K_r, parts = body.relaxing[0].K + body.relaxing[1].K;
    EXPECT_LT((parts - K).norm(), kRoundoff * K.norm());
    EXPECT_GT(Eigen::MatrixXd(body.relaxing[1].K).norm(), 0.1 * K.norm());
  }
}

TEST_F(Relaxing, cells_of_every_type_have_parts_that_sum_to_the_whole) {
  const mesh::Mesh hexahedra = test::distorted(test::brick({2, 1, 1}, {1, 0.4, 0.3}), 0.02);
  for (const auto split : {&test::add_wedges, &test::add_tetrahedra}) {
    mesh::Mesh mesh;
    mesh.X = hexahedra.X;
    for (int cell = 0; cell < hexahedra.cells.size(); ++cell) split(mesh, hexahedra.cells[cell]);
    const std::vector<model::MaterialRegion> regions = {relaxing_region("")};
    const std::vector<int> region(static_cast<std::size_t>(mesh.cells.size()), 0);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
    for (const fem::RelaxingModuli& moduli : fem::relaxing_moduli(regions))
      sum += fem::relaxing_stiffness(mesh, regions, region, moduli, model::Element::incompatible);
    const Eigen::MatrixXd K = fem::relaxing_stiffness(
        mesh, regions, region, {0, model::ModulusPart::both, {}, {}}, model::Element::incompatible);
    EXPECT_LT((sum - K).norm(), kRoundoff * K.norm());
  }
}

// The forces of a uniform strain after all has relaxed are those of the long-term moduli, on any mesh.
TEST_F(Relaxing, long_term_stiffness_passes_the_patch_test) {
  const model::MaterialRegion region = relaxing_region("");
  for (model::Element element : {model::Element::incompatible, model::Element::bbar}) {
    const model::ElasticBody body = reduce({region}, model::Basis::full, element);
    const Eigen::VectorXd q = stretched(1e-3, 0.1);
    Eigen::VectorXd force = body.K_r * q;
    for (const model::RelaxingPart& part : body.relaxing) force -= part.g.sum() * (part.K * q);
    const model::ElasticBody relaxed =
        reduce({{"", long_term(region.material)}}, model::Basis::full, element);
    EXPECT_TRUE(relaxed.relaxing.empty());
    EXPECT_LT((force - relaxed.K_r * q).norm(), kRoundoff * force.norm());
  }
}

// sigma = E_inf e along x after all has relaxed, nothing across, when the material contracts with nu_inf.
TEST_F(Relaxing, stress_after_relaxation_is_that_of_the_long_term_moduli) {
  const model::MaterialRegion region = relaxing_region("");
  const model::Material relaxed = long_term(region.material);
  const model::ElasticBody body = reduce({region}, model::Basis::full);
  const Eigen::VectorXd q = stretched(1e-3, relaxed.nu);
  Eigen::VectorXd w(2 * q.size());
  w << body.relaxing[0].g.sum() * q, body.relaxing[1].g.sum() * q;
  const std::vector<int>& members = body.stress.sets.at("surface");
  const Eigen::MatrixXd sigma =
      recovery::modal_stress(body.stress, members, q) - recovery::relaxed_stress(body, members, w);
  for (Eigen::Index i = 0; i < sigma.rows(); ++i)
    EXPECT_NEAR(sigma(i, 0), i % 6 == 0 ? relaxed.E * 1e-3 : 0, 1e-6 * relaxed.E * 1e-3);
}

TEST_F(Relaxing, one_region_with_a_constant_ratio_keeps_the_diagonal) {
  const model::ElasticBody body =
      reduce({relaxing_region("", {{0.3, 0.5}, {0.3, 0.5}, {1e-3, 10}})}, model::Basis::modal);
  ASSERT_EQ(body.relaxing.size(), 1u);
  EXPECT_EQ(body.relaxing[0].part, model::ModulusPart::both);
  EXPECT_EQ((Eigen::MatrixXd(body.relaxing[0].K) - Eigen::MatrixXd(body.K_r)).norm(), 0);
}

// A body of two materials keeps the stiffness of one of them between its modes, and the stress nodes of its
// region.
TEST_F(Relaxing, part_of_a_body_in_modes_is_the_projection_of_the_full_one) {
  const std::vector<model::MaterialRegion> regions = {relaxing_region("left"), {"right", test::kSteel}};
  const model::ElasticBody modal = reduce(regions, model::Basis::modal);
  Eigen::MatrixXd Phi;
  const std::vector<int> free_dof = io::read_body_source(file).free_dof;
  Phi.resize(static_cast<Eigen::Index>(free_dof.size()), modal.n_q());
  for (Eigen::Index k = 0; k < modal.n_q(); ++k) {
    const Eigen::Matrix3Xd field = io::read_displacement_field(file, Eigen::VectorXd::Unit(modal.n_q(), k));
    Phi.col(k) = field.reshaped()(free_dof);
  }
  const model::ElasticBody full = reduce(regions, model::Basis::full);
  ASSERT_EQ(modal.relaxing.size(), full.relaxing.size());
  for (std::size_t p = 0; p < full.relaxing.size(); ++p) {
    const Eigen::MatrixXd K = Phi.transpose() * full.relaxing[p].K * Phi;
    EXPECT_LT((Eigen::MatrixXd(modal.relaxing[p].K) - K).norm(), kRoundoff * K.norm());
    EXPECT_EQ(modal.relaxing[p].stress_node, full.relaxing[p].stress_node);
    EXPECT_EQ(modal.relaxing[p].cell_set, "left");
  }
  const Eigen::Matrix3Xd& X = full.stress.X;
  std::vector<int> in_left;
  for (int e = 0; e < X.cols(); ++e)
    if (X(0, e) < 0.6) in_left.push_back(e);
  EXPECT_EQ(full.relaxing[0].stress_node, in_left);
}

std::string refusal(const reduction::ReductionOptions& o, const std::string& file) {
  return test::message_of([&] { reduction::reduce(MPI_COMM_SELF, Relaxing::bar(), o, file); });
}

TEST_F(Relaxing, refuses_series_that_do_not_fit) {
  reduction::ReductionOptions o =
      options({relaxing_region("", {{0.7, 0.5}, {0, 0}, {1, 2}})}, model::Basis::modal);
  EXPECT_THAT(refusal(o, file), HasSubstr("sum to 1.2"));
  o = options({{"", test::kFibre}}, model::Basis::full);
  o.regions[0].material.viscoelastic = kTwoTerms;
  EXPECT_THAT(refusal(o, file), HasSubstr("orthotropic material relax alike"));
  o.regions[0].material.viscoelastic = model::Viscoelastic{{0.5}, {0.5}, {1}};
  EXPECT_EQ(refusal(o, file), "no error");
}

}  // namespace
}  // namespace elastogear::relaxing_test
