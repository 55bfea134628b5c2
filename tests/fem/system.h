#pragma once
// K and M of a small body on the ranks of the test, split into slabs along the numbering of cells.

#include "brick.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/restraint.h"

namespace elastogear::test {

struct System {
  fem::RowNumbering rows;
  fem::Matrices matrices;
};

inline System assemble(const mesh::Mesh& mesh, const std::vector<std::string>& restrained,
                       MPI_Comm comm = PETSC_COMM_WORLD,
                       const std::vector<model::MaterialRegion>& regions = kSteelBody,
                       const model::Formulation& formulation = {}) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  std::vector<int> part;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) part.push_back(cell * size / mesh.cells.size());
  System system;
  system.rows = fem::number_rows(mesh, fem::free_nodes(mesh, restrained), part, size);
  const auto share = fem::distribute(comm, mesh, fem::cell_regions(mesh, regions), system.rows);
  system.matrices = fem::assemble(comm, share, regions, formulation);
  return system;
}

}  // namespace elastogear::test
