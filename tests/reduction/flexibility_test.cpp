// Static answers that a reduction stores, with and without symmetry, on any number of ranks.
#include "elastogear/reduction/flexibility.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "../fem/brick.h"
#include "../fem/other_cells.h"
#include "../mesh/disc.h"
#include "elastogear/base/error.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/marker.h"
#include "elastogear/reduction/reduce.h"
#include "elastogear/reduction/static_response.h"
#include "elastogear/reduction/stressed_body.h"
#include "reduction/static_response/independent_rows.h"

namespace elastogear::flexibility_test {
namespace {

constexpr double kRoundoff = 1e-7;         // of static responses by two factors
constexpr double kSinglePrecision = 5e-7;  // of stored answers, relative to the largest

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

// Faces of the rim and of the top near it.
mesh::Mesh disc_with_rim(int sectors = 5, int columns = 2) {
  mesh::Mesh mesh = test::disc({sectors, columns, 3, 2});
  for (const mesh::Face& face : mesh.face_sets.at("surface")) {
    const auto far = [&](int node) { return mesh.X.col(node).head<2>().norm() > 0.5 && mesh.X(2, node) > 0; };
    if (std::all_of(face.begin(), face.end(), far)) mesh.face_sets["rim"].push_back(face);
  }
  for (const mesh::Face& face : mesh.face_sets.at("rim"))
    for (int node : face) mesh.node_sets["rim"].push_back(node);
  auto& rim = mesh.node_sets["rim"];
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  mesh.node_sets["few"] = {rim[1], rim[4], rim[17]};  // does not repeat
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (const double r = mesh.X.col(node).head<2>().norm(); mesh.X(2, node) > 0.39 && r > 0.2 && r < 0.5)
      mesh.node_sets["inner"].push_back(node);  // without forces on them
  mesh.node_sets["one"] = {mesh.node_sets["inner"].front()};
  return mesh;
}

class Flexibility : public testing::Test {
 protected:
  mesh::Mesh mesh_ = disc_with_rim();
  std::string path_ = testing::TempDir() + "flexibility.h5";

  reduction::ReductionOptions options(reduction::Symmetry symmetry) const {
    reduction::ReductionOptions o;
    o.name = "disc";
    o.regions = test::kSteelBody;
    o.restrain = {"bottom"};
    o.surface = o.loaded = {"rim"};
    o.stress_nodes = {"few"};
    o.n_modes = 8;
    o.window = reduction::kAutomaticWindow;
    o.flexibility = true;
    o.symmetry = symmetry;
    return o;
  }
  // The same disc that nothing holds.
  reduction::ReductionOptions free_options(reduction::Symmetry symmetry) const {
    reduction::ReductionOptions o = options(symmetry);
    o.restrain = {};
    o.floating = o.frame_at_center = true;
    return o;
  }
  // The body that was written last answers as its unreduced mesh does.
  void expect_static_response(const model::ElasticBody& body) const {
    const io::BodySource source = io::read_body_source(path_);
    reduction::StaticResponse response(source, body.floating);
    const std::vector<int>& node = body.surface.node;
    for (std::size_t b : {std::size_t{0}, node.size() / 2, node.size() - 1}) {
      const Eigen::Vector3d f(3, -1, 2);
      const Eigen::VectorXd u = response.displacement({node[b]}, f);
      const Eigen::VectorXd sigma = response.stress({node[b]}, body.stress.node) * f;
      const Eigen::MatrixXf F =
          model::displacement_columns(body.flexibility, body.flexibility.surface.orbit[b]);
      const Eigen::MatrixXf G = io::read_stress_responses(path_, body.flexibility.surface.orbit[b]);
      for (std::size_t a = 0; a < node.size(); ++a)
        EXPECT_LT(
            (model::displacement_response(body.flexibility, static_cast<int>(a), static_cast<int>(b), F) * f -
             u.segment<3>(3 * node[a]))
                .norm(),
            kSinglePrecision * u.norm());
      // Harmonics are added in single precision, of which each is as large as the largest stress of the
      // images.
      const double largest = (G.cast<double>() * f).norm();
      for (std::size_t e = 0; e < body.stress.node.size(); ++e)
        EXPECT_LT(
            (model::stress_responses(body.flexibility, {static_cast<int>(e)}, static_cast<int>(b), G) * f -
             sigma.segment<6>(static_cast<Eigen::Index>(6 * e)))
                .norm(),
            kSinglePrecision * largest);
    }
  }
  model::ElasticBody reduce(const reduction::ReductionOptions& o) const {
    reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh_ : mesh::Mesh(), o, path_);
    return is_root() ? io::read_body(path_) : model::ElasticBody();
  }
  void TearDown() override {
    if (is_root()) std::filesystem::remove(path_);
  }
};

TEST_F(Flexibility, is_the_static_response_of_the_body_with_and_without_symmetry) {
  for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none}) {
    const model::ElasticBody body = reduce(options(symmetry));
    if (!is_root()) continue;
    EXPECT_EQ(body.flexibility.n_sectors, symmetry == reduction::Symmetry::none ? 1 : 5);
    expect_static_response(body);
  }
}

