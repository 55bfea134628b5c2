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

/// Cell types; node order as in Abaqus (hex8: bottom 0-3 counter-clockwise seen from above, top 4-7; wedges
/// and pyramids likewise; the second-order cells' midside nodes after the corners, in the order of edges()).
enum class CellType : std::uint8_t { hex8, hex20, tet4, tet10, wedge6, wedge15, pyramid5 };
inline constexpr int kCellTypes = 7;

/// "hex8", ...
const char* name(CellType type);

/// Number of nodes of a cell type, and of those at corners (the first ones).
int node_count(CellType type);
int corner_count(CellType type);

/// Corners of the edges; on second-order cells node corner_count + i is the midside node of edge i.
std::span<const std::array<int, 2>> edges(CellType type);

/// Four node numbers, counter-clockwise seen from outside the body; a triangle repeats its third node.
using Face = std::array<int, 4>;

/// Key that is equal for all faces with these nodes, whatever their direction and first node. It is not
/// itself a face.
Face face_key(Face face);
/// Returns whether both faces have the same nodes in the same cyclic order.
bool same_direction(const Face& a, Face b);

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
  std::vector<std::int64_t> node_number, cell_number;  ///< those of the mesh's file, for messages; or empty

  int n_nodes() const { return static_cast<int>(X.cols()); }
};

/// "node 4711", "cell 500011" by the number of the mesh's file, or "node 16 (counted from 0)".
std::string node_text(const Mesh& mesh, int node);
std::string cell_text(const Mesh& mesh, int cell);
/// "node 10, node 11, node 12, node 13"; the node that a triangle repeats once.
std::string face_text(const Mesh& mesh, const Face& face);

/// The cell's sides in the numbering of Abaqus (S1..S6), each as faces that point outward. A side of a linear
/// cell is one face. A side of a second-order cell is cut so that all its nodes take part and both of its
/// cells cut it alike: a triangle at each corner, and the triangle or quadrilateral of the midside nodes.
std::vector<std::vector<Face>> cell_sides(CellType type, std::span<const int> cell_nodes);

/// The nodes of the sides in the same order: corners, then the midside nodes, the first between corners 0 and
/// 1.
std::vector<std::vector<int>> cell_side_nodes(CellType type, std::span<const int> cell_nodes);

/// The faces of all sides, in order.
std::vector<Face> cell_faces(CellType type, std::span<const int> cell_nodes);

/// The faces that a side with these nodes is cut into: 3 or 4 corners in order, then as many midside nodes
/// (the first between corners 0 and 1) or none.
std::vector<Face> side_faces(std::span<const int> side_nodes);

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
