#include "elastogear/fem/assembly.h"

#include <algorithm>

#include "elastogear/base/sort_unique.h"
#include "elastogear/fem/element.h"
#include "fem/elements/cell_mass.h"
#include "fem/spd_matrix.h"

namespace elastogear::fem {
namespace {

// Per owned block row the cells at its node.
std::vector<std::vector<int>> cells_of_rows(const MeshPart& part) {
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(part.row_end - part.row_begin));
  for (int cell = 0; cell < part.mesh.cells.size(); ++cell)
    for (int node : part.mesh.cells[cell]) {
      const int row = part.row[node];
      if (row >= part.row_begin && row < part.row_end) cells[row - part.row_begin].push_back(cell);
    }
  return cells;
}

BlockCounts count_blocks(const MeshPart& part) {
  BlockCounts counts;
  std::vector<int> columns;
  for (const auto& cells : cells_of_rows(part)) {
    columns.clear();
    for (int cell : cells)
      for (int node : part.mesh.cells[cell])
        if (part.row[node] >= 0) columns.push_back(part.row[node]);
    sort_unique(columns);
    const auto mine = std::lower_bound(columns.begin(), columns.end(), part.row_end) -
                      std::lower_bound(columns.begin(), columns.end(), part.row_begin);
    counts.diagonal.push_back(static_cast<PetscInt>(mine));
    counts.other.push_back(static_cast<PetscInt>(columns.size()) - counts.diagonal.back());
  }
  return counts;
}

// Block columns of a cell, and its block rows with those of other ranks masked by -1 (PETSc skips them).
struct CellRows {
  std::vector<PetscInt> row, column;
};

void find_rows(const MeshPart& part, int cell, CellRows& rows) {
  rows.row.clear();
  rows.column.clear();
  for (int node : part.mesh.cells[cell]) {
    const PetscInt column = part.row[node];
    rows.column.push_back(column);
    rows.row.push_back(column >= part.row_begin && column < part.row_end ? column : -1);
  }
}

// Both matrices are symmetric, so that Eigen's column order serves as PETSc's row order.
void add(Mat A, const CellRows& rows, const Eigen::MatrixXd& A_e) {
  const auto n = static_cast<PetscInt>(rows.row.size());
  check(MatSetValuesBlocked(A, n, rows.row.data(), n, rows.column.data(), A_e.data(), ADD_VALUES));
}

}  // namespace

Matrices assemble(MPI_Comm comm, const MeshPart& part, const std::vector<model::MaterialRegion>& regions,
                  const model::Formulation& formulation, const Progress& progress) {
  constexpr int kReportEvery = 4096;
  const BlockCounts counts = count_blocks(part);
  Matrices matrices{create_spd_matrix(comm, 3, counts), create_spd_matrix(comm, 3, counts)};
  const int n_cells = part.mesh.cells.size();
  std::vector<CellModuli> moduli;
  for (const auto& region : regions) moduli.emplace_back(region.material);
  CellRows rows;
  for (int cell = 0; cell < n_cells; ++cell) {
    if (cell % kReportEvery == 0) report(progress, "assembly", static_cast<double>(cell) / n_cells);
    const ElementFunctions& functions = element_functions(part.mesh.cells.type[cell]);
    const int region = part.region[cell];
    const Eigen::Matrix3Xd X = cell_coordinates(part.mesh, cell);
    find_rows(part, cell, rows);
    add(matrices.K, rows, cell_stiffness(functions, X, moduli[region], formulation.element));
    add(matrices.M, rows,
        mass_matrix(cell_mass(part.mesh.cells.type[cell], X, regions[region].material.rho,
                              moduli[region].elastic, formulation)));
  }
  finish_assembly(matrices.K);
  finish_assembly(matrices.M);
  report(progress, "assembly", 1);
  return matrices;
}

}  // namespace elastogear::fem
