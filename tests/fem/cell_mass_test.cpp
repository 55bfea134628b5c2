// The mass of hexahedra with incompatible modes: rigid motions, bending, and the moments of whole meshes.
#include "fem/elements/cell_mass.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "../figures.h"
#include "elastogear/base/rotation.h"
#include "elastogear/fem/inertia.h"
#include "other_cells.h"
#include "system.h"

namespace elastogear::cell_mass_test {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr model::Formulation kCondensed{model::Element::incompatible, model::ElementMass::condensed};

model::Material wound_fibre() {
  model::Material wound = test::kFibre;
  wound.orthotropic->orientation = {.system = model::Orientation::System::cylindrical,
                                    .origin = {-2, 0.5, 1},
                                    .axis = {0.3, 0.1, 2},
                                    .rotation = {0.6, 0, 0}};
  return wound;
}

const model::Material kSlack{3e9, 0.47, 1100};  // nearly incompressible

// Hexahedra and wedges of random shape, the hexahedra of four materials.
struct Patch {
  mesh::Mesh mesh =
      test::hexahedra_and_wedges(test::distorted(test::brick({4, 3, 3}, {1, 0.8, 0.7}), 0.05), 4);
  std::vector<model::MaterialRegion> regions = {
      {"", test::kSteel}, {"fibre", test::kFibre}, {"wound", wound_fibre()}, {"slack", kSlack}};

  Patch() {
    const char* const sets[] = {"fibre", "wound", "slack"};
    for (const char* set : sets) mesh.cell_sets[set];
    for (int cell = 0; cell < mesh.cells.size(); ++cell)
      if (const int set = cell / 3 % 4; set < 3) mesh.cell_sets[sets[set]].push_back(cell);
  }
};

// Translations along the axes, then rotations about them, at all nodes of X.
Eigen::MatrixXd rigid_fields(const Eigen::Matrix3Xd& X) {
  Eigen::MatrixXd R(3 * X.cols(), 6);
  for (int a = 0; a < 3; ++a) {
    R.col(a) = Eigen::Vector3d::Unit(a).replicate(1, X.cols()).reshaped();
    R.col(3 + a) = (skew(Eigen::Vector3d::Unit(a)) * X).reshaped();
  }
  return R;
}

// Visits the condensed mass of every hexahedron with the plain one and the coordinates.
template <class Visit>
void visit_hexahedra(const Patch& patch, const Visit& visit) {
  const auto region = fem::cell_regions(patch.mesh, patch.regions);
  for (int cell = 0; cell < patch.mesh.cells.size(); ++cell) {
    if (patch.mesh.cells.type[cell] != mesh::CellType::hex8) continue;
    const model::Material& material = patch.regions[region[cell]].material;
    const Eigen::Matrix3Xd X = fem::cell_coordinates(patch.mesh, cell);
    const auto mass = [&](const model::Formulation& formulation) {
      return fem::cell_mass(mesh::CellType::hex8, X, material.rho, fem::elasticity(material), formulation);
    };
    visit(X, mass(kCondensed), mass({}));
  }
}

TEST(CondensedMass, has_amplitudes_that_no_rigid_motion_excites) {
  visit_hexahedra({}, [](const Eigen::Matrix3Xd& X, const fem::CellMass& mass, const fem::CellMass&) {
    ASSERT_TRUE(mass.has_modes());
    const Eigen::MatrixXd R = rigid_fields(X);
    EXPECT_LT((mass.T * R).norm(), kRoundoff * mass.T.norm() * R.norm());
  });
}

TEST(CondensedMass, moves_with_a_rigid_body_as_the_mass_of_the_nodes_does) {
  visit_hexahedra({}, [](const Eigen::Matrix3Xd& X, const fem::CellMass& mass, const fem::CellMass& nodal) {
    const Eigen::MatrixXd R = rigid_fields(X), M = fem::mass_matrix(mass), M_0 = fem::mass_matrix(nodal);
    EXPECT_LT((R.transpose() * M * R - R.transpose() * M_0 * R).norm(), kRoundoff * M_0.norm());
    EXPECT_GT((M - M_0).norm(), 1e-2 * M_0.norm());
    EXPECT_EQ((M - M.transpose()).norm(), 0);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues()(0), 0);
  });
}

