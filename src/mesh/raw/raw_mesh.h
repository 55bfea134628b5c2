#pragma once
// Nodes and cells as a mesh file has them, in its own numbers ("tags"), and how they get ours.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "mesh/raw/tag_table.h"

namespace elastogear::mesh {

using Tag = std::int64_t;

struct RawMesh {
  std::vector<Tag> node;
  std::vector<double> X;  ///< 3 per node, unit of the file
  std::vector<Tag> cell;
  std::vector<CellType> cell_type;
  std::vector<std::size_t> cell_offset{0};
  std::vector<Tag> cell_node;  ///< cell i: cell_offset[i] .. cell_offset[i + 1], our order within a cell

  void add_cell(CellType type, Tag tag, std::span<const Tag> nodes);
};

/// A mesh without sets, and which tag got which number.
struct NumberedMesh {
  TagTable nodes, cells;
  Mesh mesh;
};

/// Nodes and cells in the ascending order of their tags, coordinates times `unit_in_m`. Error naming `source`
/// and the file's word for a cell ("element") for repeated or unknown tags and for a mesh without cells.
NumberedMesh number(const RawMesh& raw, const std::string& source, const std::string& cell_word,
                    double unit_in_m);

/// How many members all sets of a file may have together. A few bytes can put a whole mesh into one more set,
/// so that without a limit a small file would ask for any amount of memory.
class MemberBudget {
 public:
  MemberBudget(std::string source, std::size_t file_size);
  /// Error when the file's sets have more members than a file of its size should.
  void spend(std::size_t members);

 private:
  std::string source_;
  std::size_t file_size_, left_;
};

}  // namespace elastogear::mesh
