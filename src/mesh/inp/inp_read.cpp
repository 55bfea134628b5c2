#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "elastogear/base/file.h"
#include "elastogear/base/sort_unique.h"
#include "mesh/inp/generate.h"
#include "mesh/inp/inp_deck.h"
#include "mesh/inp/inp_format.h"
#include "mesh/inp/inp_variant.h"
#include "mesh/inp/lines/inp.h"
#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {
namespace {

void read_nodes(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (key.has("SYSTEM") && upper(key.parameters.at("SYSTEM")) != "R")
    in.fail_here("*NODE with SYSTEM=", key.parameters.at("SYSTEM"),
                 ", only rectangular coordinates are read");
  const auto first = deck.node.size();
  while (in.next_data()) {
    const auto& fields = in.fields();
    if (fields.empty()) in.fail_here("a node needs a number");
    deck.node.push_back(in.parse_field<Tag>(fields[0], "a node number"));
    // Coordinates that are left out at the end are 0, which spares plane models the third.
    for (std::size_t k = 1; k < 4; ++k)
      deck.X.push_back(k < fields.size() && !fields[k].empty() ? in.real(fields[k], "a coordinate") : 0);
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

// An element that repeats nodes is the cell that its different nodes make.
void add_element(const InpLines& in, CellType type, const std::vector<Tag>& numbers, InpDeck& deck) {
  const std::span<const Tag> nodes = std::span(numbers).subspan(1);
  std::vector<Tag> different(nodes.begin(), nodes.end());
  sort_unique(different);
  if (different.size() == nodes.size()) return deck.add_cell(type, numbers[0], nodes);
  const auto cell = without_repeated_nodes(type, nodes);
  if (!cell)
    in.fail_here(
        "element ", numbers[0], " repeats nodes, its ", different.size(),
        " different ones make no wedge, pyramid or tetrahedron that is read: split it into tetrahedra");
  deck.add_cell(cell->type, numbers[0], cell->nodes);
  deck.collapsed[numbers[0]] = {type, {nodes.begin(), nodes.end()}};
  deck.notes.read_as(in, std::string(inp_format::kElementTypes[static_cast<int>(type)]), in.number(),
                     std::string("elements that repeat nodes are read as ") + name(cell->type));
}

std::vector<Tag> read_cells(InpLines& in, CellType type, InpDeck& deck) {
  std::vector<Tag> cells;
  while (in.next_data()) {
    const std::vector<Tag> numbers = read_element(in, type);
    cells.push_back(numbers[0]);
    add_element(in, type, numbers, deck);
  }
  return cells;
}

void read_elements(InpLines& in, const Keyword& key, InpDeck& deck) {
  const std::string type = key.has("TYPE") ? upper(key.parameters.at("TYPE")) : "";
  const std::optional<CellType> solid = inp_format::cell_type(type);
  if (type.empty() || (!solid && type.starts_with("C3D")))
    in.fail_here("element type '", type, "', of solids only C3D4, 5, 6, 8, 10, 15, 20 and their variants ",
                 "(C3D8I, C3D20R, ...) are read",
                 type.starts_with("C3D27") ? "; write C3D20: leave the nodes in faces and centre out" : "");
  if (solid) deck.element_types.try_emplace(type, *solid, key.line);
  const std::vector<Tag> elements =
      solid ? read_cells(in, *solid, deck) : read_other_elements(in, key, deck.others);
  if (key.has("ELSET")) deck.cell_sets.add(key.parameters.at("ELSET"), elements, key.line);
}

// A translation, then two points on an axis and the angle about it in degrees; the rotation comes last.
void read_placement(InpLines& in, InpDeck& deck) {
  if (!in.next_data()) return;
  deck.placement_line = in.number();
  std::vector<double> t = in.reals("a translation"), r;
  if (t.size() > 3) in.fail_here("a translation of an *INSTANCE has ", t.size(), " numbers, must be 3");
  t.resize(3, 0);
  if (in.next_data()) {
    r = in.reals("a rotation");
    if (r.size() != 7) in.fail_here("a rotation of an *INSTANCE has ", r.size(), " numbers, must be 7");
    const Eigen::Vector3d a(r[0], r[1], r[2]), axis = Eigen::Vector3d(r[3], r[4], r[5]) - a;
    if (!(axis.norm() > 0)) in.fail_here("the points of a rotation of an *INSTANCE give no axis");
    const Eigen::AngleAxisd turn(r[6] * M_PI / 180, axis.normalized());
    deck.placement = Eigen::Translation3d(a) * turn * Eigen::Translation3d(-a);
  }
  deck.placement = deck.placement * Eigen::Translation3d(t[0], t[1], t[2]);
  if (in.next_data()) in.fail_here("*INSTANCE with more than two lines of data");
}

// Moves the nodes of the part to where its instance is.
void place_instance(const InpLines& in, InpDeck& deck) {
  if (deck.placement_line == 0) return;
  if (!deck.materials.orientations.empty() || !deck.transforms.empty())
    in.fail_at(deck.placement_line,
               "an *INSTANCE that is moved, of a deck with *ORIENTATION or *TRANSFORM, is not supported: ",
               "write the part's nodes where the instance has them");
  for (std::size_t i = 0; i < deck.X.size(); i += 3) {
    Eigen::Map<Eigen::Vector3d> X(&deck.X[i]);
    X = deck.placement * Eigen::Vector3d(X);
  }
}

// *PART, *ASSEMBLY and *INSTANCE as Abaqus CAE writes them around a single part.
bool read_structure(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (key.name == "PART" && ++deck.n_parts > 1)
    in.fail_here(
        "a second *PART: a body is one part; option instance of reduce chooses one by its *INSTANCE");
  if (key.name == "INSTANCE") {
    if (!deck.instance.empty())
      in.fail_here("a second *INSTANCE, '", key.value("NAME"), "' after '", deck.instance,
                   "': a body is one of them, which option instance of reduce chooses");
    deck.instance = key.value("NAME");
    if (deck.instance.empty()) in.fail_here("*INSTANCE without NAME=name");
    read_placement(in, deck);
  }
  if (key.name == "PART" || key.name == "END PART") deck.in_part = key.name == "PART";
  if (key.name == "INSTANCE" || key.name == "END INSTANCE") deck.in_instance = key.name == "INSTANCE";
  if (key.name == "ASSEMBLY") deck.in_assembly = true;
  if (key.name == "END ASSEMBLY") deck.in_assembly = false;
  const std::string names[] = {"PART", "ASSEMBLY", "INSTANCE"};
  return std::any_of(std::begin(names), std::end(names),
                     [&](const std::string& name) { return key.name == name || key.name == "END " + name; });
}

void read_mesh_card(InpLines& in, const Keyword& key, InpDeck& deck) {
  const bool makes = key.name == "NODE" || key.name == "ELEMENT";
  if (deck.of_assembly() && makes)
    in.fail_here("*", key.name, " outside the part and its instance is not supported (a reference point?): ",
                 "delete it, a marker of reduce does its work");
  if (key.name == "NODE") {
    read_nodes(in, key, deck);
  } else if (key.name == "ELEMENT") {
    read_elements(in, key, deck);
  } else if (key.name == "NGEN") {
    generate_nodes(in, key, deck);
  } else if (key.name == "ELGEN") {
    generate_elements(in, key, deck);
  } else if (key.name == "SURFACE") {
    read_surface(in, key, deck);
  } else {
    read_set(in, key, deck);
  }
}

// What holds the body before the first step or in it; further steps are what another program does then.
void read_restraint(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (deck.n_steps > 1) {
    while (in.next_data()) continue;
    return deck.notes.lose(in, "*BOUNDARY of a later step", key.line,
                           "that of the first step holds the body");
  }
  if (deck.in_step && key.value("OP") == "NEW" && !std::exchange(deck.boundary_is_new, true))
    deck.boundary.clear();
  read_boundary(in, key, deck.boundary, deck.notes);
}

void read_masses(InpLines& in, const Keyword& key, InpDeck& deck) {
  const std::size_t n = deck.others.masses.size();
  read_mass(in, key, deck.others);
  if (deck.others.masses.size() == n) return;
  std::string& members = deck.others.masses.back().members;
  if (deck.leaves_out("ELSET", members)) return deck.others.masses.pop_back();
  members = std::string(deck.member(members));
}

void read_axes(InpLines& in, const Keyword& key, InpDeck& deck) {
  Transform transform = read_transform(in, key);
  if (deck.leaves_out("NSET", transform.members)) return;
  transform.members = std::string(deck.member(transform.members));
  deck.transforms.push_back(std::move(transform));
}

// A keyword that the table says is read.
void read_card(InpLines& in, const Keyword& key, InpDeck& deck) {
  for (const auto& [parameter, value] : key.parameters) {
    if (knows(*key.row, parameter)) continue;
    if (key.row->kind == KeywordKind::makes)
      in.fail_at(key.line, "*", key.name, " with the parameter ", parameter,
                 " is not supported, read are: ", key.row->text,
                 "; write the nodes and elements out without it");
    deck.notes.lose(in, "*" + key.name + ", " + parameter, key.line, "this parameter is not read");
  }
  if (key.has("INPUT")) in.include(key);
  if (read_structure(in, key, deck)) return;
  if (read_material_card(in, key, deck.materials, deck.notes)) return;
  if (key.name == "BOUNDARY") return read_restraint(in, key, deck);
  if (key.name == "MASS") return read_masses(in, key, deck);
  if (key.name == "TRANSFORM") return read_axes(in, key, deck);
  read_mesh_card(in, key, deck);
}

void pass_over(InpLines& in, const Keyword& key, InpDeck& deck) {
  while (in.next_data()) continue;
  const std::string what = "*" + key.name;
  if (!key.row && !deck.in_step)
    deck.notes.lose(in, what, key.line,
                    "a keyword that is not known; whatever it does to the body is left out");
  else if (key.row && key.row->kind == KeywordKind::lost)
    deck.notes.lose(in, what, key.line, std::string(key.row->text));
  else
    deck.notes.ignore(in, what, key.line);
}

// A step is what another program does with the body, but for what holds it.
void read_keyword(InpLines& in, InpDeck& deck) {
  const Keyword key = in.keyword();
  if (belongs_to_others(key, deck.chosen)) {
    while (in.next_data()) continue;
    return;
  }
  if (key.name == "STEP") ++deck.n_steps;
  if (key.name == "STEP") deck.in_step = true;
  const KeywordKind kind = key.row ? key.row->kind : KeywordKind::lost;
  if (kind == KeywordKind::refused) in.fail_at(key.line, "*", key.name, ": ", key.row->text);
  const bool is_read = kind == KeywordKind::makes || kind == KeywordKind::read;
  if (is_read && (!deck.in_step || key.name == "BOUNDARY"))
    read_card(in, key, deck);
  else
    pass_over(in, key, deck);
  if (key.name == "END STEP") deck.in_step = false;
}

// Our own files announce their last line, so that a cut at a line end is noticed.
void check_end(const std::string& path, const std::string& content, InpDeck& deck) {
  if (content.starts_with(inp_format::kFirstLine))
    require(content.ends_with(inp_format::kLastLine), path, ": the file ends before its last line '",
            inp_format::kLastLine.substr(0, inp_format::kLastLine.size() - 1), "': it is truncated");
  deck.ends_in_a_line = content.ends_with('\n');
}

// What the elements that are no solids stand for.
void build_others(const InpLines& in, InpDeck& deck, const TagTable& nodes, const InpSets::Context& context,
                  double unit_in_m, Mesh& mesh, ReadReport& report) {
  const OtherSets sets = deck.cell_sets.resolve(context);
  add_faces(in, deck.others, context.table, sets, nodes, mesh, deck.notes);
  add_masses(in, deck.others, context.table, deck.cell_sets, sets, nodes, unit_in_m, mesh, report);
}

void build_restraint(const InpLines& in, const InpDeck& deck, const TagTable& nodes, double unit_in_m,
                     Mesh& mesh, ReadReport& report) {
  std::vector<Transform> transforms = deck.transforms;
  for (Transform& transform : transforms)
    for (Eigen::Vector3d* point : {&transform.a, &transform.b}) *point *= unit_in_m;
  std::vector<Directions> held = held_nodes(in, deck.boundary, deck.node_sets, nodes, mesh);
  to_mesh_axes(in, transforms, deck.node_sets, nodes.tags(), mesh, held);
  make_restraint(held, mesh, report);
}

Mesh build(const InpLines& in, InpDeck& deck, double unit_in_m, ReadReport& report) {
  MemberBudget budget(in.path(), in.total_size());
  auto [nodes, cells, mesh] = number(deck, in.path(), "element", unit_in_m);
  const TagTable others(deck.others.number, "element", in.path());
  const auto fail_at = [&](int line, const std::string& text) { in.fail_at(line, text); };
  mesh.node_sets = deck.node_sets.resolve({nodes, nullptr, budget, fail_at});
  mesh.cell_sets = deck.cell_sets.resolve({cells, &others, budget, fail_at});
  build_surfaces(in, deck, nodes, cells, mesh, budget);
  if (others.size() > 0 || !deck.others.masses.empty())
    build_others(in, deck, nodes, {others, &cells, budget, fail_at}, unit_in_m, mesh, report);
  report.regions = material_regions(in, deck.materials, deck.cell_sets, mesh, unit_in_m);
  report.node_number = nodes.tags();
  report.cell_number = cells.tags();
  build_restraint(in, deck, nodes, unit_in_m, mesh, report);
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
  deck.chosen = choose_instance(text);
  deck.left_to_generate = text.most_generated;
  InpLines in(std::move(text));
  while (in.next()) {
    if (!in.at_keyword()) in.fail_here("data before the first keyword");
    read_keyword(in, deck);
  }
  std::erase_if(deck.boundary,
                [&](const BoundaryLine& line) { return deck.chosen.leaves_out("NSET", line.members); });
  for (BoundaryLine& line : deck.boundary) line.members = std::string(deck.member(line.members));
  place_instance(in, deck);
  ReadReport found;
  Mesh mesh = build(in, deck, unit_in_m, found);
  found.ignored = deck.notes.ignored();
  found.lost = deck.notes.lost();
  found.read_as = deck.notes.read_as();
  if (!deck.ends_in_a_line)
    found.lost.insert(found.lost.begin(), "the last line has no line end: truncated?");
  for (const auto& [type, first] : deck.element_types)
    if (const std::string note = variant_note(type, first.first); !note.empty())
      found.read_as.push_back(
          std::string(type).append(" (").append(in.place(first.second)).append("): ").append(note));
  if (report) *report = std::move(found);
  return mesh;
}

Mesh read_inp(const std::string& path, double unit_in_m, ReadReport* report, const std::string& instance) {
  return parse_inp({path, read_file(path), read_file, instance}, unit_in_m, report);
}

}  // namespace elastogear::mesh
