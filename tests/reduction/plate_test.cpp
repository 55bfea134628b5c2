// NAFEMS FV52 (Abbassi, Dawswell, Knowles: Selected Benchmarks for Natural Frequency Analysis, R0015): a
// solid square plate that is held in the direction of its normal along the lower edges alone.
#include <gtest/gtest.h>

#include <iostream>

#include "../fem/other_cells.h"
#include "../fem/system.h"
#include "../figures.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::plate_test {
namespace {

using mesh::CellType;

constexpr double kLength = 10, kThickness = 1;  // m
const model::Material kPlate{200e9, 0.3, 8000};
constexpr double kDigits = 1e-4;  // of the published ratios
constexpr int kRigid = 3;         // in-plane motions, which nothing holds
// Hz, of the plate theory of Mindlin, simply supported: a solid held at its lower edges is another problem,
// which shows in the first mode.
constexpr double kTarget[7] = {45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19};

mesh::Mesh plate(CellType type, const std::array<int, 3>& n) {
  return test::cells_of(type, test::brick(n, {kLength, kLength, kThickness}));
}

bool at_lower_edge(const Eigen::Vector3d& X) {
  constexpr double kSame = 1e-9;
  const auto at_end = [](double x) { return std::min(std::abs(x), std::abs(x - kLength)) < kSame; };
  return std::abs(X.z()) < kSame && (at_end(X.x()) || at_end(X.y()));
}

// Rows of all displacements but u_z along the lower edges.
UniqueIS unsupported(const mesh::Mesh& mesh, const fem::RowNumbering& rows) {
  std::vector<PetscInt> kept;
  for (int row = 0; row < mesh.n_nodes(); ++row)
    for (int d = 0; d < 3; ++d)
      if (d != 2 || !at_lower_edge(mesh.X.col(rows.node[row]))) kept.push_back(3 * row + d);
  UniqueIS is;
  check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(kept.size()), kept.data(), PETSC_COPY_VALUES,
                        is.out()));
  return is;
}

// Frequencies in Hz. K + shift M in place of K, which is singular.
Eigen::VectorXd frequencies(const mesh::Mesh& mesh, int n) {
  const double shift = std::pow(2 * M_PI * kTarget[0], 2);
  const auto system = test::assemble(mesh, {}, PETSC_COMM_SELF, {{"", kPlate}});
  const UniqueIS kept = unsupported(mesh, system.rows);
  UniqueMat K, M;
  check(MatCreateSubMatrix(system.matrices.K, kept, kept, MAT_INITIAL_MATRIX, K.out()));
  check(MatCreateSubMatrix(system.matrices.M, kept, kept, MAT_INITIAL_MATRIX, M.out()));
  check(MatAXPY(K, shift, M, SAME_NONZERO_PATTERN));
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  reduction::EigenOptions options;
  options.n_modes = n;
  const auto ignore = [](int, Vec) {};
  const Eigen::ArrayXd eigenvalue = reduction::find_eigenmodes(K, M, options, ignore).eigenvalue;
  return (eigenvalue - shift).max(0).sqrt() / (2 * M_PI);
}

struct Case {
  CellType type;
  std::array<int, 3> n;
  double published[7];  // f / target: Altair OptiStruct, verification problem OS-V 0455, HEXA20 and HEXA8
};

class Plate : public testing::TestWithParam<Case> {};

TEST_P(Plate, has_the_published_frequencies_of_fv52) {
  const auto& [type, n, published] = GetParam();
  const Eigen::VectorXd f = frequencies(plate(type, n), kRigid + 7);
  for (int i = 0; i < kRigid; ++i) EXPECT_LT(f(i), 1e-3 * kTarget[0]);
  for (int i = 0; i < 7; ++i) {
    const double ratio = f(kRigid + i) / kTarget[i];
    std::cout << mesh::name(type) << " " << f(kRigid + i) << " Hz, f/target " << ratio << "\n";
    test::figure({"plate", "7 frequencies"}, ratio - published[i], kDigits);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cells, Plate,
    testing::Values(
        Case{CellType::hex20, {4, 4, 1}, {0.9760, 1.0101, 1.0101, 1.0072, 1.0017, 1.0022, 1.0022}},
        Case{CellType::hex8, {8, 8, 3}, {0.9874, 1.0413, 1.0413, 1.0322, 1.0164, 1.0164, 1.0164}}),
    [](const auto& info) { return mesh::name(info.param.type); });

}  // namespace
}  // namespace elastogear::plate_test
