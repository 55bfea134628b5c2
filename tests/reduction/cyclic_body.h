#pragma once
// Modes by cyclic symmetry beside those of the whole body.

#include <gtest/gtest.h>

#include <Eigen/SparseCore>

#include "../fem/system.h"
#include "reduction/cyclic/cyclic.h"

namespace elastogear::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

inline constexpr double kFrequency = 1e-8;      // relative, against the general path
inline constexpr double kOrthogonality = 1e-8;  // of both paths
inline constexpr double kSubspace = 1e-8;       // squared sine to the general path's eigenspace
inline constexpr double kResidual = 1e-6;       // of the general path's windows
inline constexpr int kMore = 8;  // modes of the general path above the last, to complete a group

struct Body {
  mesh::Mesh mesh;
  std::vector<std::string> restrained;
  std::vector<model::MaterialRegion> regions = kSteelBody;
  int Z = 1;
};

struct Solution {
  reduction::Eigenmodes modes;
  MatrixXd phi;  // 3 n_nodes x n_modes, on rank 0
};

inline int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

inline Solution solve_cyclic(MPI_Comm comm, const Body& body, int n_modes,
                             reduction::CyclicOptions options = {}) {
  const bool first = rank_of(comm) == 0;
  const mesh::Mesh none, &mesh = first ? body.mesh : none;
  std::vector<int> region;
  std::vector<bool> is_free;
  mesh::Repetition repetition;
  if (first) {
    region = fem::cell_regions(mesh, body.regions);
    is_free = fem::free_nodes(mesh, body.restrained);
    auto [found, reason] = mesh::find_repetition(mesh, {region, is_free});
    EXPECT_TRUE(found) << reason;
    repetition = *found;
    EXPECT_EQ(repetition.turn.n_sectors, body.Z);
  }
  Solution solution;
  if (first) solution.phi.resize(3 * mesh.n_nodes(), n_modes);
  int next = 0;
  const auto keep = [&](int i, const VectorXd& phi) {
    EXPECT_EQ(i, next++);
    if (first) solution.phi.col(i) = phi;
  };
  options.eigen.n_modes = n_modes;
  solution.modes = reduction::find_cyclic_eigenmodes(
      comm, {{mesh, body.regions, region, is_free, model::Element::incompatible}, repetition}, options, keep);
  EXPECT_EQ(next, n_modes);
  return solution;
}

struct Reference {
  VectorXd eigenvalue;
  MatrixXd M_phi;                 // 3 n_nodes x modes, 0 where restrained
  Eigen::SparseMatrix<double> M;  // over the free displacements
  std::vector<int> free_dof;
};

// Serial, by windows on the whole body.
inline Reference solve_general(const Body& body, int n_modes) {
  const auto system = assemble(body.mesh, body.restrained, PETSC_COMM_SELF, body.regions);
  const auto& [K, M] = system.matrices;
  Reference reference;
  reference.free_dof = fem::free_dofs(fem::held_directions(body.mesh, body.restrained));
  n_modes = std::min(n_modes + kMore, static_cast<int>(reference.free_dof.size()));
  reference.M = fem::gather_matrix(M, system.rows);
  reference.M_phi = MatrixXd::Zero(3 * body.mesh.n_nodes(), n_modes);
  UniqueVec layout;
  check(MatCreateVecs(K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.rows);
  const auto keep = [&](int i, Vec v) {
    const VectorXd phi = gather(v)(reference.free_dof);
    reference.M_phi(reference.free_dof, i) = reference.M * phi;
  };
  reference.eigenvalue =
      reduction::find_eigenmodes(K, M, {.n_modes = n_modes, .window = 400}, keep).eigenvalue;
  return reference;
}

// Frequencies, orthonormality, and each mode within the reference's eigenspace of its eigenvalue.
inline void expect_equal(const Solution& cyclic, const Reference& reference) {
  const auto n = cyclic.modes.eigenvalue.size();
  for (Eigen::Index i = 0; i < n; ++i)
    EXPECT_NEAR(std::sqrt(cyclic.modes.eigenvalue(i) / reference.eigenvalue(i)), 1, kFrequency) << i;
  EXPECT_LT(cyclic.modes.residual.maxCoeff(), kResidual);
  const MatrixXd free = cyclic.phi(reference.free_dof, Eigen::all);
  EXPECT_EQ((free.array() != 0).count(), (cyclic.phi.array() != 0).count()) << "restrained nodes move";
  const MatrixXd gram = free.transpose() * (reference.M * free);
  EXPECT_LT((gram - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), kOrthogonality);
  const MatrixXd share = (reference.M_phi.transpose() * cyclic.phi).cwiseAbs2();
  for (Eigen::Index i = 0; i < n; ++i) {
    double inside = 0;
    for (Eigen::Index j = 0; j < share.rows(); ++j)
      if (std::abs(reference.eigenvalue(j) / cyclic.modes.eigenvalue(i) - 1) < 1e-5) inside += share(j, i);
    EXPECT_NEAR(inside, 1, kSubspace) << i;
  }
}

inline void expect_equals_the_general_path(const Body& body, int n_modes) {
  const Solution cyclic = solve_cyclic(PETSC_COMM_WORLD, body, n_modes);
  if (rank_of(PETSC_COMM_WORLD) == 0) expect_equal(cyclic, solve_general(body, n_modes));
}

}  // namespace elastogear::test
