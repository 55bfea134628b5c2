#pragma once
// A volume mesh with named sets. Plain data; SI units (m).

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace elastogear::mesh {

/// Cell types; node order as in Abaqus (hex8: bottom 0-3 counter-clockwise seen from above, top 4-7).
enum class CellType : std::uint8_t { hex8 };

/// Number of nodes of a cell type.
int node_count(CellType type);

/// Four node numbers, counter-clockwise seen from outside the body; a triangle repeats its third node.
using Face = std::array<int, 4>;

/// Cells in compressed rows: cell i has nodes[offset[i]] .. nodes[offset[i+1]-1].
struct Cells {
  std::vector<CellType> type;
  std::vector<int> offset{0};
  std::vector<int> nodes;

  int size() const { return static_cast<int>(type.size()); }
  std::span<const int> operator[](int i) const {
    return {nodes.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
  void add(CellType t, std::span<const int> cell_nodes);
};

/// Numbers are 0-based; files may number otherwise. Sets are sorted and free of duplicates (faces: in order).
struct Mesh {
  Eigen::Matrix3Xd X;  ///< 3 x n_nodes, m, reference positions in the body frame
  Cells cells;
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<int>> cell_sets;
  std::map<std::string, std::vector<Face>> face_sets;

  int n_nodes() const { return static_cast<int>(X.cols()); }
};

/// The cell's faces, outward, in the numbering of Abaqus (S1..S6).
std::vector<Face> cell_faces(CellType type, std::span<const int> cell_nodes);

/// Faces that belong to one cell only, outward, in cell order; `cell` receives the cell of each when given.
std::vector<Face> boundary_faces(const Mesh& mesh, std::vector<int>* cell = nullptr);

/// Throws Error (naming `source`) for node numbers out of range, non-finite coordinates, sets with unknown
/// members, cells that repeat a node, faces that are no face of a cell.
void validate(const Mesh& mesh, const std::string& source);

/// Named set or Error listing the sets that exist.
const std::vector<int>& node_set(const Mesh& mesh, const std::string& name);
const std::vector<int>& cell_set(const Mesh& mesh, const std::string& name);
const std::vector<Face>& face_set(const Mesh& mesh, const std::string& name);

}  // namespace elastogear::mesh
