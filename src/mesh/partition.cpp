#include "elastogear/mesh/partition.h"

#include <metis.h>

#include "elastogear/base/error.h"

namespace elastogear::mesh {
namespace {

static_assert(sizeof(idx_t) == sizeof(int), "METIS must be built with 32-bit indices");
constexpr idx_t kSeed = 1;
// Hexahedra that share a face share four nodes.
constexpr idx_t kCommonNodes = 4;

}  // namespace

Partition partition_cells(const Mesh& mesh, int n_parts) {
  require(n_parts >= 1 && n_parts <= mesh.cells.size(), "cannot split ", mesh.cells.size(), " cells into ",
          n_parts, " parts, allowed are 1..", mesh.cells.size());
  Partition result;
  result.part.assign(mesh.cells.size(), 0);
  if (n_parts == 1) return result;
  idx_t n_cells = mesh.cells.size(), n_nodes = mesh.n_nodes(), parts = n_parts, common = kCommonNodes;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = kSeed;
  options[METIS_OPTION_PTYPE] = METIS_PTYPE_RB;  // better balanced than k-way for few parts
  // METIS takes non-const pointers and does not write to them.
  auto* offset = const_cast<idx_t*>(mesh.cells.offset.data());
  auto* nodes = const_cast<idx_t*>(mesh.cells.nodes.data());
  std::vector<idx_t> node_part(n_nodes);
  const int status =
      METIS_PartMeshDual(&n_cells, &n_nodes, offset, nodes, nullptr, nullptr, &common, &parts, nullptr,
                         options, &result.edge_cut, result.part.data(), node_part.data());
  require(status == METIS_OK, "METIS could not split ", n_cells, " cells into ", n_parts, " parts (status ",
          status, ")");
  return result;
}

}  // namespace elastogear::mesh