class AttachmentModes : public Flexibility {
 protected:
  static std::vector<reduction::ReductionOptions> cases(const std::vector<reduction::ReductionOptions>& of) {
    std::vector<reduction::ReductionOptions> all = of;
    for (reduction::ReductionOptions& o : all) {
      o.markers = {"inner", "one"};
      o.attachments = true;
      o.invariants = reduction::Invariants::full;
    }
    all.push_back(all.front());
    all.back().flexibility = false;
    all.back().surface = all.back().loaded = {};
    return all;
  }
  // Unit loads on the markers, 3 n_nodes x 12.
  Eigen::MatrixXd unit_loads(const io::BodySource& source) const {
    return Eigen::MatrixXd(reduction::marker_operator(source.mesh, {"inner", "one"})).transpose();
  }
  Eigen::MatrixXd whole_response(const io::BodySource& source, bool floating,
                                 const Eigen::MatrixXd& f) const {
    std::vector<int> all(static_cast<std::size_t>(source.mesh.n_nodes()));
    std::iota(all.begin(), all.end(), 0);
    return reduction::StaticResponse(source, floating).displacement(all, f);
  }
};

TEST_F(AttachmentModes, make_the_static_response_to_loads_at_markers_that_of_the_unreduced_body) {
  for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none})
    for (const reduction::ReductionOptions& o : cases({options(symmetry), free_options(symmetry)})) {
      const model::ElasticBody body = reduce(o);
      if (!is_root()) continue;
      EXPECT_EQ(body.n_attachments, 9);  // a single node has no rotation
      EXPECT_GE(body.frequency.tail(9).minCoeff(), body.frequency.head(body.n_modes()).maxCoeff());
      const io::BodySource source = io::read_body_source(path_);
      const Eigen::MatrixXd f = unit_loads(source), whole = whole_response(source, body.floating, f);
      for (int load : {0, 4, 6, 8}) {
        const Eigen::VectorXd w = Eigen::VectorXd::Unit(6, load % 6),
                              h = model::multiply_transposed(body.markers[load / 6].Phi, w),
                              q = h.cwiseQuotient(Eigen::VectorXd(body.K_r.diagonal()));
        const Eigen::VectorXd u = io::read_displacement_field(path_, q).reshaped(),
                              by_modes = io::read_displacement_field(
                                             path_, (Eigen::VectorXd(q.size()) << q.head(body.n_modes()),
                                                     Eigen::VectorXd::Zero(body.n_attachments))
                                                        .finished())
                                             .reshaped();
        EXPECT_LT((u - whole.col(load)).norm(), kRoundoff * whole.col(load).norm());
        EXPECT_GT((by_modes - whole.col(load)).norm(), 1e-3 * whole.col(load).norm());
      }
    }
}

TEST_F(AttachmentModes, move_markers_by_forces_elsewhere_as_the_unreduced_body_does) {
  for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none})
    for (reduction::ReductionOptions o : {options(symmetry), free_options(symmetry)}) {
      o.markers = {"inner", "one"};
      o.attachments = true;
      const model::ElasticBody body = reduce(o);
      if (!is_root()) continue;
      const io::BodySource source = io::read_body_source(path_);
      Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * source.mesh.n_nodes()),
                      h = Eigen::VectorXd::Zero(body.n_q());
      for (int i : {1, static_cast<int>(body.surface.node.size()) - 2}) {
        const Eigen::Vector3d force(3, i, -2);
        f.segment<3>(3 * body.surface.node[i]) = force;
        model::add_force(body.surface.Phi, i, force, h);
      }
      const Eigen::VectorXd q = h.cwiseQuotient(Eigen::VectorXd(body.K_r.diagonal())),
                            moved = unit_loads(source).transpose() * whole_response(source, body.floating, f);
      for (int m : {0, 1}) {
        const Eigen::VectorXd expected = moved.segment<6>(6 * m);
        EXPECT_LT((model::multiply(body.markers[m].Phi, q) - expected).norm(), kRoundoff * expected.norm());
      }
    }
}

