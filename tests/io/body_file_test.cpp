#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../fem/other_cells.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/describe.h"
#include "elastogear/model/fingerprint.h"
#include "elastogear/model/row_bounds.h"
#include "io/hdf5/hdf5.h"
#include "sample_body.h"

namespace elastogear::body_file_test {
using namespace io;
using testing::HasSubstr;

namespace {

template <class Sparse>
bool equal_sparse(const Sparse& A, const Sparse& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A.nonZeros() == B.nonZeros() &&
         A.toDense() == B.toDense();
}

bool equal(const model::BasisRows& a, const model::BasisRows& b) {
  const model::DenseRows *x = model::dense_rows(a), *y = model::dense_rows(b);
  if (x || y) return x && y && *x == *y;
  return equal_sparse(std::get<model::SparseRows>(a), std::get<model::SparseRows>(b));
}

bool equal(const model::Inertia& a, const model::Inertia& b) {
  return a.m == b.m && a.c == b.c && a.J == b.J && a.C_l == b.C_l && a.C_r == b.C_r && a.S_1 == b.S_1 &&
         std::equal(a.S_2.begin(), a.S_2.end(), b.S_2.begin(), b.S_2.end(),
                    [](const auto& x, const auto& y) { return equal(x, y); });
}

bool equal(const model::Surface& a, const model::Surface& b) {
  return a.node == b.node && a.X == b.X && a.face == b.face && a.group == b.group && a.c_f == b.c_f &&
         a.group_name == b.group_name && equal(a.Phi, b.Phi);
}

bool equal(const model::Marker& a, const model::Marker& b) {
  return a.name == b.name && a.X == b.X && a.turns == b.turns && equal(a.Phi, b.Phi);
}

void expect_equal(const model::ElasticBody& a, const model::ElasticBody& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.basis, b.basis);
  EXPECT_EQ(a.frequency, b.frequency);
  EXPECT_TRUE(equal_sparse(a.M_r, b.M_r) && equal_sparse(a.K_r, b.K_r));
  EXPECT_TRUE(a.alpha == b.alpha && a.beta == b.beta && a.zeta == b.zeta);
  EXPECT_TRUE(equal(a.inertia, b.inertia));
  EXPECT_TRUE(equal(a.surface, b.surface));
  EXPECT_TRUE(a.stress.node == b.stress.node && a.stress.X == b.stress.X && a.stress.sets == b.stress.sets);
  EXPECT_TRUE(equal(a.stress.Psi, b.stress.Psi));
  ASSERT_EQ(a.markers.size(), b.markers.size());
  for (std::size_t i = 0; i < a.markers.size(); ++i) EXPECT_TRUE(equal(a.markers[i], b.markers[i]));
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.assembled_K, b.assembled_K);
  EXPECT_EQ(a.assembled_M, b.assembled_M);
}