// A cell bent by a constant moment about y has exactly the displacements of a beam, which are quadratic:
// u = (x z, -nu y z, -(x^2 + nu (z^2 - y^2))/2), up to a rigid motion.
TEST(CondensedMass, has_the_kinetic_energy_of_a_bent_beam) {
  const double nu = test::kSteel.nu;
  const Eigen::Vector3d half(2, 0.5, 0.75);
  const auto mesh = test::brick({1, 1, 1}, 2 * half);
  const Eigen::Matrix3Xd X = fem::cell_coordinates(mesh, 0).colwise() - half;
  const auto beam = [&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(x.x() * x.z(), -nu * x.y() * x.z(),
                           -(x.x() * x.x() + nu * (x.z() * x.z() - x.y() * x.y())) / 2);
  };
  Eigen::VectorXd u(24);
  for (int a = 0; a < 8; ++a) u.segment<3>(3 * a) = beam(X.col(a));
  double exact = 0;  // 4-point Gauss products integrate u^2, of degree 4, exactly
  const double xi[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526},
               w[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  for (int i = 0; i < 64; ++i)
    exact += w[i % 4] * w[i / 4 % 4] * w[i / 16] *
             beam(half.cwiseProduct(Eigen::Vector3d(xi[i % 4], xi[i / 4 % 4], xi[i / 16]))).squaredNorm();
  exact *= test::kSteel.rho * half.prod();
  const auto energy = [&](const model::Formulation& formulation) {
    const Eigen::MatrixXd M = fem::mass_matrix(fem::cell_mass(mesh::CellType::hex8, X, test::kSteel.rho,
                                                              fem::elasticity(test::kSteel), formulation));
    return u.dot(M * u);
  };
  test::figure({"condensed mass", "kinetic energy"}, energy(kCondensed) / exact - 1, kRoundoff);
  EXPECT_GT(energy({}), 1.5 * exact);
}

TEST(CondensedMass, is_that_of_the_nodes_in_other_elements_and_cells) {
  const Eigen::Matrix3Xd X = fem::cell_coordinates(test::brick({1, 1, 1}, {1, 1, 1}), 0);
  for (model::Element element : {model::Element::plain, model::Element::bbar})
    EXPECT_FALSE(fem::cell_mass(mesh::CellType::hex8, X, 1, fem::elasticity(test::kSteel),
                                {element, model::ElementMass::condensed})
                     .has_modes());
  const auto quadratic = test::second_order(test::brick({1, 1, 1}, {1, 1, 1}));
  EXPECT_FALSE(fem::cell_mass(mesh::CellType::hex20, fem::cell_coordinates(quadratic, 0), 1,
                              fem::elasticity(test::kSteel), kCondensed)
                   .has_modes());
}

struct CondensedBody : testing::Test, Patch {
  test::System system = test::assemble(mesh, {}, PETSC_COMM_SELF, regions, kCondensed);
  Eigen::MatrixXd M = fem::gather_matrix(system.matrices.M, system.rows).toDense();
  fem::MassMoments moments = fem::mass_moments(mesh, regions, kCondensed);
};

TEST_F(CondensedBody, has_the_mass_centre_and_inertia_of_the_nodes_alone) {
  const auto condensed = fem::rigid_inertia(mesh, moments),
             nodal = fem::rigid_inertia(mesh, fem::mass_moments(mesh, regions));
  EXPECT_NEAR(condensed.m, nodal.m, kRoundoff * nodal.m);
  EXPECT_LT((condensed.c - nodal.c).norm(), kRoundoff);
  EXPECT_LT((condensed.J - nodal.J).norm(), kRoundoff * nodal.J.norm());
  const Eigen::MatrixXd R = rigid_fields(mesh.X), RMR = R.transpose() * M * R;
  EXPECT_LT((RMR.topLeftCorner(3, 3) - nodal.m * Eigen::Matrix3d::Identity()).norm(), kRoundoff * nodal.m);
  EXPECT_LT((RMR.bottomRightCorner(3, 3) - nodal.J).norm(), kRoundoff * nodal.J.norm());
}

TEST_F(CondensedBody, couples_to_rigid_motions_as_its_mass_matrix_does) {
  const Eigen::MatrixXd MR = M * rigid_fields(mesh.X);
  const Eigen::VectorXd phi = Eigen::VectorXd::Random(M.rows());
  const Eigen::Matrix3d S = fem::first_moment(moments, phi);
  EXPECT_LT((fem::translational_coupling(moments, phi) - MR.leftCols<3>().transpose() * phi).norm(),
            kRoundoff * MR.norm());
  EXPECT_LT((fem::rotational_coupling(S) - MR.rightCols<3>().transpose() * phi).norm(),
            kRoundoff * MR.norm());
  const Eigen::Vector3d t(0.3, -0.2, 0.9), w(-0.4, 0.5, 0.1);
  Eigen::VectorXd motion(6);
  motion << t, w;
  EXPECT_LT((fem::momentum(moments, t, w) - MR * motion).norm(), kRoundoff * MR.norm());
  const auto nodal = fem::mass_moments(mesh, regions);
  EXPECT_GT((fem::momentum(nodal, t, w) - MR * motion).norm(), 1e-3 * (MR * motion).norm());
}

TEST_F(CondensedBody, has_the_same_couplings_of_one_displacement_as_of_a_field) {
  for (int dof : {0, 31, 64}) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(M.rows(), dof);
    EXPECT_LT((fem::first_moment(moments, dof) - fem::first_moment(moments, unit)).norm(), kRoundoff);
    EXPECT_LT((fem::translational_coupling(moments, dof) - fem::translational_coupling(moments, unit)).norm(),
              kRoundoff);
  }
}