TEST_F(AttachmentModes, are_orthonormal_beside_the_modes) {
  for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none})
    for (const reduction::ReductionOptions& o : cases({options(symmetry), free_options(symmetry)})) {
      const model::ElasticBody body = reduce(o);
      if (!is_root()) continue;
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(body.n_q(), body.n_q());
      for (int a : {0, 1, 2}) M += std::get<model::DenseRows>(body.inertia.S_2[a]);
      EXPECT_LT((M - Eigen::MatrixXd::Identity(M.rows(), M.cols())).lpNorm<Eigen::Infinity>(), 1e-9);
      if (!body.floating) continue;
      EXPECT_LT(body.inertia.C_l.lpNorm<Eigen::Infinity>(), 1e-9 * std::sqrt(body.inertia.m));
    }
}

TEST_F(AttachmentModes, of_held_markers_are_none) {
  reduction::ReductionOptions o = options(reduction::Symmetry::none);
  o.markers = {"bottom"};
  o.attachments = true;
  const model::ElasticBody body = reduce(o);
  if (!is_root()) return;
  EXPECT_EQ(body.n_attachments, 0);
}

// Whose harmonics are condensed to the border of the sector.
TEST_F(Flexibility, of_large_sectors_is_the_static_response_of_the_body) {
  mesh_ = disc_with_rim(5, 10);
  const model::ElasticBody body = reduce(options(reduction::Symmetry::automatic));
  if (!is_root()) return;
  EXPECT_EQ(body.flexibility.n_sectors, 5);
  expect_static_response(body);
}

TEST_F(Flexibility, recovers_stresses_on_free_surfaces_as_its_modes_and_the_unreduced_body_do) {
  for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none})
    for (const std::vector<std::string>& markers : {std::vector<std::string>{"inner"}, {"one"}, {}}) {
      reduction::ReductionOptions o = options(symmetry);
      o.stress_nodes = {"few", "inner"};
      o.stress_recovery = reduction::RecoveryChoice::surface;
      o.markers = markers;
      const model::ElasticBody body = reduce(o);
      if (!is_root()) continue;
      // A marker on one of them alone, where stresses are averaged, breaks the symmetry.
      const bool repeats =
          symmetry == reduction::Symmetry::automatic && markers != std::vector<std::string>{"one"};
      EXPECT_EQ(body.flexibility.n_sectors, repeats ? 5 : 1);
      expect_static_response(body);
      const io::BodySource source = io::read_body_source(path_);
      const Eigen::VectorXd q = Eigen::VectorXd::Random(body.n_q()),
                            sigma = model::multiply(body.stress.Psi, q);
      const Eigen::Matrix3Xd u = io::read_displacement_field(path_, q);
      const Eigen::MatrixXd field = fem::nodal_stress(reduction::stressed_body(source), u.reshaped()),
                            mean = fem::nodal_stress({source.mesh, source.regions, source.element},
                                                     u.reshaped());
      const model::SparseRows S = fem::stress_operator(reduction::stressed_body(source), body.stress.node);
      const reduction::IndependentRows rows = reduction::independent_rows(S);
      ASSERT_EQ(rows.n_nodes(), static_cast<int>(body.stress.node.size()));
      for (std::size_t e = 0; e < body.stress.node.size(); ++e) {
        const int node = body.stress.node[e], first = rows.first[e], n = rows.first[e + 1] - first;
        const Eigen::MatrixXd own = S.middleRows(static_cast<Eigen::Index>(6 * e), 6);
        EXPECT_LT((rows.Q.middleCols(first, n) * Eigen::MatrixXd(rows.W.middleRows(first, n)) - own).norm(),
                  1e-12 * own.norm());
        EXPECT_EQ(n, std::binary_search(source.recovery.loaded.begin(), source.recovery.loaded.end(), node)
                         ? 6
                         : 3);
        EXPECT_LT((sigma.segment<6>(static_cast<Eigen::Index>(6 * e)) - field.col(node)).norm(),
                  1e-10 * field.norm());
        const auto& loaded = source.recovery.loaded;
        EXPECT_EQ((field.col(node) - mean.col(node)).norm() < 1e-10 * field.norm(),
                  std::binary_search(loaded.begin(), loaded.end(), node));
      }
    }
}

