// Stresses of a bar at rest under contact forces, recovered from its result by the library, against those of
// the full basis.

#include "elastogear/recovery/recover.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

#include "../fem/brick.h"
#include "../mesh/box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/load_spread.h"
#include "elastogear/fem/stress.h"
#include "elastogear/mesh/surface_patches.h"
#include "elastogear/model/fingerprint.h"
#include "elastogear/recovery/contact_field.h"
#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"
#include "elastogear/reduction/reduce.h"
#include "elastogear/reduction/static_response.h"
#include "elastogear/reduction/stressed_body.h"
#include "recovery/error_estimate.h"

namespace elastogear::recovery::recover_test {
namespace {

constexpr double kRoundoff = 1e-9;         // of factorisations, relative
constexpr double kSinglePrecision = 1e-6;  // of stored static responses, relative
constexpr double kForces = 1e-3;           // of a stress: what the estimate adds for contact forces, (4.9)
constexpr int kModes = 8;

FiniteElements finite_elements() {
  return {[](const io::BodySource& source, bool floating) {
            const auto factor = std::make_shared<reduction::StaticResponse>(source, floating);
            return UnreducedResponse{
                [factor](const auto& loaded, const auto& f) { return factor->displacement(loaded, f); },
                [factor](const auto& loaded, const auto& nodes) { return factor->stress(loaded, nodes); }};
          },
          {},
          {},
          [](const io::BodySource& source, const auto& loaded, const auto& nodes) {
            fem::StressedBody body = reduction::stressed_body(source);
            body.recovery.loaded = loaded;
            return fem::recovery_difference(std::move(body), nodes);
          },
          [](const io::BodySource& source, const auto& loaded, const auto& nodes) {
            fem::StressedBody body = reduction::stressed_body(source);
            body.recovery.loaded = loaded;
            return fem::difference_within_surface(std::move(body), nodes);
          },
          [](const io::BodySource& source, const auto& nodes) {
            return fem::stress_operator(reduction::stressed_body(source), nodes);
          },
          [](const io::BodySource& source, const auto& nodes) {
            return SurfacePatches{mesh::surface_patches(source.mesh, nodes),
                                  mesh::cell_orders(source.mesh, nodes)};
          }};
}

struct Recover : testing::Test {
  mesh::Folder folder{"recover"};
  std::string file = folder / "bar.h5", result = folder / "result.h5";
  Eigen::MatrixXd exact;  // 6 n x 1, Pa, at the set xmax
  reduction::RecoveryChoice stress_recovery = reduction::RecoveryChoice::automatic;
  int n_modes = kModes;

