#include "gear/assembly.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::gear {
namespace {
constexpr int kMaxCount = 1000;    // of one kind of elements
constexpr double kMaxCells = 2e7;  // far above any use, far below the range of int
constexpr double kLeastQuality = 0.25;
}  // namespace

std::vector<mesh::Face> add_hex(mesh::Mesh& mesh, const std::array<int, 8>& nodes) {
  mesh.cells.add(mesh::CellType::hex8, nodes);
  return mesh::cell_faces(mesh::CellType::hex8, nodes);
}

void add_flank(mesh::Mesh& mesh, const mesh::Face& face, const std::string& tooth, const std::string& side) {
  for (const std::string& name : {std::string("flanks"), side, std::string(tooth).append("_").append(side)})
    mesh.face_sets[name].push_back(face);
}

void check_counts(const std::string& body, std::initializer_list<int> counts, double cells) {
  for (int count : counts)
    require(count >= 1 && count <= kMaxCount, "the ", body, "'s element counts must be 1 to ", kMaxCount,
            ", one is ", count,
            count > kMaxCount ? "; a coarser size, a smaller refinement or a narrower face has fewer" : "");
  require(cells <= kMaxCells, "the ", body, "'s counts ask for about ", cells, " cells, at most ", kMaxCells,
          " are allowed");
}

void check_growth(const std::string& body, std::initializer_list<double> growth) {
  constexpr double kMost = 10;
  for (double g : growth)
    require(g == 0 || (g >= 1 && g <= kMost), "the ", body, "'s cells grow by ", g,
            ": must be 0 (nearly equal cells) or 1 to ", kMost);
}

void check_cells(const mesh::Mesh& mesh, const std::string& body) {
  const mesh::Quality quality = mesh::quality(mesh);
  if (quality.min_jacobian > 0 && quality.min_scaled_jacobian >= kLeastQuality) return;
  const auto folded = mesh::first_inverted_cell(mesh);
  const Eigen::Vector3d x = mesh.X.col(mesh.cells[folded.value_or(quality.worst_cell)][0]);
  require(!folded, "the ", body, "'s mesh has a folded cell at (", x.transpose(),
          ") m: change the element counts or make the design's steps there less sharp");
  fail("the ", body, "'s mesh has a cell of scaled Jacobian ", quality.min_scaled_jacobian, " at (",
       x.transpose(), ") m, at least ", kLeastQuality,
       " is needed: another size or other element counts, less sharp steps of the design there or, of "
       "a throated wheel, a smaller face_width would do");
}

void sort_node_sets(mesh::Mesh& mesh) {
  for (auto& [name, nodes] : mesh.node_sets) sort_unique(nodes);
}

std::string numbered(const std::string& prefix, int i, int n) {
  std::string digits = std::to_string(i + 1);
  digits.insert(0, std::to_string(n).size() - digits.size(), '0');
  return prefix + "_" + digits;
}

}  // namespace elastogear::gear
