#include "elastogear/fem/sector_assembly.h"

#include <algorithm>

#include "elastogear/base/sort_unique.h"
#include "elastogear/fem/element.h"
#include "fem/elements/cell_mass.h"
#include "fem/spd_matrix.h"

namespace elastogear::fem {
namespace {

using Eigen::MatrixXd;

struct Rows {
  int begin, end;     // orbits whose rows this rank owns
  BlockCounts count;  // of single entries
};

// Neighbours of the orbits that this rank owns.
std::vector<std::vector<int>> neighbours(const Sector& sector, int begin, int end) {
  std::vector<std::vector<int>> near(static_cast<std::size_t>(end - begin));
  for (int cell = 0; cell < sector.mesh.cells.size(); ++cell)
    for (int a : sector.mesh.cells[cell]) {
      const int row = sector.node_orbits.orbit[a];
      if (row < begin || row >= end) continue;
      for (int b : sector.mesh.cells[cell])
        if (sector.node_orbits.orbit[b] >= 0) near[row - begin].push_back(sector.node_orbits.orbit[b]);
    }
  for (auto& orbits : near) sort_unique(orbits);
  return near;
}

Rows count_entries(MPI_Comm comm, const Sector& sector, const Harmonic& harmonic) {
  const auto [begin, end] = own_orbits(comm, sector);
  Rows rows{begin, end, {}};
  const auto width = [&](std::size_t orbit) { return harmonic.first[orbit + 1] - harmonic.first[orbit]; };
  int orbit = begin;
  for (const auto& near : neighbours(sector, begin, end)) {
    PetscInt own = 0, all = 0;
    for (int other : near) {
      all += width(other);
      if (other >= begin && other < end) own += width(other);
    }
    rows.count.diagonal.insert(rows.count.diagonal.end(), width(orbit), own);
    rows.count.other.insert(rows.count.other.end(), width(orbit++), all - own);
  }
  return rows;
}

// Q of a cell: displacements of its nodes from the coordinates of their orbits, and where these are.
struct CellBasis {
  std::vector<const MatrixXd*> Q;     // of each node; nullptr: restrained
  std::vector<int> sector_index;      // of each node; -1: on the axis
  std::vector<PetscInt> row, column;  // of each coordinate; rows of other ranks are -1 (PETSc skips them)
};

CellBasis cell_basis(const Sector& sector, const Harmonic& harmonic, const Rows& rows, int cell) {
  CellBasis basis;
  for (int node : sector.mesh.cells[cell]) {
    const int orbit = sector.node_orbits.orbit[node];
    basis.Q.push_back(orbit < 0 ? nullptr
                                : &harmonic.at(sector.on_axis[orbit], sector.node_orbits.sector_index[node]));
    basis.sector_index.push_back(orbit >= 0 && sector.on_axis[orbit] ? -1
                                                                     : sector.node_orbits.sector_index[node]);
    if (orbit < 0) continue;
    for (int i = harmonic.first[orbit]; i < harmonic.first[orbit + std::size_t{1}]; ++i) {
      basis.column.push_back(i);
      basis.row.push_back(orbit >= rows.begin && orbit < rows.end ? i : -1);
    }
  }
  return basis;
}

// Q_a' (A_ab for Re u and for Im u) Q_b for the 3 x 3 block of nodes a and b. docs/theory, Eq. (2.13).
MatrixXd projected(const MatrixXd& Q_a, const Eigen::Matrix3d& A_ab, const MatrixXd& Q_b) {
  MatrixXd A_Q(Q_b.rows(), Q_b.cols());
  for (Eigen::Index part = 0; part < Q_b.rows(); part += 3)
    A_Q.middleRows<3>(part).noalias() = A_ab * Q_b.middleRows<3>(part);
  return Q_a.transpose() * A_Q;
}

// Q_a' Q_b; off the axis exactly the identity for nodes that are turned alike, so that zeros in M are exact.
MatrixXd overlap(const Harmonic& harmonic, const CellBasis& basis, std::size_t a, std::size_t b) {
  if (basis.sector_index[a] < 0 || basis.sector_index[b] < 0) return basis.Q[a]->transpose() * *basis.Q[b];
  return harmonic
      .turned[(basis.sector_index[b] - basis.sector_index[a] + harmonic.n_sectors) % harmonic.n_sectors];
}

// The cell's matrix over the harmonic's coordinates. block(a, b): of its nodes.
template <class Block>
MatrixXd project(const CellBasis& basis, const Block& block) {
  const auto n = static_cast<Eigen::Index>(basis.column.size());
  MatrixXd A(n, n);
  Eigen::Index column = 0;
  for (std::size_t b = 0; b < basis.Q.size(); ++b) {
    Eigen::Index row = 0;
    for (std::size_t a = 0; basis.Q[b] && a < basis.Q.size(); ++a) {
      if (!basis.Q[a]) continue;
      const MatrixXd entries = block(a, b);
      A.block(row, column, entries.rows(), entries.cols()) = entries;
      row += entries.rows();
    }
    if (basis.Q[b]) column += basis.Q[b]->cols();
  }
  return A;
}

// The cell's matrix A_e, 3 n_nodes square, over the harmonic's coordinates.
MatrixXd project_blocks(const CellBasis& basis, const MatrixXd& A_e) {
  return project(basis, [&](std::size_t a, std::size_t b) {
    const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
    return projected(*basis.Q[a], A_e.block<3, 3>(3 * i, 3 * j), *basis.Q[b]);
  });
}

// Projection of the matrix M_s (x) I_3 of a cell on a harmonic.
MatrixXd project_scalar(const Harmonic& harmonic, const CellBasis& basis, const MatrixXd& M_s) {
  return project(basis, [&](std::size_t a, std::size_t b) -> MatrixXd {
    return M_s(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) * overlap(harmonic, basis, a, b);
  });
}

// Symmetric, so that Eigen's column order serves as PETSc's row order.
void add(Mat A, const CellBasis& basis, const MatrixXd& A_e) {
  const auto n = static_cast<PetscInt>(basis.row.size());
  check(MatSetValues(A, n, basis.row.data(), n, basis.column.data(), A_e.data(), ADD_VALUES));
}

// Calls f(cell, basis) for cells of which this rank owns rows.
template <class F>
void visit_own_cells(const Sector& sector, const Harmonic& harmonic, const Rows& rows, F&& f) {
  for (int cell = 0; cell < sector.mesh.cells.size(); ++cell) {
    const CellBasis basis = cell_basis(sector, harmonic, rows, cell);
    if (std::any_of(basis.row.begin(), basis.row.end(), [](PetscInt row) { return row >= 0; }))
      f(cell, basis);
  }
}

struct Problem {
  const Sector& sector;
  const Harmonic& harmonic;
  const std::vector<model::MaterialRegion>& regions;
  const model::Formulation& formulation;
};

MatrixXd projected_mass(const Problem& of, int cell, const CellModuli& moduli, const CellBasis& basis) {
  const Sector& sector = of.sector;
  CellMass mass = cell_mass(sector.mesh.cells.type[cell], cell_coordinates(sector.mesh, cell),
                            of.regions[sector.region[cell]].material.rho, moduli.elastic, of.formulation);
  mass.scalar *= sector.weight[cell];
  return mass.has_modes() ? project_blocks(basis, mass_matrix(mass))
                          : project_scalar(of.harmonic, basis, mass.scalar);
}

}  // namespace

std::pair<int, int> own_orbits(MPI_Comm comm, const Sector& sector) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const auto begin = [&](long r) { return static_cast<int>(r * sector.n_orbits() / size); };
  return {begin(rank), begin(rank + 1)};
}

