#include <algorithm>
#include <optional>

#include "elastogear/base/file.h"
#include "mesh/inp/inp.h"
#include "mesh/inp/inp_deck.h"
#include "mesh/inp/inp_format.h"
#include "mesh/inp/inp_lines.h"
#include "mesh/inp/inp_variant.h"

namespace elastogear::mesh {
namespace {

void read_nodes(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (key.has("SYSTEM") && upper(key.parameters.at("SYSTEM")) != "R")
    in.fail_here("*NODE with SYSTEM=", key.parameters.at("SYSTEM"),
                 ", only rectangular coordinates are read");
  const auto first = deck.node.size();
  while (in.next_data()) {
    const auto& fields = in.fields();
    if (fields.size() < 4) in.fail_here("a node needs a number and three coordinates");
    deck.node.push_back(in.parse_field<Tag>(fields[0], "a node number"));
    for (int k = 1; k < 4; ++k) deck.X.push_back(in.real(fields[k], "a coordinate"));
  }
  if (key.has("NSET"))
    deck.node_sets.add(key.parameters.at("NSET"), {deck.node.begin() + first, deck.node.end()}, key.line);
}

// One element may take several lines.
std::vector<Tag> read_element(InpLines& in, CellType type) {
  const std::size_t n = 1 + static_cast<std::size_t>(node_count(type));
  std::vector<Tag> numbers;
  do {
    for (std::string_view field : in.fields())
      numbers.push_back(in.parse_field<Tag>(field, "an element or node number"));
  } while (numbers.size() < n && in.next_data());
  if (numbers.size() != n)
    in.fail_here("element ", numbers.empty() ? 0 : numbers[0], " has ", numbers.size() - 1,
                 " nodes, its type needs ", n - 1);
  return numbers;
}

// Numbers of shells, beams and the like, which no body is made of.
std::vector<Tag> read_other_elements(InpLines& in) {
  std::vector<Tag> numbers;
  for (bool continued = false; in.next_data(); continued = in.continues())
    if (!continued) numbers.push_back(in.parse_field<Tag>(in.fields().at(0), "an element number"));
  return numbers;
}

std::vector<Tag> read_cells(InpLines& in, CellType type, InpDeck& deck) {
  std::vector<Tag> cells;
  while (in.next_data()) {
    const std::vector<Tag> numbers = read_element(in, type);
    cells.push_back(numbers[0]);
    deck.add_cell(type, numbers[0], std::span(numbers).subspan(1));
  }
  return cells;
}

void read_elements(InpLines& in, const Keyword& key, InpDeck& deck) {
  const std::string type = key.has("TYPE") ? upper(key.parameters.at("TYPE")) : "";
  const std::optional<CellType> solid = inp_format::cell_type(type);
  if (type.empty() || (!solid && type.starts_with("C3D")))
    in.fail_here("element type '", type, "', of solids only C3D4, 5, 6, 8, 10, 15, 20 and their variants ",
                 "(C3D8I, C3D20R, ...) are read");
  if (solid) deck.element_types.try_emplace(type, *solid, key.line);
  const std::vector<Tag> elements = solid ? read_cells(in, *solid, deck) : read_other_elements(in);
  if (!solid) {
    deck.other_elements.insert(deck.other_elements.end(), elements.begin(), elements.end());
    deck.ignored.push_back("*ELEMENT, TYPE=" + type + " (" + in.place(key.line) + ")");
  }
  if (key.has("ELSET")) deck.cell_sets.add(key.parameters.at("ELSET"), elements, key.line);
}

void ignore(InpLines& in, const Keyword& key, InpDeck& deck) {
  while (in.next_data()) continue;
  deck.ignored.push_back("*" + key.name + " (" + in.place(key.line) + ")");
}

// *PART, *ASSEMBLY and *INSTANCE as Abaqus CAE writes them around a single part.
bool read_structure(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (key.name == "PART" && ++deck.n_parts > 1) in.fail_here("a second *PART: a body is one part");
  if (key.name == "INSTANCE") {
    if (!deck.instance.empty()) in.fail_here("a second *INSTANCE: a body is one part");
    deck.instance = key.value("NAME");
    if (deck.instance.empty()) in.fail_here("*INSTANCE without NAME=name");
    if (in.next_data())
      in.fail_here("*INSTANCE with a translation or rotation is not supported: place the part's own ",
                   "coordinates instead");
  }
  if (key.name == "INSTANCE" || key.name == "END INSTANCE") deck.in_instance = key.name == "INSTANCE";
  if (key.name == "ASSEMBLY") deck.in_assembly = true;
  if (key.name == "END ASSEMBLY") deck.in_assembly = false;
  const std::string names[] = {"PART", "ASSEMBLY", "INSTANCE"};
  return std::any_of(std::begin(names), std::end(names),
                     [&](const std::string& name) { return key.name == name || key.name == "END " + name; });
}

bool read_mesh_card(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (deck.of_assembly() && (key.name == "NODE" || key.name == "ELEMENT"))
    in.fail_here("*", key.name, " outside the part and its instance is not supported (a reference point?): ",
                 "delete it, a marker of reduce does its work");
  const bool by_element = !key.has("TYPE") || key.value("TYPE") == "ELEMENT";
  if (key.name == "NODE") {
    read_nodes(in, key, deck);
  } else if (key.name == "ELEMENT") {
    read_elements(in, key, deck);
  } else if (key.name == "NSET" || key.name == "ELSET") {
    read_set(in, key, deck);
  } else if (key.name == "SURFACE" && by_element) {
    read_surface(in, key, deck);
  } else {
    return false;
  }
  return true;
}

// A step is what another program does with the body.
void read_in_step(InpLines& in, const Keyword& key, InpDeck& deck) {
  deck.in_step = key.name != "END STEP";
  ignore(in, key, deck);
}

void read_keyword(InpLines& in, InpDeck& deck) {
  const Keyword key = in.keyword();
  if (deck.in_step || key.name == "STEP") return read_in_step(in, key, deck);
  if (key.name == "SYSTEM") in.fail_here("*SYSTEM is not supported, only global coordinates are read");
  if (read_structure(in, key, deck) || read_mesh_card(in, key, deck)) return;
  if (read_material_card(in, key, deck.materials, deck.ignored)) return;
  if (key.name == "BOUNDARY") return read_boundary(in, key, deck.boundary, deck.ignored);
  ignore(in, key, deck);
}

// Our own files announce their last line, so that a cut at a line end is noticed.
void check_end(const std::string& path, const std::string& content, InpDeck& deck) {
  if (content.starts_with(inp_format::kFirstLine))
    require(content.ends_with(inp_format::kLastLine), path, ": the file ends before its last line '",
            inp_format::kLastLine.substr(0, inp_format::kLastLine.size() - 1), "': it is truncated");
  if (!content.ends_with('\n')) deck.ignored.push_back("the last line has no line end: truncated?");
}

Mesh build(const InpLines& in, const InpDeck& deck, double unit_in_m, ReadReport& report) {
  MemberBudget budget(in.path(), in.total_size());
  auto [nodes, cells, mesh] = number(deck, in.path(), "element", unit_in_m);
  const auto fail_at = [&](int line, const std::string& text) { in.fail_at(line, text); };
  mesh.node_sets = deck.node_sets.resolve({nodes, {}, budget, fail_at});
  mesh.cell_sets = deck.cell_sets.resolve(
      {cells, {deck.other_elements.begin(), deck.other_elements.end()}, budget, fail_at});
  build_surfaces(in, deck, cells, mesh, budget);
  report.regions = material_regions(in, deck.materials, deck.cell_sets, mesh, unit_in_m);
  report.node_number = nodes.tags();
  report.cell_number = cells.tags();
  apply_boundary(in, deck.boundary, deck.node_sets, nodes, mesh, report);
  validate(mesh, in.path());
  return mesh;
}

}  // namespace

std::string_view InpDeck::member(std::string_view field) const {
  const std::size_t dot = field.find('.');
  const bool of_instance = !instance.empty() && dot != field.npos && upper(field.substr(0, dot)) == instance;
  return of_instance ? field.substr(dot + 1) : field;
}

Mesh parse_inp(InpText text, double unit_in_m, ReadReport* report) {
  InpDeck deck;
  check_end(text.path, text.content, deck);
  InpLines in(std::move(text));
  while (in.next()) {
    if (!in.at_keyword()) in.fail_here("data before the first keyword");
    read_keyword(in, deck);
  }
  for (BoundaryLine& line : deck.boundary) line.members = std::string(deck.member(line.members));
  ReadReport found;
  Mesh mesh = build(in, deck, unit_in_m, found);
  found.ignored = std::move(deck.ignored);
  for (const auto& [type, first] : deck.element_types)
    if (const std::string note = variant_note(type, first.first); !note.empty())
      found.read_as.push_back(
          std::string(type).append(" (").append(in.place(first.second)).append("): ").append(note));
  if (report) *report = std::move(found);
  return mesh;
}

Mesh read_inp(const std::string& path, double unit_in_m, ReadReport* report) {
  return parse_inp({path, read_file(path)}, unit_in_m, report);
}

}  // namespace elastogear::mesh
