#include "elastogear/mesh/partition.h"

#include <metis.h>

#include <algorithm>

#include "elastogear/base/error.h"

namespace elastogear::mesh {
namespace {

static_assert(sizeof(idx_t) == sizeof(int), "METIS must be built with 32-bit indices");
constexpr idx_t kSeed = 1;

// The cells' corners in compressed rows. Midside nodes are left out: with them, cells that share only an edge
// would have as many nodes in common as tetrahedra that share a face.
struct CornerRows {
  std::vector<idx_t> offset{0}, nodes;
};

CornerRows corners(const Cells& cells) {
  CornerRows result;
  for (int i = 0; i < cells.size(); ++i) {
    const auto corner = cells[i].first(corner_count(cells.type[i]));
    result.nodes.insert(result.nodes.end(), corner.begin(), corner.end());
    result.offset.push_back(static_cast<idx_t>(result.nodes.size()));
  }
  return result;
}

// The fewest corners that two cells with a common side share.
idx_t common_corners(const Cells& cells) {
  const auto is_hexahedron = [](CellType type) { return corner_count(type) == 8; };
  return std::all_of(cells.type.begin(), cells.type.end(), is_hexahedron) ? 4 : 3;
}

}  // namespace

Partition partition_cells(const Mesh& mesh, int n_parts) {
  require(n_parts >= 1 && n_parts <= mesh.cells.size(), "cannot split ", mesh.cells.size(), " cells into ",
          n_parts, " parts, allowed are 1..", mesh.cells.size());
  Partition result;
  result.part.assign(mesh.cells.size(), 0);
  if (n_parts == 1) return result;
  idx_t n_cells = mesh.cells.size(), n_nodes = mesh.n_nodes(), parts = n_parts,
        common = common_corners(mesh.cells);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = kSeed;
  options[METIS_OPTION_PTYPE] = METIS_PTYPE_RB;  // better balanced than k-way for few parts
  CornerRows corner = corners(mesh.cells);
  std::vector<idx_t> node_part(n_nodes);
  const int status = METIS_PartMeshDual(&n_cells, &n_nodes, corner.offset.data(), corner.nodes.data(),
                                        nullptr, nullptr, &common, &parts, nullptr, options, &result.edge_cut,
                                        result.part.data(), node_part.data());
  require(status == METIS_OK, "METIS could not split ", n_cells, " cells into ", n_parts, " parts (status ",
          status, ")");
  return result;
}

}  // namespace elastogear::mesh
