// Uses an installed elastogear as any other program would: prints the version and a mesh's boundary.
#include <cstdio>

#include "elastogear/base/petsc.h"
#include "elastogear/base/version.h"
#include "elastogear/mesh/mesh.h"

int main(int argc, char** argv) {
  const elastogear::Session session(argc, argv);
  elastogear::mesh::Mesh cube;
  cube.X.resize(3, 8);
  cube.X << 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
  const int nodes[] = {0, 1, 2, 3, 4, 5, 6, 7};
  cube.cells.add(elastogear::mesh::CellType::hex8, nodes);
  validate(cube, "cube");
  const std::size_t n_faces = boundary_faces(cube).size();
  std::printf("elastogear %s: a cube has %zu faces\n", elastogear::version(), n_faces);
  return n_faces == 6 ? 0 : 1;
}