std::string message(const std::string& path) {
  try {
    read_body(path);
    read_body_source(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct BodyFile : testing::Test {
  mesh::Folder folder{"body"};
  std::string path = folder / "worm.h5";
};

TEST_F(BodyFile, gives_a_modal_body_back_to_the_bit) {
  const model::ElasticBody body = sample_modal_body();
  write_modal(path, body, sample_modes());
  expect_equal(read_body(path), body);
  EXPECT_EQ(folder.files(), 1);
}

TEST_F(BodyFile, gives_a_full_body_back_to_the_bit) {
  const model::ElasticBody body = sample_full_body();
  write_full(path, body);
  expect_equal(read_body(path), body);
}

TEST_F(BodyFile, read_for_motion_lacks_nothing_but_stress) {
  model::ElasticBody body = sample_modal_body();
  write_modal(path, body, sample_modes());
  ASSERT_FALSE(body.stress.node.empty());
  body.stress = {};
  expect_equal(read_body(path, BodyUse::motion), body);
}

// Opens the file again, to change it.
template <class Change>
void change(const std::string& path, const Change& change_file) {
  const h5::Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  ASSERT_GE(file, 0);
  change_file(file);
}

TEST_F(BodyFile, read_for_motion_knows_bounds_of_rows_and_reads_those_that_are_asked_for) {
  const model::ElasticBody body = sample_modal_body();
  write_modal(path, body, sample_modes());
  const model::ElasticBody read = read_body(path, BodyUse::motion);
  const model::RowBounds* known = model::known_bounds(read.surface.Phi);
  ASSERT_TRUE(known);
  const std::optional<model::RowBounds> bounds = model::row_bounds(body);
  EXPECT_TRUE(known->compliance == bounds->compliance && known->mobility == bounds->mobility &&
              known->square == bounds->square && known->largest == bounds->largest);
  EXPECT_EQ(known->strain, bounds->strain);
  EXPECT_EQ(model::fingerprint(read), model::fingerprint(body));
  std::remove(path.c_str());  // the file stays open
  const Eigen::Vector3d q(1, -2, 0.5);
  for (int node = 0; node < body.surface.X.cols(); ++node)
    EXPECT_EQ(model::displacement(read.surface.Phi, node, q), model::displacement(body.surface.Phi, node, q));
}

TEST_F(BodyFile, bounds_of_other_rows_are_refused_when_rows_are_read) {
  for (const char* name :
       {"/surface/bounds/compliance", "/surface/bounds/mobility", "/surface/bounds/square"}) {
    write_modal(path, sample_modal_body(), sample_modes());
    change(path, [&](hid_t file) {
      const h5::Id dataset(H5Dopen(file, name, H5P_DEFAULT));
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(5);
      EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, ones.data()), 0);
    });
    const model::ElasticBody read = read_body(path, BodyUse::motion);
    EXPECT_THROW(model::displacement(read.surface.Phi, 2, Eigen::Vector3d(1, 2, 3)), Error) << name;
  }
}

TEST_F(BodyFile, without_bounds_of_rows_reads_all_of_them) {
  model::ElasticBody body = sample_modal_body();
  write_modal(path, body, sample_modes());
  change(path, [](hid_t file) { EXPECT_GE(H5Ldelete(file, "/surface/bounds", H5P_DEFAULT), 0); });
  const model::ElasticBody read = read_body(path, BodyUse::motion);
  EXPECT_FALSE(model::known_bounds(read.surface.Phi));
  body.stress = {};
  expect_equal(read, body);
}

TEST_F(BodyFile, blocks_of_zeros_are_not_stored) {
  constexpr Eigen::Index kModes = 600;  // five blocks along the diagonal
  model::ElasticBody body = sample_modal_body(kModes);
  body.K_r.coeffRef(3, 580) = 2;
  write_modal(path, body, sample_modes(kModes));
  expect_equal(read_body(path), body);
  change(path, [](hid_t file) {
    for (const auto& [name, blocks] : {std::pair{"/reduced/M", 5}, std::pair{"/reduced/K", 6}}) {
      const h5::Id dataset(H5Dopen(file, name, H5P_DEFAULT)), space(H5Dget_space(dataset));
      hsize_t n = 0;
      EXPECT_GE(H5Dget_num_chunks(dataset, space, &n), 0);
      EXPECT_EQ(n, static_cast<hsize_t>(blocks)) << name;
    }
  });
}

TEST_F(BodyFile, gives_second_moments_back) {
  model::ElasticBody modal = sample_modal_body(), full = sample_full_body();
  for (int i = 0; i < 6; ++i) {
    modal.inertia.S_2.emplace_back(model::DenseRows(model::DenseRows::Random(3, 3)));
    model::SparseRows S(24, 24);
    S.insert(i, 2 * i) = 1.0 / 3;
    full.inertia.S_2.emplace_back(S);
  }
  write_modal(path, modal, sample_modes());
  expect_equal(read_body(path), modal);
  write_full(path, full);
  expect_equal(read_body(path), full);
}

TEST_F(BodyFile, gives_mesh_materials_and_free_dof_back) {
  write_full(path, sample_full_body());
  const BodySource a = sample_source(), b = read_body_source(path);
  EXPECT_TRUE(mesh::equal(a.mesh, b.mesh));
  EXPECT_EQ(a.free_dof, b.free_dof);
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.element_mass, b.element_mass);
  ASSERT_EQ(b.regions.size(), 2u);
  EXPECT_EQ(b.regions[0].cell_set, "");
  EXPECT_EQ(b.regions[1].cell_set, "even");
  EXPECT_EQ(b.regions[1].material.E, 1.1e11);
  EXPECT_EQ(b.regions[1].material.nu, 0.34);
  EXPECT_EQ(b.regions[1].material.rho, 8800);
}

TEST_F(BodyFile, gives_the_recovery_of_stresses_back) {
  write_full(path, sample_full_body());
  EXPECT_EQ(read_body_source(path).recovery.method, model::RecoveryMethod::average);
  BodySource source = sample_source();
  for (const std::vector<int>& loaded : {std::vector<int>{}, {0, 3, 7}}) {
    source.recovery = {model::RecoveryMethod::surface, loaded};
    BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
    const model::StressRecovery read = read_body_source(path).recovery;
    EXPECT_EQ(read.method, model::RecoveryMethod::surface);
    EXPECT_EQ(read.loaded, loaded);
  }
  for (const std::vector<int>& wrong : {std::vector<int>{3, 3}, {-1}, {source.mesh.n_nodes()}}) {
    source.recovery.loaded = wrong;
    EXPECT_THROW(BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source), Error);
  }
}

