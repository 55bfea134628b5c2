// *NSET, *ELSET and *SURFACE of an Abaqus input file.
#include <algorithm>
#include <utility>

#include "mesh/inp/inp_deck.h"
#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {
namespace {

constexpr int kMaxSides = 6;
constexpr int kFreeSides = -1, kOfOthers = -2;  // labels of a surface: blank, or one of shells and beams

void read_range(InpLines& in, const std::string& name, InpSets& sets) {
  const auto& fields = in.fields();
  if (fields.size() < 2 || fields.size() > 3) in.fail_here("GENERATE needs first, last and step");
  const auto number = [&](int i) { return in.parse_field<Tag>(fields[i], "a number of a range"); };
  const Tag step = fields.size() == 3 ? number(2) : 1;
  if (step < 1) in.fail_here("the step of a range is ", step, ", must be positive");
  sets.add_range(name, number(0), number(1), step, in.number());
}

// Makes a set that has no members yet. In an assembly a set of the part's name is another set, which one mesh
// cannot have too.
void begin_set(const InpLines& in, const Keyword& key, InpDeck& deck, InpSets& sets) {
  const InpSetName set{key.name, key.value(key.name)};
  if (deck.of_assembly()) {
    if (sets.spelling(set.second) && !deck.assembly_sets.contains(set))
      in.fail_at(key.line, "set '", set.second,
                 "' of the assembly has the name of a set of the part: rename one of them");
    deck.assembly_sets.insert(set);
    deck.chosen.own.insert(set);
  }
  sets.add(key.parameters.at(key.name), {}, key.line);
}

// S1..S6 as 0..5; a blank label means all free sides.
int side_of(const std::string& label) {
  if (label.empty()) return kFreeSides;
  const bool known = label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] < '1' + kMaxSides;
  return known ? label[1] - '1' : kOfOthers;
}

const std::map<int, std::vector<Face>>& free_faces(const Mesh& mesh,
                                                   std::map<int, std::vector<Face>>& known) {
  if (!known.empty()) return known;
  std::vector<int> cell;
  const std::vector<Face> faces = boundary_faces(mesh, &cell);
  for (std::size_t i = 0; i < faces.size(); ++i) known[cell[i]].push_back(faces[i]);
  return known;
}

// The surfaces of a deck while they are built.
struct Surfaces {
  const InpLines& in;
  InpDeck& deck;
  const TagTable &nodes, &cells;
  Mesh& mesh;
  MemberBudget& budget;
  std::map<int, std::vector<Face>> free = {};  // by cell, once they are asked for

  void add(const SurfaceLine& line, const std::vector<Face>& faces) {
    budget.spend(faces.size());
    auto& set = mesh.face_sets[line.name];
    set.insert(set.end(), faces.begin(), faces.end());
  }

  // The side of the cell with the corners that the side of a collapsed element has; nothing where it is an
  // edge.
  void add_collapsed(const SurfaceLine& line, int cell, const CellNodes& element) {
    if (line.side >= side_count(element.type)) return fail_side(line, element.type);
    std::vector<int> corners;
    for (Tag node : different_corners(element, line.side)) corners.push_back(nodes.find(node));
    std::sort(corners.begin(), corners.end());
    const CellType type = mesh.cells.type[cell];
    const auto sides = cell_sides(type, mesh.cells[cell]);
    const auto side_nodes = cell_side_nodes(type, mesh.cells[cell]);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const bool midside = node_count(type) > corner_count(type);
      const auto end = side_nodes[i].begin() + std::ssize(side_nodes[i]) / (midside ? 2 : 1);
      std::vector<int> of_side(side_nodes[i].begin(), end);
      std::sort(of_side.begin(), of_side.end());
      if (of_side == corners) add(line, sides[i]);
    }
  }

  void fail_side(const SurfaceLine& line, CellType type) {
    in.fail_at(line.line, "surface '", line.name, "' names side ", line.label, " of a ", name(type),
               ", which has S1..S", side_count(type));
  }

  void add_side(const SurfaceLine& line, int cell) {
    if (line.side == kFreeSides) {
      const auto found = free_faces(mesh, free).find(cell);
      return found == free.end() ? void() : add(line, found->second);
    }
    const auto element = deck.collapsed.find(cells.tags()[static_cast<std::size_t>(cell)]);
    if (line.side >= 0 && element != deck.collapsed.end()) return add_collapsed(line, cell, element->second);
    const auto sides = cell_sides(mesh.cells.type[cell], mesh.cells[cell]);
    if (line.side < 0 || line.side >= std::ssize(sides)) fail_side(line, mesh.cells.type[cell]);
    add(line, sides[line.side]);
  }

  void leave_out(const SurfaceLine& line) {
    deck.notes.lose(in, "*SURFACE, NAME=" + line.name, line.line,
                    "what it names of elements that are no solids is left out");
  }

  void add_element(const SurfaceLine& line, Tag number) {
    const int cell = cells.find(number);
    const auto& others = deck.others.number;
    if (cell >= 0) return add_side(line, cell);
    if (std::find(others.begin(), others.end(), number) != others.end()) return leave_out(line);
    in.fail_at(line.line, "surface '", line.name, "' names element ", number,
               ", which the file does not define");
  }

  void add_set(const SurfaceLine& line) {
    const std::string* set = deck.cell_sets.spelling(line.members);
    if (!set)
      in.fail_at(line.line, "surface '", line.name, "' names the unknown element set '", line.members, "'");
    const std::vector<int>& members = mesh.cell_sets.at(*set);
    if (members.empty() && !deck.others.number.empty()) return leave_out(line);
    for (int cell : members) add_side(line, cell);
  }
};

}  // namespace