  model::ElasticBody reduce(model::Basis basis, bool with_responses = false) const {
    reduction::ReductionOptions o;
    o.regions = {{"", test::kSteel}};
    o.restrain = {"xmin"};
    o.surface = {"zmax"};
    o.stress_nodes = {"ymax", "zmax", "beside"};
    o.basis = basis;
    o.n_modes = basis == model::Basis::full ? 1 : n_modes;
    o.flexibility = with_responses;
    o.stress_recovery = stress_recovery;
    reduction::reduce(MPI_COMM_SELF, bar(), o, file);
    return io::read_body(file);
  }
  // With the set `beside`, the loaded one and the nodes that share a face with it.
  static mesh::Mesh bar() {
    mesh::Mesh bar = test::distorted(test::brick({4, 2, 2}, {1, 0.4, 0.3}), 0.02);
    std::vector<int>& beside = bar.node_sets["beside"];
    for (const std::vector<int>& around : mesh::surface_patches(bar, bar.node_sets.at("zmax")))
      beside.insert(beside.end(), around.begin(), around.end());
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    return bar;
  }
  // Coordinates at rest under the forces that the result of write() holds.
  static Eigen::VectorXd at_rest(const model::ElasticBody& body) {
    Eigen::VectorXd h = Eigen::VectorXd::Zero(body.n_q());
    for (std::size_t i = 0; i < forces(body).node.size(); ++i)
      model::add_force(body.surface.Phi, forces(body).node[i],
                       forces(body).f_B.col(static_cast<Eigen::Index>(i)), h);
    if (h.size() == 0) return h;
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(body.K_r).solve(h);
  }
  static model::ContactForces forces(const model::ElasticBody& body) {
    const int last = static_cast<int>(body.surface.node.size()) - 1;
    Eigen::Matrix3Xd f(3, 2);
    f << 100, 0, -300, 50, -200, -400;
    return {{last / 2, last}, f};
  }
  // share: of the forces at each time; the body is at rest where it is 1.
  BodyOfRun write(const model::ElasticBody& body, const std::vector<double>& share = {1}) const {
    const auto n_q = body.n_q();
    model::BodyState state;
    state.r_WB = Eigen::Vector3d(1, 2, 3);
    state.R_WB.setIdentity();
    state.q_dot = state.q_ddot = Eigen::VectorXd::Zero(n_q);
    state.contact = forces(body);
    const Eigen::VectorXd q = at_rest(body);
    const Eigen::Matrix3Xd f = state.contact.f_B;
    model::ResultHeader header;
    header.bodies = {{"bar", file, "fixed"}};
    header.provenance[model::identity_key("bar")] = model::fingerprint(body);
    io::ResultWriter writer(result, header);
    for (std::size_t t = 0; t < share.size(); ++t) {
      state.q = share[t] * q + (share[t] - 1) * q.reverse();
      state.contact.f_B = share[t] * f;
      writer.append({.time = static_cast<double>(t), .bodies = {state}, .pairs = {}, .energy = {}});
    }
    writer.finish();
    return read_bodies_of_run(result).front();
  }
  void SetUp() override {
    const model::ElasticBody body = reduce(model::Basis::full);
    exact = modal_stress(body.stress, body.stress.sets.at("ymax"), at_rest(body));
  }
};

TEST_F(Recover, with_mode_acceleration_gives_the_stress_of_the_full_basis) {
  for (bool stored : {false, true}) {
    const model::ElasticBody body = reduce(model::Basis::modal, stored);
    RecoveredBody recovered = prepare_recovery(
        write(body), stored ? Acceleration::automatic : Acceleration::always, true, finite_elements());
    const io::StressSet set = recover_stress(recovered, body, "ymax", true);
    EXPECT_LT((set.stress - exact).norm(), (stored ? kSinglePrecision : kRoundoff) * exact.norm());
    EXPECT_LT((set.error - kForces * set.von_mises).norm(), kRoundoff * set.von_mises.norm());
  }
}

// More times and nodes than are recovered together; forces come and go. With responses from the file nodes
// may be named repeatedly; a factor of K takes each once.
TEST_F(Recover, gives_each_time_and_node_what_it_has_alone) {
  constexpr int kTimes = 300;
  std::vector<double> share(kTimes);
  for (int t = 0; t < kTimes; ++t) share[static_cast<std::size_t>(t)] = t % 150 < 100 ? std::sin(0.1 * t) : 0;
  for (bool stored : {false, true}) {
    const int repeated = stored ? 40 : 1;
    model::ElasticBody body = reduce(model::Basis::modal, stored);
    const std::vector<int> members = body.stress.sets.at("ymax");
    for (int i = 0; i < repeated; ++i)
      body.stress.sets["many"].insert(body.stress.sets["many"].end(), members.begin(), members.end());
    const auto recover = [&](const std::vector<double>& shares, const std::string& set) {
      RecoveredBody recovered =
          prepare_recovery(write(body, shares), Acceleration::automatic, true, finite_elements());
      return recover_stress(recovered, body, set, true);
    };
    const io::StressSet all = recover(share, "many");
    ASSERT_GT(all.von_mises.rows(), stored ? 512 : 10);
    for (int t : {0, 1, 99, 127, 128, 200, 255, 256, 299}) {
      const io::StressSet alone = recover({share[static_cast<std::size_t>(t)]}, "ymax");
      const auto expect_same = [&](const Eigen::MatrixXd& of_all, const Eigen::MatrixXd& of_one) {
        ASSERT_EQ(of_all.rows(), repeated * of_one.rows());
        EXPECT_LT((of_all.col(t) - of_one.replicate(repeated, 1)).norm(),
                  1e-11 * of_all.col(t).norm() + 1e-6);
      };
      expect_same(all.stress, alone.stress);
      expect_same(all.von_mises, alone.von_mises);
      expect_same(all.rankine, alone.rankine);
      expect_same(all.error, alone.error);
      ASSERT_EQ(all.contact_error.size() > 0, stored);
      if (stored) expect_same(all.contact_error, alone.contact_error);
      EXPECT_NEAR(all.peak_error[t], alone.peak_error[0], 1e-11 * alone.peak_error[0]);
    }
    EXPECT_GT(all.stress.col(200).norm(), 1e-3 * all.stress.col(10).norm());
  }
}

TEST_F(Recover, at_rest_estimates_the_true_error_of_the_modes) {
  const model::ElasticBody body = reduce(model::Basis::modal);
  RecoveredBody recovered = prepare_recovery(write(body), Acceleration::automatic, true, finite_elements());
  EXPECT_FALSE(recovered.response);
  const io::StressSet set = recover_stress(recovered, body, "ymax", true);
  const Eigen::MatrixXd true_error = (set.von_mises - von_mises(exact)).cwiseAbs();
  ASSERT_GT(true_error.maxCoeff(), 0.05 * set.von_mises.maxCoeff());
  EXPECT_LT((set.error - kForces * set.von_mises - true_error).norm(), kRoundoff * set.von_mises.norm());
}

TEST_F(Recover, of_the_full_basis_errs_by_nothing) {
  const model::ElasticBody body = reduce(model::Basis::full);
  RecoveredBody recovered = prepare_recovery(write(body), Acceleration::always, true, finite_elements());
  const io::StressSet set = recover_stress(recovered, body, "ymax", true);
  EXPECT_LT((set.stress - exact).norm(), kRoundoff * exact.norm());
  EXPECT_EQ(set.error.norm(), 0);
}

// Both recoveries of a body with the full basis at rest: von Mises stresses at all nodes, Pa.
struct BothRecoveries {
  Eigen::VectorXd difference, recovered;
};
BothRecoveries both_recoveries(const io::BodySource& source, const std::vector<int>& loaded,
                               const Eigen::VectorXd& u) {
  fem::StressedBody body = reduction::stressed_body(source);
  body.recovery.method = model::RecoveryMethod::average;
  const Eigen::MatrixXd mean = fem::nodal_stress(body, u);
  body.recovery = {model::RecoveryMethod::surface, loaded};
  const Eigen::MatrixXd recovered = fem::nodal_stress(body, u), difference = recovered - mean;
  return {von_mises(Eigen::MatrixXd(difference.reshaped())),
          von_mises(Eigen::MatrixXd(recovered.reshaped()))};
}

// Nodes that are loaded or held have no free surface.
TEST_F(Recover, estimates_the_error_of_means_by_the_difference_of_two_recoveries) {
  stress_recovery = reduction::RecoveryChoice::average;
  const model::ElasticBody full = reduce(model::Basis::full);
  RecoveredBody recovered = prepare_recovery(write(full), Acceleration::automatic, true, finite_elements());
  const io::StressSet set = recover_stress(recovered, full, "ymax", true);
  ASSERT_EQ(set.mesh_error.rows(), set.von_mises.rows());
  const io::BodySource source = io::read_body_source(file);
  ASSERT_EQ(source.recovery.method, model::RecoveryMethod::average);
  const Eigen::VectorXd u = io::read_displacement_field(file, at_rest(full)).reshaped();
  const BothRecoveries both = both_recoveries(source, full.surface.node, u);
  int n_free = 0;
  for (std::size_t i = 0; i < set.node.size(); ++i) {
    const double expected = both.difference[set.node[i]];
    const auto row = static_cast<Eigen::Index>(i);
    if (expected == 0) {  // as large a part as at nodes near by
      EXPECT_GT(set.mesh_error(row, 0), 0);
      continue;
    }
    EXPECT_NEAR(set.mesh_error(row, 0), expected, kRoundoff * both.recovered.norm());
    ++n_free;
  }
  EXPECT_GE(n_free, 8);
}

// Hexahedra: the order is 1.
TEST_F(Recover, estimates_the_error_of_recovered_stresses_by_the_square_of_the_difference) {
  const model::ElasticBody full = reduce(model::Basis::full);
  RecoveredBody recovered = prepare_recovery(write(full), Acceleration::automatic, true, finite_elements());
  const io::StressSet set = recover_stress(recovered, full, "ymax", true);
  const io::BodySource source = io::read_body_source(file);
  ASSERT_EQ(source.recovery.method, model::RecoveryMethod::surface);
  const Eigen::VectorXd u = io::read_displacement_field(file, at_rest(full)).reshaped();
  const auto [difference, stress] = both_recoveries(source, full.surface.node, u);
  const auto patches = mesh::surface_patches(source.mesh, set.node);
  std::vector<int> free;
  for (int node = 0; node < difference.size(); ++node)
    if (difference[node] > 0) free.push_back(node);
  const Eigen::VectorXd field = mesh_error_field(
      difference, stress, {mesh::surface_patches(source.mesh, free), mesh::cell_orders(source.mesh, free)});
  int n_below = 0;
  for (std::size_t i = 0; i < set.node.size(); ++i) {
    if (difference[set.node[i]] == 0) continue;
    double sum = 0, n = 0, largest = 0;
    for (int node : patches[i])
      if (difference[node] > 0) {
        sum += difference[node] * difference[node];
        ++n;
        largest = std::max(largest, stress[node]);
      }
    const double mean = std::sqrt(sum / n), expected = std::min(mean, 2 * mean * mean / largest);
    EXPECT_NEAR(set.mesh_error(static_cast<Eigen::Index>(i), 0), expected, kRoundoff * stress.norm());
    EXPECT_NEAR(field[set.node[i]], expected, kRoundoff * stress.norm());
    n_below += expected < mean;
  }
  EXPECT_GE(n_below, 4);
}

TEST_F(Recover, estimates_the_error_of_sets_of_loaded_nodes_by_free_ones_beside) {
  for (const auto choice : {reduction::RecoveryChoice::automatic, reduction::RecoveryChoice::average}) {
    stress_recovery = choice;
    const model::ElasticBody full = reduce(model::Basis::full);
    RecoveredBody recovered = prepare_recovery(write(full), Acceleration::automatic, true, finite_elements());
    const io::StressSet loaded = recover_stress(recovered, full, "zmax", true),
                        both = recover_stress(recovered, full, "beside", true);
    ASSERT_EQ(loaded.mesh_error.rows(), std::ssize(loaded.node));
    ASSERT_GT(both.node.size(), loaded.node.size());
    for (std::size_t i = 0; i < loaded.node.size(); ++i) {
      const auto in_both = std::find(both.node.begin(), both.node.end(), loaded.node[i]);
      ASSERT_NE(in_both, both.node.end());
      const double expected = both.mesh_error(in_both - both.node.begin(), 0);
      EXPECT_NEAR(loaded.mesh_error(static_cast<Eigen::Index>(i), 0), expected, kRoundoff * expected);
      EXPECT_GT(expected, 0);
    }
  }
}

TEST_F(Recover, estimates_the_error_of_the_mesh_of_reduced_bodies_alike) {
  const auto estimate = [&](const model::ElasticBody& body, Acceleration acceleration) {
    RecoveredBody recovered = prepare_recovery(write(body), acceleration, true, finite_elements());
    return recover_stress(recovered, body, "ymax", true).mesh_error;
  };
  const Eigen::MatrixXd exactly = estimate(reduce(model::Basis::full), Acceleration::automatic);
  const Eigen::MatrixXd reduced = estimate(reduce(model::Basis::modal, true), Acceleration::automatic);
  EXPECT_GT(reduced.norm(), 0.5 * exactly.norm());
  EXPECT_LT(reduced.norm(), 2 * exactly.norm());
}

// Every force spread over the nodes of the faces around it, by the unreduced body.
TEST_F(Recover, estimates_the_error_of_the_contact_by_spread_forces) {
  const model::ElasticBody body = reduce(model::Basis::modal, true);
  RecoveredBody recovered = prepare_recovery(write(body), Acceleration::automatic, true, finite_elements());
  const io::StressSet set = recover_stress(recovered, body, "ymax", true);
  const model::Surface& surface = body.surface;
  const model::ContactForces at = forces(body);
  Eigen::Matrix3Xd change = Eigen::Matrix3Xd::Zero(3, surface.X.cols());
  for (std::size_t i = 0; i < at.node.size(); ++i) {
    std::vector<std::vector<int>> faces;
    for (const auto face : surface.face.colwise())
      if ((face.array() == at.node[i]).any()) faces.emplace_back(face.begin(), face.end());
    const contact::Spread to = contact::spread(
        surface.X, faces, at.node[i], std::vector<char>(static_cast<std::size_t>(surface.X.cols()), 1));
    const Eigen::Vector3d f = at.f_B.col(static_cast<Eigen::Index>(i));
    change(Eigen::all, to.node) += f * to.weight.transpose();
    change.col(at.node[i]) -= f;
  }
  const Eigen::VectorXd stress =
      reduction::StaticResponse(io::read_body_source(file)).stress(surface.node, set.node) *
      change.reshaped();
  const Eigen::MatrixXd expected = von_mises(Eigen::MatrixXd(stress));
  ASSERT_GT(expected.maxCoeff(), 0.01 * set.von_mises.maxCoeff());
  EXPECT_LT((set.contact_error - expected).norm(), kSinglePrecision * set.von_mises.norm());
}

// Their equilibria are those of bodies with modes, and so are their errors.
TEST_F(Recover, estimates_the_errors_of_bodies_without_modes_alike) {
  const auto recover = [this](int modes) {
    n_modes = modes;
    const model::ElasticBody body = reduce(model::Basis::modal, true);
    BodyOfRun run = write(body, {1, 1, 1});
    run.rigid = false;  // what results of the program say
    RecoveredBody recovered = prepare_recovery(run, Acceleration::automatic, true, finite_elements());
    return recover_stress(recovered, body, "ymax", true);
  };
  const io::StressSet with = recover(kModes), without = recover(0);
  const double all = kSinglePrecision * with.von_mises.norm();
  EXPECT_LT((without.stress - with.stress).norm(), all);
  EXPECT_LT((without.error - with.error).norm(), all);
  EXPECT_LT((without.contact_error - with.contact_error).norm(), all);
  EXPECT_LT((without.peak_error - with.peak_error).norm(), all);
}

// Without static responses in the body file it is not told.
TEST_F(Recover, tells_no_error_of_the_contact_by_modes_alone) {
  const model::ElasticBody body = reduce(model::Basis::modal);
  RecoveredBody recovered = prepare_recovery(write(body), Acceleration::always, true, finite_elements());
  EXPECT_EQ(recover_stress(recovered, body, "ymax", true).contact_error.size(), 0);
}

// Three output times with forces that are halved, kept, and doubled with the other sign.
TEST_F(Recover, fields_of_several_times_have_the_displacements_of_the_full_basis) {
  const Eigen::Matrix3Xd u_full =
      io::read_displacement_field(file, at_rest(reduce(model::Basis::full)));  // before the file is another
  const model::ElasticBody body = reduce(model::Basis::modal, true);
  const RecoveredBody recovered =
      prepare_recovery(write(body, {0.5, 1, -2}), Acceleration::automatic, false, finite_elements());
  const std::vector<FieldState> states = recovered_states(recovered, {2, 1}, false);
  ASSERT_EQ(states.size(), 2);
  const Eigen::Matrix3Xd of_modes = io::read_displacement_field(file, states[1].q);
  ASSERT_GT((of_modes - u_full).norm(), 0.1 * u_full.norm()) << "a comparison that says nothing";
  EXPECT_LT((of_modes.reshaped() + states[1].u_static - u_full.reshaped()).norm(), kRoundoff * u_full.norm());
  EXPECT_LT((states[0].u_static + 2 * states[1].u_static).norm(), kRoundoff * states[0].u_static.norm());
}

TEST(MeshErrorField, takes_the_share_of_free_surfaces_elsewhere) {
  const Eigen::Vector3d error = mesh_error_field(Eigen::Vector3d(1, 0, 2), Eigen::Vector3d(10, 5, 20), {});
  EXPECT_LT((error - Eigen::Vector3d(1, 0.5, 2)).norm(), 1e-14);
  EXPECT_EQ(mesh_error_field(Eigen::Vector2d::Zero(), Eigen::Vector2d(3, 4), {}).norm(), 0);
}

// Patches of one node and cells of order 1: errors of 0.2 and 0.4 with means' of 1 and 2.
TEST(MeshErrorField, takes_the_share_of_means_elsewhere_and_its_mean_with_what_loaded_nodes_tell) {
  const Eigen::Vector3d difference(1, 0, 2), stress(10, 5, 20);
  const SurfacePatches patches{{{0}, {2}}, {1, 1}};
  const double share = std::sqrt(5. / 500);
  const Eigen::Vector3d error = mesh_error_field(difference, stress, patches);
  EXPECT_LT((error - Eigen::Vector3d(0.2, 5 * share, 0.4)).norm(), 1e-14);
  const Eigen::Vector3d loaded =
      mesh_error_field(difference, stress, patches, {{1}, Eigen::VectorXd::Constant(1, 0.3)});
  EXPECT_LT((loaded - Eigen::Vector3d(0.2, 1.3 * std::sqrt(0.3 * 5 * share), 0.4)).norm(), 1e-14);
}

// Cells of order 1 have means whose difference falls as their error does.
TEST(PatchError, within_a_loaded_surface_is_the_mean_square_difference_and_falls_for_quadratic_cells) {
  const Eigen::Vector2d difference(3, 4), stress(100, 50);
  const double mean = std::sqrt(12.5);
  EXPECT_NEAR(error_within_surface(difference, stress, 1), mean, 1e-14);
  EXPECT_NEAR(error_within_surface(difference, stress, 2), 2 * mean * std::sqrt(mean / 100), 1e-14);
  EXPECT_EQ(error_within_surface(Eigen::VectorXd(), Eigen::VectorXd(), 1), 0);
}

// p of the cells: 2 mean (mean / largest)^(1/p), at most the mean.
TEST(PatchError, falls_with_a_power_of_the_mean_square_difference) {
  const Eigen::Vector2d difference(3, 4), stress(100, 50);
  const double mean = std::sqrt(12.5);
  EXPECT_NEAR(patch_error(difference, stress, 1).error, 2 * 12.5 / 100, 1e-14);
  EXPECT_NEAR(patch_error(difference, stress, 2).error, 2 * mean * std::sqrt(mean / 100), 1e-14);
  EXPECT_EQ(patch_error(difference, stress, 2).largest, 100);
  EXPECT_NEAR(patch_error(100 * difference, stress, 1).error, 100 * mean, 1e-12);
  EXPECT_NEAR(patch_error(difference, Eigen::Vector2d::Zero(), 1).error, mean, 1e-14);
  EXPECT_EQ(patch_error(Eigen::VectorXd(), Eigen::VectorXd(), 1).error, 0);
}

TEST_F(Recover, fields_of_contact_have_the_forces_in_the_world) {
  const model::ElasticBody body = reduce(model::Basis::modal);
  write(body);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  const BodyContact contact = read_body_contact(result, "bar", body.surface);
  const Eigen::Index n_nodes = io::read_body_source(file).mesh.n_nodes();
  const auto fields = contact_fields(contact, 0, R, body.surface, n_nodes);
  ASSERT_EQ(fields[0].values.cols(), n_nodes);
  const model::ContactForces f = forces(body);
  for (std::size_t i = 0; i < f.node.size(); ++i)
    EXPECT_EQ(fields[0].values.col(body.surface.node[f.node[i]]),
              R * f.f_B.col(static_cast<Eigen::Index>(i)));
  EXPECT_NEAR(fields[0].values.squaredNorm(), f.f_B.squaredNorm(), kRoundoff * f.f_B.squaredNorm());
}

TEST_F(Recover, refuses_the_body_of_another_run_and_sets_that_are_not_there) {
  const model::ElasticBody body = reduce(model::Basis::modal);
  RecoveredBody recovered = prepare_recovery(write(body), Acceleration::never, false, finite_elements());
  EXPECT_THROW(recover_stress(recovered, body, "xmax", false), Error);
  reduce(model::Basis::full);
  EXPECT_THROW(read_elastic_body(recovered.run), Error);
}

}  // namespace
}  // namespace elastogear::recovery::recover_test
