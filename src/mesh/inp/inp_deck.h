#pragma once
// An Abaqus input file as it stands, in its own numbers, names and units.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/inp/cards/boundary.h"
#include "mesh/inp/cards/collapsed.h"
#include "mesh/inp/cards/materials.h"
#include "mesh/inp/cards/others.h"
#include "mesh/inp/lines/inp_sets.h"
#include "mesh/raw/raw_mesh.h"

namespace elastogear::mesh {

struct SurfaceLine {
  std::string name;     // of the surface
  std::string members;  // cell number or element set
  std::string label;    // as written, in capitals
  int side = 0;         // 0..5, or negative: see side_of
  int line = 0;
};

using InpSetName = std::pair<std::string, std::string>;  // keyword and name in capitals

/// Of a deck with several instances, the one that is read, and what belongs to the others and is passed over.
struct ChosenInstance {
  std::string name, part;               // in capitals; empty: there is only one
  std::set<std::string> others;         // in capitals: names of instances
  std::set<InpSetName> own, of_others;  // sets of the assembly with members in the one and in others
  bool in_other_part = false, in_other = false;

  /// Returns whether a line outside of the part names what belongs to other instances alone: one of their
  /// own sets, "Part-2-1.Set-2", or a set of the assembly. keyword: of the set, "NSET" or "ELSET".
  bool leaves_out(const std::string& keyword, std::string_view field) const;
};

/// Where the last definition of each number stands, of a list that grows at its end.
class Positions {
 public:
  std::optional<std::size_t> find(const std::vector<Tag>& numbers, Tag number) {
    for (; known_ < numbers.size(); ++known_) at_[numbers[known_]] = known_;
    const auto found = at_.find(number);
    return found == at_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::unordered_map<Tag, std::size_t> at_;
  std::size_t known_ = 0;
};

struct InpDeck : RawMesh {
  ChosenInstance chosen;
  OtherElements others;
  std::map<Tag, CellNodes> collapsed;  // elements that repeat nodes, as the file has them
  InpSets node_sets{"node"}, cell_sets{"element"};
  InpNames surfaces;
  Positions node_at, cell_at;  // of those that are generated from
  Tag left_to_generate = 0;    // nodes and elements
  std::vector<SurfaceLine> surface_lines;
  InpMaterials materials;
  std::vector<BoundaryLine> boundary;
  std::vector<Transform> transforms;
  InpNotes notes;
  std::map<std::string, std::pair<CellType, int>> element_types;  // in capitals: type and first line
  // One *PART, whose one *INSTANCE is the *ASSEMBLY, is the same as its content alone, wherever of the two
  // it stands: instances that Abaqus CAE calls independent hold it themselves.
  int n_parts = 0;
  std::string instance;                                         // its name in capitals
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  // of the instance, unit of the file
  int placement_line = 0;                                       // 0: it is in place
  bool in_part = false, in_assembly = false, in_instance = false, in_step = false;
  int n_steps = 0;
  bool ends_in_a_line = true;
  bool boundary_is_new = false;  // the first step took back what stands above it
  std::set<InpSetName> assembly_sets;

  /// Returns whether the present keyword belongs to the assembly itself, not to its instance.
  bool of_assembly() const { return in_assembly && !in_instance; }
  /// Does the present line name what belongs to other instances than the chosen one? See ChosenInstance.
  bool leaves_out(const std::string& keyword, std::string_view field) const {
    return !in_part && !in_instance && chosen.leaves_out(keyword, field);
  }
  /// A member of a set or surface without the name of its instance ("Part-1-1.Set-2").
  std::string_view member(std::string_view field) const;
};

/// Finds the instance and its part. Error when there is none of the name.
ChosenInstance choose_instance(const InpText& text);
/// Returns whether the present keyword belongs to another instance than the chosen one.
bool belongs_to_others(const Keyword& key, ChosenInstance& chosen);

/// *NSET or *ELSET, and *SURFACE by elements.
void read_set(InpLines& in, const Keyword& key, InpDeck& deck);
void read_surface(InpLines& in, const Keyword& key, InpDeck& deck);
/// The mesh's face sets, when its cell sets are there. Error for unknown elements and sets and sides a cell
/// has not.
void build_surfaces(const InpLines& in, InpDeck& deck, const TagTable& nodes, const TagTable& cells,
                    Mesh& mesh, MemberBudget& budget);

}  // namespace elastogear::mesh