// With two sectors the harmonic of the rigid motions across the axis is real, with more complex.
TEST_F(Flexibility, of_a_free_body_is_that_of_loads_balanced_by_inertia) {
  for (int sectors : {2, 3, 4, 5})
    for (const auto symmetry : {reduction::Symmetry::automatic, reduction::Symmetry::none}) {
      SCOPED_TRACE(sectors);
      mesh_ = disc_with_rim(sectors, 3);
      mesh_.X.colwise() += Eigen::Vector3d(0.4, -0.3, 0.2);
      const model::ElasticBody body = reduce(free_options(symmetry));
      if (!is_root()) continue;
      EXPECT_TRUE(body.floating);
      EXPECT_EQ(body.flexibility.n_sectors, symmetry == reduction::Symmetry::none ? 1 : sectors);
      expect_static_response(body);
    }
}

// F = Phi Lambda^-1 Phi' with all modes: R is zero.
void expect_all_modes(const model::ElasticBody& body) {
  const auto& Phi = std::get<model::DenseRows>(body.surface.Phi);
  const Eigen::MatrixXd all =
      Phi * Eigen::VectorXd(body.K_r.diagonal()).cwiseInverse().asDiagonal() * Phi.transpose();
  ASSERT_EQ(body.flexibility.node.size(), body.surface.node.size());
  for (int b = 0; b < static_cast<int>(body.flexibility.node.size()); ++b)
    EXPECT_LE(
        (model::displacement_columns(body.flexibility, b).cast<double>() - all.middleCols<3>(3 * b)).norm(),
        kSinglePrecision * all.middleCols<3>(3 * b).norm());
}

// Cells of first and second order, regions of several materials, point masses (which balance loads, too);
// each held and free.
TEST_F(Flexibility, of_any_body_is_that_of_all_its_modes) {
  const auto brick = test::distorted(test::brick({2, 2, 1}, {1, 0.8, 0.3}), 0.03);
  for (const auto type : {mesh::CellType::hex8, mesh::CellType::hex20, mesh::CellType::tet10})
    for (bool floating : {false, true})
      for (bool more : {false, true}) {
        SCOPED_TRACE(testing::Message() << mesh::name(type) << (floating ? " free" : " held")
                                        << (more ? " with regions and a point mass" : ""));
        mesh_ = test::cells_of(type, brick);
        reduction::ReductionOptions o =
            floating ? free_options(reduction::Symmetry::none) : options(reduction::Symmetry::none);
        o.surface = {"surface"};
        o.loaded = {};
        o.stress_nodes = {"xmax"};
        if (!floating) o.restrain = {"xmin"};
        if (more) {
          mesh_.cell_sets["core"] = {0};
          o.regions = {{"", test::kSteel}, {"core", test::kFibre}};
          o.point_mass = {{"ymax", 500}};
        }
        const auto n_free =
            3 * (mesh_.n_nodes() - (floating ? 2 : static_cast<int>(mesh_.node_sets.at("xmin").size())));
        o.n_modes = n_free;
        const model::ElasticBody body = reduce(o);
        if (is_root()) expect_all_modes(body);
      }
}

TEST_F(Flexibility, is_asked_for_one_node_of_each_orbit) {
  const model::ElasticBody body = reduce(options(reduction::Symmetry::automatic));
  if (!is_root()) return;
  EXPECT_EQ(body.flexibility.self.size() * 5, static_cast<Eigen::Index>(body.surface.node.size()));
}

TEST_F(Flexibility, of_a_surface_that_does_not_repeat_is_found_for_its_own_nodes) {
  mesh_.face_sets["one"] = {mesh_.face_sets.at("rim").front()};
  reduction::ReductionOptions o = options(reduction::Symmetry::automatic);
  o.surface = o.loaded = {"one"};
  const model::ElasticBody body = reduce(o);
  if (!is_root()) return;
  EXPECT_EQ(body.flexibility.n_sectors, 1);
  EXPECT_EQ(body.flexibility.node.size(), 4u);
}

TEST_F(Flexibility, refuses_loads_off_the_surface_and_bases_without_modes) {
  reduction::ReductionOptions o = options(reduction::Symmetry::automatic);
  o.loaded = {"surface"};
  EXPECT_THROW(reduce(o), Error);
  o = options(reduction::Symmetry::automatic);
  o.basis = model::Basis::full;
  EXPECT_THROW(reduce(o), Error);
  o = options(reduction::Symmetry::automatic);
  o.surface.clear();
  EXPECT_THROW(reduce(o), Error);
}

}  // namespace
}  // namespace elastogear::flexibility_test