// The constant strains of a homogeneous body excite no incompatible mode, so that M X_a e_b is its moment.
TEST_F(CondensedBody, has_the_first_moments_of_its_mass_matrix_where_the_material_is_one) {
  for (const model::Material& material : {test::kSteel, test::kFibre}) {
    const std::vector<model::MaterialRegion> one{{"", material}};
    const auto of_one = test::assemble(mesh, {}, PETSC_COMM_SELF, one, kCondensed);
    const Eigen::MatrixXd M_1 = fem::gather_matrix(of_one.matrices.M, of_one.rows).toDense();
    const Eigen::VectorXd phi = Eigen::VectorXd::Random(M_1.rows());
    const Eigen::Matrix3d S = fem::first_moment(fem::mass_moments(mesh, one, kCondensed), phi);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        Eigen::Matrix3Xd X_a = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
        X_a.row(b) = mesh.X.row(a);
        EXPECT_NEAR(S(a, b), X_a.reshaped().dot(M_1 * phi), kRoundoff * M_1.norm()) << a << b;
      }
  }
}

TEST_F(CondensedBody, has_moments_that_follow_the_origin) {
  const Eigen::Vector3d origin(0.3, -0.7, 2);
  mesh::Mesh moved = mesh;
  moved.X.colwise() -= origin;
  std::vector<model::MaterialRegion> there = regions;
  for (auto& region : there)
    if (region.material.orthotropic) region.material.orthotropic->orientation.origin -= origin;
  fem::move_origin(moments, origin);
  const auto expected = fem::mass_moments(moved, there, kCondensed);
  EXPECT_LT((moments.w_1 - expected.w_1).norm(), kRoundoff * expected.w_1.norm());
  EXPECT_LT((moments.modes - expected.modes).norm(), kRoundoff * expected.modes.norm());
}

TEST_F(CondensedBody, has_a_mass_between_fields_that_makes_its_mass_matrix) {
  const fem::FieldMass mass = fem::field_mass(mesh, regions, kCondensed);
  const int n = mesh.n_nodes();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  const Eigen::MatrixXd T = mass.T.toDense();
  for (int a = 0; a < 3; ++a) {
    Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(mass.M_s.rows(), 3 * n);
    for (int i = 0; i < n; ++i) fields(i, 3 * i + a) = 1;
    for (Eigen::Index k = 0; k < T.rows() / 3; ++k) fields.row(n + k) = T.row(3 * k + a);
    sum += fields.transpose() * mass.M_s.toDense() * fields;
  }
  EXPECT_LT((sum - M).norm(), kRoundoff * M.norm());
}

}  // namespace
}  // namespace elastogear::cell_mass_test