Matrices assemble(MPI_Comm comm, const Sector& sector, const Harmonic& harmonic,
                  const std::vector<model::MaterialRegion>& regions, const model::Formulation& formulation) {
  const Rows rows = count_entries(comm, sector, harmonic);
  Matrices matrices{create_spd_matrix(comm, 1, rows.count), create_spd_matrix(comm, 1, rows.count)};
  visit_own_cells(sector, harmonic, rows, [&](int cell, const CellBasis& basis) {
    const ElementFunctions& functions = element_functions(sector.mesh.cells.type[cell]);
    const CellModuli moduli(regions[sector.region[cell]].material);
    const MatrixXd K_e = sector.weight[cell] * cell_stiffness(functions, cell_coordinates(sector.mesh, cell),
                                                              moduli, formulation.element);
    add(matrices.K, basis, project_blocks(basis, K_e));
    add(matrices.M, basis, projected_mass({sector, harmonic, regions, formulation}, cell, moduli, basis));
  });
  finish_assembly(matrices.K);
  finish_assembly(matrices.M);
  return matrices;
}

UniqueMat assemble_mass(MPI_Comm comm, const Sector& sector, const Harmonic& harmonic,
                        const std::vector<model::MaterialRegion>& regions,
                        const model::Formulation& formulation) {
  const Rows rows = count_entries(comm, sector, harmonic);
  UniqueMat M = create_spd_matrix(comm, 1, rows.count);
  visit_own_cells(sector, harmonic, rows, [&](int cell, const CellBasis& basis) {
    const CellModuli moduli(regions[sector.region[cell]].material);
    add(M, basis, projected_mass({sector, harmonic, regions, formulation}, cell, moduli, basis));
  });
  finish_assembly(M);
  return M;
}

}  // namespace elastogear::fem