TEST_F(BodyFile, gives_checks_back) {
  BodySource source = sample_source();
  source.checks = {{"a", "kg", "of each mode", Eigen::MatrixXd::Random(5, 3)},
                   {"b", "1", "shares", Eigen::MatrixXd::Random(2, 1), {"tooth 1, left", "tooth 1, right"}}};
  BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
  const auto read = read_body_source(path).checks;
  ASSERT_EQ(read.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, source.checks[i].name);
    EXPECT_EQ(read[i].unit, source.checks[i].unit);
    EXPECT_EQ(read[i].meaning, source.checks[i].meaning);
    EXPECT_EQ(read[i].value, source.checks[i].value);
    EXPECT_EQ(read[i].row, source.checks[i].row);
  }
}

TEST_F(BodyFile, gives_shares_of_nothing_back) {
  BodySource source = sample_source();
  source.checks = {{"captured_mass", "1", "shares", Eigen::RowVector2d(0.5, NAN)}};
  BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
  const auto read = read_body_source(path).checks;
  EXPECT_EQ(read.at(0).value(0), 0.5);
  EXPECT_TRUE(std::isnan(read.at(0).value(1)));
}

TEST_F(BodyFile, gives_an_orthotropic_material_back) {
  BodySource source = sample_source();
  model::Material& material = source.regions[1].material = test::kFibre;
  model::Orientation& o = material.orthotropic->orientation;
  for (const auto system :
       {model::Orientation::System::rectangular, model::Orientation::System::cylindrical}) {
    o = {system, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}};
    BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
    const auto regions = read_body_source(path).regions;
    EXPECT_FALSE(regions.at(0).material.orthotropic);
    ASSERT_TRUE(regions.at(1).material.orthotropic);
    const model::Orthotropic &a = *regions[1].material.orthotropic, &b = *material.orthotropic;
    EXPECT_EQ(regions[1].material.rho, material.rho);
    EXPECT_TRUE(a.E == b.E && a.nu == b.nu && a.G == b.G);
    EXPECT_EQ(a.orientation.system, system);
    EXPECT_TRUE(a.orientation.axis_1 == o.axis_1 && a.orientation.axis_2 == o.axis_2);
    EXPECT_TRUE(a.orientation.origin == o.origin && a.orientation.axis == o.axis);
    EXPECT_EQ(a.orientation.rotation, o.rotation);
  }
}

TEST_F(BodyFile, gives_viscoelastic_materials_and_relaxing_parts_back) {
  BodySource source = sample_source();
  model::Viscoelastic series{{0.3, 0.2}, {0.1, 0}, {1e-3, 10}};
  series.shift = {.law = model::TemperatureShift::Law::wlf, .C_1 = 17, .C_2 = 52, .T_ref = 300, .T = 320};
  source.regions[1].material.viscoelastic = series;
  model::ElasticBody body = sample_full_body();
  body.relaxing = {{"even",
                    model::ModulusPart::shear,
                    Eigen::Vector2d(0.3, 0.2),
                    Eigen::Vector2d(1e-3, 10),
                    0.5 * body.K_r,
                    {0}}};
  BodyWriter(path, source.mesh.n_nodes(), 0).finish(body, source);
  const model::ElasticBody read = read_body(path);
  expect_equal(read, body);
  ASSERT_EQ(read.relaxing.size(), 1u);
  EXPECT_EQ(read.relaxing[0].cell_set, "even");
  EXPECT_EQ(read.relaxing[0].part, model::ModulusPart::shear);
  EXPECT_TRUE(read.relaxing[0].g == body.relaxing[0].g && read.relaxing[0].tau == body.relaxing[0].tau);
  EXPECT_TRUE(equal_sparse(read.relaxing[0].K, body.relaxing[0].K));
  EXPECT_EQ(read.relaxing[0].stress_node, body.relaxing[0].stress_node);
  EXPECT_TRUE(read_body(path, BodyUse::motion).relaxing[0].stress_node.empty());
  const auto regions = read_body_source(path).regions;
  EXPECT_FALSE(regions[0].material.viscoelastic);
  ASSERT_TRUE(regions[1].material.viscoelastic);
  EXPECT_TRUE(regions[1].material.viscoelastic->g == series.g &&
              regions[1].material.viscoelastic->k == series.k);
  EXPECT_EQ(regions[1].material.viscoelastic->tau, series.tau);
  EXPECT_EQ(model::shift_factor(regions[1].material.viscoelastic->shift), model::shift_factor(series.shift));
  EXPECT_THAT(describe(path), HasSubstr("viscoelastic, moduli above are instantaneous: g = (0.3 0.2)"));
  EXPECT_NE(model::fingerprint(read), model::fingerprint(sample_full_body()));
}

