#include <algorithm>
#include <map>

#include "elastogear/base/file.h"
#include "elastogear/base/sort_unique.h"
#include "mesh/msh/msh.h"
#include "mesh/msh/msh_format.h"
#include "mesh/msh/msh_scanner.h"
#include "mesh/raw/face_owner.h"
#include "mesh/raw/raw_mesh.h"

namespace elastogear::mesh {
namespace {

using DimTag = std::pair<int, Tag>;  // dimension and number of an entity or physical group

using msh_format::ElementType;

// An element's number in the file and its nodes.
struct RawElement {
  Tag tag;
  std::vector<Tag> nodes;
};

// The file as it stands, in its own numbers.
struct Raw : RawMesh {
  explicit Raw(MemberBudget members) : budget(std::move(members)) {}

  MemberBudget budget;
  std::map<DimTag, std::string> group_name;
  std::map<DimTag, std::vector<Tag>> groups_of;  // by entity
  std::map<std::string, std::vector<Tag>> cell_sets, node_sets;
  std::map<std::string, std::vector<RawElement>> face_sets;
  bool has_nodes = false, has_elements = false;
  std::map<std::string, std::size_t> left_out, unknown;  // what and how many
};

void read_format(MshScanner& in) {
  const std::string version(in.word("the format version"));
  if (version != "4.1")
    in.fail_here("MSH version ", version, ", only 4.1 is read (gmsh -save -format msh41)");
  const int type = in.text_number<int>("the file type");
  if (type != 0 && type != 1) in.fail_here("file type ", type, ", must be 0 (ASCII) or 1 (binary)");
  const int size = in.text_number<int>("the data size");
  if (size != sizeof(std::uint64_t)) in.fail_here("data size ", size, ", must be 8");
  in.line();
  if (type == 1 && in.bytes<std::int32_t>("the byte order mark") != 1)
    in.fail_here("the file was written with another byte order");
  in.expect("$EndMeshFormat");
  in.set_binary(type == 1);
}

void read_names(MshScanner& in, Raw& raw) {
  const int n = in.text_number<int>("the number of physical names");
  for (int i = 0; i < n; ++i) {
    const int dim = in.text_number<int>("the dimension of a physical group");
    const int tag = in.text_number<int>("the number of a physical group");
    const std::string_view line = in.line();
    const std::size_t first = line.find('"'), last = line.rfind('"');
    if (first == last) in.fail_here("physical group ", tag, " has no name in double quotes");
    const std::string name(line.substr(first + 1, last - first - 1));
    raw.group_name[{dim, tag}] = name;
    if (dim == 0) raw.node_sets[name];
    if (dim == 1) ++raw.left_out["physical curve '" + name + "'"];
    if (dim == 2) raw.face_sets[name];
    if (dim == 3) raw.cell_sets[name];
  }
}

void read_entity(MshScanner& in, Raw& raw, int dim) {
  const int tag = in.integer("the number of an entity");
  for (int i = 0; i < (dim == 0 ? 3 : 6); ++i) in.real("a coordinate of an entity");
  std::vector<Tag>& groups = raw.groups_of[{dim, tag}];
  groups.resize(in.count("the number of physical tags"));
  // The sign of a physical tag tells an orientation, the number names the group.
  for (Tag& group : groups) group = std::abs(Tag{in.integer("a physical tag")});
  if (dim == 0) return;
  const std::size_t n = in.count("the number of bounding entities");
  for (std::size_t i = 0; i < n; ++i) in.integer("a bounding entity");
}

void read_entities(MshScanner& in, Raw& raw) {
  std::size_t n[4];
  for (std::size_t& count : n) count = in.count("the number of entities");
  for (int dim = 0; dim < 4; ++dim)
    for (std::size_t i = 0; i < n[dim]; ++i) read_entity(in, raw, dim);
}

// numBlocks, numItems, minTag, maxTag; the tags' range is not needed.
std::pair<std::size_t, std::size_t> read_section_head(MshScanner& in) {
  const std::size_t blocks = in.count("the number of blocks"), items = in.count("the number of items", 8);
  for (int i = 0; i < 2; ++i)
    in.binary() ? in.bytes<std::uint64_t>("a tag range") : in.text_number<std::uint64_t>("a tag range");
  return {blocks, items};
}

void read_nodes(MshScanner& in, Raw& raw) {
  const auto [blocks, total] = read_section_head(in);
  raw.node.reserve(total);
  raw.X.reserve(3 * total);
  for (std::size_t block = 0; block < blocks; ++block) {
    const int dim = in.integer("the dimension of an entity");
    in.integer("the number of an entity");
    const int parametric = in.integer("the parametric flag");
    if (dim < 0 || dim > 3) in.fail_here("entity dimension ", dim, ", must be 0..3");
    const std::size_t n = in.count("the number of nodes in a block");
    for (std::size_t i = 0; i < n; ++i) raw.node.push_back(in.tag("a node number"));
    for (std::size_t i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k) raw.X.push_back(in.real("a node coordinate"));
      for (int k = 0; parametric != 0 && k < dim; ++k) in.real("a parametric coordinate");
    }
  }
  if (raw.node.size() != total)
    in.fail_here("the section announces ", total, " nodes and holds ", raw.node.size());
}

std::string set_name(const Raw& raw, DimTag group) {
  const auto found = raw.group_name.find(group);
  return found == raw.group_name.end() ? "physical_" + std::to_string(group.second) : found->second;
}

// What makes Gmsh write types that are read, or nothing.
const char* remedy_for(int type) {
  constexpr int kWithMiddles[] = {10, 12, 13,
                                  14};  // second-order cells and faces with nodes in their middles
  if (std::find(std::begin(kWithMiddles), std::end(kWithMiddles), type) == std::end(kWithMiddles))
    return nullptr;
  return "nodes in the middles of faces and cells are not read: save the mesh with "
         "Mesh.SecondOrderIncomplete=1";
}

ElementType read_type(MshScanner& in, int dim) {
  const int number = in.integer("an element type");
  for (const ElementType& type : msh_format::kTypes)
    if (type.number == number && type.dim == dim) return type;
  if (const char* remedy = remedy_for(number))
    in.fail_here("element type ", number, " in an entity of dimension ", dim, ": ", remedy);
  in.fail_here(
      "element type ", number, " in an entity of dimension ", dim,
      ", allowed are 4, 5, 6, 7 (linear tetrahedron, hexahedron, prism, pyramid), 11, 17, 18 ",
      "(second-order tetrahedron, hexahedron, prism) in 3, 2, 3, 9, 16 (triangle, quadrangle) in 2, ",
      "15 (point) in 0, and 1, 8 (line), which are left out");
}

void add_cell(Raw& raw, CellType type, RawElement element) {
  const std::vector<Tag> nodes = element.nodes;
  const auto position = msh_format::gmsh_position(type);
  for (std::size_t k = 0; k < position.size(); ++k) element.nodes[k] = nodes[position[k]];
  raw.add_cell(type, element.tag, element.nodes);
}

// Puts an element into the sets of its entity.
void add_to_sets(Raw& raw, int dim, const std::vector<std::string>& sets, const RawElement& element) {
  for (const std::string& set : sets) {
    if (dim == 0) raw.node_sets[set].push_back(element.nodes[0]);
    if (dim == 2) raw.face_sets[set].push_back(element);
    if (dim == 3) raw.cell_sets[set].push_back(element.tag);
  }
}

void read_block(MshScanner& in, Raw& raw, std::size_t& total) {
  const int dim = in.integer("the dimension of an entity");
  const int entity = in.integer("the number of an entity");
  const ElementType type = read_type(in, dim);
  const std::size_t n = in.count("the number of elements in a block");
  std::vector<std::string> sets;
  for (Tag group : raw.groups_of[{dim, entity}]) sets.push_back(set_name(raw, {dim, group}));
  if (dim == 1) sets.clear();
  if (sets.empty() && !type.cell) raw.left_out[std::string(type.plural) + " that are in no set"] += n;
  raw.budget.spend(n * sets.size());
  RawElement element{0, std::vector<Tag>(static_cast<std::size_t>(type.n_nodes))};
  for (std::size_t i = 0; i < n; ++i) {
    element.tag = in.tag("an element number");
    for (Tag& node : element.nodes) node = in.tag("a node number of an element");
    if (type.cell) add_cell(raw, *type.cell, element);
    add_to_sets(raw, dim, sets, element);
  }
  total += n;
}

void read_elements(MshScanner& in, Raw& raw) {
  const auto [blocks, announced] = read_section_head(in);
  std::size_t total = 0;
  for (std::size_t block = 0; block < blocks; ++block) read_block(in, raw, total);
  if (total != announced) in.fail_here("the section announces ", announced, " elements and holds ", total);
}

constexpr std::string_view kComments = "$Comments";

// Sections that leave the mesh as it is.
constexpr std::string_view kHarmless[] = {
    "$Periodic",         "$NodeData",     "$ElementData", "$ElementNodeData", "$InterpolationScheme",
    "$Parametrizations", "$GhostElements"};

void read_section(MshScanner& in, Raw& raw, const std::string& name) {
  const bool again = (name == "$Nodes" && raw.has_nodes) || (name == "$Elements" && raw.has_elements);
  if (again) in.fail_here("a second section ", name);
  const bool names = name == "$PhysicalNames" || name == "$Entities";
  if (names && raw.has_elements)
    in.fail_here("section ", name, " stands behind $Elements, whose sets it gives");
  if (name == "$PartitionedEntities")
    in.fail_here("section ", name, ": the mesh is divided, and its sets with it: save it without partitions");
  const std::string end = "$End" + name.substr(1);
  // One line end separates a section's name from its data.
  if (in.binary()) in.line();
  if (name == "$PhysicalNames") {
    read_names(in, raw);
  } else if (name == "$Entities") {
    read_entities(in, raw);
  } else if (name == "$Nodes") {
    read_nodes(in, raw);
    raw.has_nodes = true;
  } else if (name == "$Elements") {
    read_elements(in, raw);
    raw.has_elements = true;
  } else if (name == kComments) {
    return in.skip_past(end);
  } else {
    const bool known = std::find(std::begin(kHarmless), std::end(kHarmless), name) != std::end(kHarmless);
    ++(known ? raw.left_out : raw.unknown)["section " + name];
    return in.skip_past(end);
  }
  in.expect(end);
}

Raw read_raw(const std::string& path, std::string content) {
  Raw raw(MemberBudget(path, content.size()));
  MshScanner in(path, std::move(content));
  in.expect("$MeshFormat");
  read_format(in);
  while (!in.at_end()) {
    const std::string name(in.word("a section"));
    if (name.size() < 2 || name[0] != '$' || name.starts_with("$End"))
      in.fail_here("expected a section like $Nodes, found '", name.substr(0, 40), "'");
    read_section(in, raw, name);
  }
  if (!raw.has_nodes) in.fail_here("the file ends without a section $Nodes");
  if (!raw.has_elements) in.fail_here("the file ends without a section $Elements");
  return raw;
}

std::vector<int> numbers(const std::vector<Tag>& tags, const TagTable& table, const std::string& user) {
  std::vector<int> found;
  found.reserve(tags.size());
  for (Tag tag : tags) found.push_back(table.at(tag, [&] { return user; }));
  return found;
}

// Faces in the order of their elements' tags, whatever the blocks.
std::vector<Face> faces(std::vector<RawElement> elements, const TagTable& nodes, const std::string& user) {
  const auto by_tag = [](const RawElement& a, const RawElement& b) { return a.tag < b.tag; };
  std::stable_sort(elements.begin(), elements.end(), by_tag);
  std::vector<Face> found;
  for (const RawElement& element : elements)
    for (const Face& face : side_faces(numbers(element.nodes, nodes, user))) found.push_back(face);
  return found;
}

void build_sets(const Raw& raw, const TagTable& nodes, const TagTable& cells, Mesh& mesh) {
  for (const auto& [name, tags] : raw.node_sets)
    sort_unique(mesh.node_sets[name] = numbers(tags, nodes, "node set '" + name + "'"));
  for (const auto& [name, tags] : raw.cell_sets)
    sort_unique(mesh.cell_sets[name] = numbers(tags, cells, "cell set '" + name + "'"));
  for (const auto& [name, elements] : raw.face_sets)
    mesh.face_sets[name] = faces(elements, nodes, "face set '" + name + "'");
}

}  // namespace

Mesh parse_msh(const std::string& path, std::string content, double unit_in_m, ReadReport* report) {
  const Raw raw = read_raw(path, std::move(content));
  auto [nodes, cells, mesh] = number(raw, path, "cell", unit_in_m);
  build_sets(raw, nodes, cells, mesh);
  orient_faces(mesh);
  validate(mesh, path);
  if (!report) return mesh;
  report->node_number = nodes.tags();
  report->cell_number = cells.tags();
  for (const auto& [what, count] : raw.left_out)
    report->ignored.push_back(what + " (" + std::to_string(count) + ")");
  for (const auto& [what, count] : raw.unknown)
    report->lost.push_back(what + " (" + std::to_string(count) + "): not known, and left out");
  return mesh;
}

Mesh read_msh(const std::string& path, double unit_in_m, ReadReport* report) {
  return parse_msh(path, read_file(path), unit_in_m, report);
}

}  // namespace elastogear::mesh
