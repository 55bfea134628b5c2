#include "mesh/raw/raw_mesh.h"

#include <limits>

#include "elastogear/base/error.h"

namespace elastogear::mesh {
namespace {

// A node, cell or face takes at least ten bytes in a file; each may be in more than a hundred sets.
constexpr std::size_t kMembersPerByte = 16;

}  // namespace

void RawMesh::add_cell(CellType type, Tag tag, std::span<const Tag> nodes) {
  cell.push_back(tag);
  cell_type.push_back(type);
  cell_node.insert(cell_node.end(), nodes.begin(), nodes.end());
  cell_offset.push_back(cell_node.size());
}

NumberedMesh number(const RawMesh& raw, const std::string& source, const std::string& cell_word,
                    double unit_in_m) {
  NumberedMesh result{TagTable(raw.node, "node", source), TagTable(raw.cell, cell_word, source), {}};
  const auto& [nodes, cells, _] = result;
  Mesh& mesh = result.mesh;
  require(cells.size() > 0, source, ": the mesh has no solid ", cell_word, "s");
  require(raw.cell_node.size() <= std::numeric_limits<int>::max(), source, ": too many ", cell_word,
          "s: ", cells.size());
  mesh.node_number = nodes.tags();
  mesh.cell_number = cells.tags();
  mesh.X.resize(3, nodes.size());
  for (int i = 0; i < nodes.size(); ++i)
    mesh.X.col(i) = unit_in_m * Eigen::Map<const Eigen::Vector3d>(&raw.X[3 * nodes.position(i)]);
  std::vector<int> cell_nodes;
  for (int i = 0; i < cells.size(); ++i) {
    const int at = cells.position(i);
    cell_nodes.clear();
    for (std::size_t k = raw.cell_offset[at]; k < raw.cell_offset[at + 1]; ++k)
      cell_nodes.push_back(
          nodes.at(raw.cell_node[k], [&] { return cell_word + " " + std::to_string(raw.cell[at]); }));
    mesh.cells.add(raw.cell_type[at], cell_nodes);
  }
  return result;
}

MemberBudget::MemberBudget(std::string source, std::size_t file_size)
    : source_(std::move(source)), file_size_(file_size), left_(kMembersPerByte * file_size) {}

void MemberBudget::spend(std::size_t members) {
  require(members <= left_, source_, ": the sets of the mesh have more than ", kMembersPerByte * file_size_,
          " members, ", kMembersPerByte, " for each byte of the file: no sensible mesh has as many");
  left_ -= members;
}

}  // namespace elastogear::mesh