TEST_F(BodyFile, gives_cells_of_every_type_and_every_element_back) {
  const auto brick = test::brick({2, 2, 2}, {1, 1, 1});
  for (mesh::CellType type : test::all_cell_types())
    for (auto element : {model::Element::incompatible, model::Element::plain, model::Element::bbar}) {
      BodySource source = sample_source();
      source.mesh = test::cells_of(type, brick);
      source.mesh.cell_sets["even"] = {0};
      source.element = element;
      BodyWriter(path, source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
      const BodySource read = read_body_source(path);
      EXPECT_TRUE(mesh::equal(read.mesh, source.mesh)) << mesh::name(type);
      EXPECT_EQ(read.element, element);
    }
}

TEST_F(BodyFile, holds_a_body_without_surface_and_stress_nodes) {
  model::ElasticBody body = sample_modal_body();
  body.surface = {};
  body.surface.Phi = model::DenseRows(0, 3);
  body.stress = {};
  body.stress.Psi = model::DenseRows(0, 3);
  write_modal(path, body, sample_modes());
  expect_equal(read_body(path), body);
}

TEST_F(BodyFile, displacement_field_is_the_sum_of_modes) {
  const Eigen::MatrixXd modes = sample_modes();
  write_modal(path, sample_modal_body(), modes);
  const Eigen::Vector3d q(0.5, -2, 0.25);
  const Eigen::VectorXd expected = modes * q;
  const Eigen::Matrix3Xd u = read_displacement_field(path, q);
  const double roundoff = 1e-15;
  EXPECT_LE((u.reshaped() - expected).norm(), roundoff * expected.norm());
  EXPECT_THROW(read_displacement_field(path, Eigen::Vector2d(1, 2)), Error);
  EXPECT_THROW(read_displacement_field(path, Eigen::Vector3d(1, 2, NAN)), Error);
}

TEST_F(BodyFile, without_modes_at_all_nodes_names_the_remedy) {
  const model::ElasticBody body = sample_modal_body();
  const ModeChecks checks{Eigen::Vector3d(1e-11, 2e-11, 3e-11), 4e-9};
  BodyWriter(path, sample_source().mesh.n_nodes(), 0).finish(body, sample_source(), checks);
  expect_equal(read_body(path), body);
  EXPECT_FALSE(has_full_modes(path));
  EXPECT_EQ(read_mode_checks(path).residual, checks.residual);
  EXPECT_EQ(read_mode_checks(path).orthogonality, checks.orthogonality);
  try {
    read_displacement_field(path, Eigen::Vector3d(1, 2, 3));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("-store all"));
  }
}

TEST_F(BodyFile, in_single_precision_keeps_seven_digits) {
  const Eigen::MatrixXd modes = sample_modes();
  const model::ElasticBody body = sample_modal_body();
  {
    BodyWriter writer(path, sample_source().mesh.n_nodes(), 3, Precision::float32);
    for (int k = 0; k < 3; ++k) writer.write_mode(k, modes.col(k));
    writer.finish(body, sample_source());
  }
  const Eigen::VectorXd q = Eigen::Vector3d(0, 1, 0), single = modes.col(1).cast<float>().cast<double>();
  EXPECT_EQ(read_displacement_field(path, q).reshaped(), single);
  EXPECT_NE(single, modes.col(1));
}

TEST_F(BodyFile, displacement_field_of_the_full_basis_leaves_restrained_nodes_at_rest) {
  write_full(path, sample_full_body());
  const Eigen::VectorXd q = Eigen::VectorXd::Random(24);
  const Eigen::Matrix3Xd u = read_displacement_field(path, q);
  EXPECT_EQ(u.leftCols(4).norm(), 0);
  EXPECT_EQ(u.rightCols(8).reshaped(), q);
}

TEST_F(BodyFile, appears_only_when_complete) {
  write_file(path, "old");
  {
    BodyWriter writer(path, 12, 3);
    writer.write_mode(0, sample_modes().col(0));
    EXPECT_THROW(writer.finish(sample_modal_body(), sample_source()), Error);
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.files(), 1);
}