void read_set(InpLines& in, const Keyword& key, InpDeck& deck) {
  InpSets& sets = key.name == "NSET" ? deck.node_sets : deck.cell_sets;
  if (!key.has(key.name)) in.fail_here("*", key.name, " without ", key.name, "=name");
  if (key.name == "NSET" && key.has("ELSET")) in.fail_here("*NSET from an ELSET is not supported");
  const std::string& name = key.parameters.at(key.name);
  bool begun = false, left_out = false;
  const auto begin = [&] {
    if (!std::exchange(begun, true)) begin_set(in, key, deck, sets);
  };
  while (in.next_data()) {
    if (key.has("GENERATE")) {
      begin();
      read_range(in, name, sets);
      continue;
    }
    for (std::string_view field : in.fields()) {
      if (deck.leaves_out(key.name, field)) {
        left_out = true;
        continue;
      }
      const std::string_view member = deck.member(field);
      if (member.empty()) continue;
      begin();
      if (const auto number = parse<Tag>(member))
        sets.add(name, {*number}, in.number());
      else
        sets.add_set(name, std::string(member), in.number());
    }
  }
  if (left_out && !begun)
    deck.chosen.of_others.insert({key.name, upper(name)});
  else
    begin();
}

void read_surface(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (!key.has("NAME")) in.fail_here("*SURFACE without NAME=name");
  const std::string name = deck.surfaces.first_spelling(key.parameters.at("NAME"));
  if (key.has("TYPE") && key.value("TYPE") != "ELEMENT") {
    deck.surfaces.spelling.erase(upper(name));
    while (in.next_data()) continue;
    return deck.notes.lose(in, "*SURFACE, TYPE=" + key.value("TYPE"), key.line,
                           "this surface is not read: name a node set, or give it by elements");
  }
  bool left_out = false;
  while (in.next_data()) {
    const auto& fields = in.fields();
    if (deck.leaves_out("ELSET", fields[0])) {
      left_out = true;
      continue;
    }
    const std::string label = fields.size() > 1 ? upper(fields[1]) : "";
    deck.surface_lines.push_back(
        {name, std::string(deck.member(fields[0])), label, side_of(label), in.number()});
  }
  if (left_out && std::none_of(deck.surface_lines.begin(), deck.surface_lines.end(),
                               [&](const SurfaceLine& line) { return line.name == name; }))
    deck.surfaces.spelling.erase(upper(name));
}

void build_surfaces(const InpLines& in, InpDeck& deck, const TagTable& nodes, const TagTable& cells,
                    Mesh& mesh, MemberBudget& budget) {
  for (const auto& [key, name] : deck.surfaces.spelling) mesh.face_sets[name];
  Surfaces surfaces{in, deck, nodes, cells, mesh, budget};
  for (const SurfaceLine& line : deck.surface_lines)
    if (const auto number = parse<Tag>(line.members))
      surfaces.add_element(line, *number);
    else
      surfaces.add_set(line);
}

}  // namespace elastogear::mesh