TEST_F(BodyFile, refuses_modes_that_do_not_fit_or_are_not_finite) {
  BodyWriter writer(path, 12, 3);
  Eigen::VectorXd phi = sample_modes().col(0);
  EXPECT_THROW(writer.write_mode(3, phi), Error);
  EXPECT_THROW(writer.write_mode(-1, phi), Error);
  EXPECT_THROW(writer.write_mode(0, phi.head(9)), Error);
  phi[5] = NAN;
  EXPECT_THROW(writer.write_mode(0, phi), Error);
  EXPECT_THROW(BodyWriter(folder / "none/worm.h5", 12, 3), Error);
}

TEST_F(BodyFile, refuses_bodies_that_are_not_valid) {
  model::ElasticBody body = sample_full_body();
  body.inertia.m = NAN;
  EXPECT_THROW(write_full(path, body), Error);
  body = sample_full_body();
  body.stress.sets["a/b"] = {0};
  EXPECT_THROW(write_full(path, body), Error);
  EXPECT_EQ(folder.files(), 0);
}

TEST_F(BodyFile, is_an_error_when_truncated_anywhere) {
  write_full(path, sample_full_body());
  const std::string content = read_file(path);
  for (std::size_t n = 0; n < content.size(); n += 97) {
    write_file(path, content.substr(0, n));
    EXPECT_NE(message(path), "no error") << "cut at byte " << n;
  }
}

TEST_F(BodyFile, of_another_kind_is_an_error_that_names_it) {
  EXPECT_THAT(message(path), HasSubstr("no such file"));
  EXPECT_THAT(message(folder.path.string()), HasSubstr("not a regular file"));
  write_file(path, "solid");
  EXPECT_THAT(message(path), HasSubstr("is no HDF5 file"));
  H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT(message(path), HasSubstr("has no attribute format"));
}

// Opens the file for a change behind the library's back.
struct Opened {
  hid_t file;
  explicit Opened(const std::string& path) : file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {}
  ~Opened() { H5Fclose(file); }
  template <class T>
  void overwrite(const char* dataset, hid_t type, const std::vector<T>& data) const {
    const hid_t id = H5Dopen2(file, dataset, H5P_DEFAULT);
    ASSERT_GE(H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), 0);
    H5Dclose(id);
  }
};

TEST_F(BodyFile, of_another_version_is_an_error) {
  write_full(path, sample_full_body());
  {
    const Opened opened(path);
    const hid_t version = H5Aopen(opened.file, "version", H5P_DEFAULT);
    const int newer = 5;
    H5Awrite(version, H5T_NATIVE_INT, &newer);
    H5Aclose(version);
  }
  EXPECT_THAT(message(path),
              HasSubstr("has version 5 of the format 'elastogear body', this program reads versions 1 to 4"));
}

TEST_F(BodyFile, without_a_dataset_is_an_error_that_names_it) {
  write_full(path, sample_full_body());
  for (const char* name : {"/reduced/K", "/rigid/mass", "/surface/Phi/data", "/stress/nodes", "/mesh/X"}) {
    write_full(path, sample_full_body());
    H5Ldelete(Opened(path).file, name, H5P_DEFAULT);
    EXPECT_THAT(message(path), HasSubstr(name));
  }
}

TEST_F(BodyFile, with_damaged_numbers_is_an_error) {
  const auto damaged = [&](const char* dataset, auto value, std::size_t n) {
    write_full(path, sample_full_body());
    const hid_t type = std::is_same_v<decltype(value), int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
    Opened(path).overwrite(dataset, type, std::vector(n, value));
    return message(path);
  };
  EXPECT_NE(damaged("/rigid/mass", -1.0, 1), "no error");
  EXPECT_NE(damaged("/rigid/mass", double{NAN}, 1), "no error");
  EXPECT_NE(damaged("/reduced/K/indptr", 1 << 30, 25), "no error");
  EXPECT_NE(damaged("/reduced/K/indices", -1, 26), "no error");
  EXPECT_NE(damaged("/surface/face", 99, 8), "no error");
  EXPECT_NE(damaged("/surface/group", -5, 2), "no error");
  EXPECT_NE(damaged("/stress/sets/root", 2, 2), "no error");
  EXPECT_NE(damaged("/reduced/free_dof", 36, 24), "no error");
  EXPECT_NE(damaged("/mesh/cell_offset", 1 << 30, 3), "no error");
  EXPECT_NE(damaged("/mesh/cell_nodes", -1, 16), "no error");
  EXPECT_NE(damaged("/mesh/cell_type", 7, 2), "no error");
}

}  // namespace
}  // namespace elastogear::body_file_test
