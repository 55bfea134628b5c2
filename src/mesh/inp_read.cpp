#include <algorithm>
#include <cmath>
#include <optional>

#include "elastogear/base/file.h"
#include "elastogear/mesh/inp.h"
#include "face_owner.h"
#include "inp_format.h"
#include "inp_lines.h"
#include "inp_sets.h"
#include "tag_table.h"

namespace elastogear::mesh {
namespace {

using Tag = std::int64_t;

constexpr int kMaxSides = 6;

struct SurfaceLine {
  std::string name;     // of the surface
  std::string members;  // cell number or element set
  int side = 0;
  int line = 0;
};

// The file as it stands, in its own numbers.
struct Raw {
  std::vector<Tag> node;
  std::vector<double> X;  // 3 per node
  std::vector<Tag> cell;
  std::vector<CellType> cell_type;
  std::vector<std::size_t> cell_offset{0};
  std::vector<Tag> cell_node;       // cell i: cell_offset[i] .. cell_offset[i + 1]
  std::vector<Tag> other_elements;  // shells, beams, ...: left out, but sets may name them
  InpSets node_sets{"node"}, cell_sets{"element"};
  InpNames surfaces;
  std::vector<SurfaceLine> surface_lines;
  std::vector<std::string> ignored;
};

double coordinate(const InpLines& in, std::string_view field) {
  std::string text(field);
  // Fortran's exponent letter.
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  const double value = in.parse_field<double>(text, "a coordinate");
  if (!std::isfinite(value)) in.fail_here("a coordinate is ", value, ", must be finite");
  return value;
}

void read_nodes(InpLines& in, const Keyword& key, Raw& raw) {
  if (key.has("SYSTEM") && upper(key.parameters.at("SYSTEM")) != "R")
    in.fail_here("*NODE with SYSTEM=", key.parameters.at("SYSTEM"),
                 ", only rectangular coordinates are read");
  const auto first = raw.node.size();
  while (in.next_data()) {
    const auto& fields = in.fields();
    if (fields.size() < 4) in.fail_here("a node needs a number and three coordinates");
    raw.node.push_back(in.parse_field<Tag>(fields[0], "a node number"));
    for (int k = 1; k < 4; ++k) raw.X.push_back(coordinate(in, fields[k]));
  }
  if (key.has("NSET"))
    raw.node_sets.add(key.parameters.at("NSET"), {raw.node.begin() + first, raw.node.end()}, key.line);
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

std::vector<Tag> read_cells(InpLines& in, CellType type, Raw& raw) {
  std::vector<Tag> cells;
  while (in.next_data()) {
    const std::vector<Tag> numbers = read_element(in, type);
    cells.push_back(numbers[0]);
    raw.cell_type.push_back(type);
    raw.cell_node.insert(raw.cell_node.end(), numbers.begin() + 1, numbers.end());
    raw.cell_offset.push_back(raw.cell_node.size());
  }
  raw.cell.insert(raw.cell.end(), cells.begin(), cells.end());
  return cells;
}

void read_elements(InpLines& in, const Keyword& key, Raw& raw) {
  const std::string type = key.has("TYPE") ? upper(key.parameters.at("TYPE")) : "";
  const std::optional<CellType> solid = inp_format::cell_type(type);
  if (type.empty() || (!solid && type.starts_with("C3D")))
    in.fail_here("element type '", type, "', of solids only C3D4, 5, 6, 8, 10, 15, 20 and their variants ",
                 "(C3D8I, C3D20R, ...) are read");
  const std::vector<Tag> elements = solid ? read_cells(in, *solid, raw) : read_other_elements(in);
  if (!solid) {
    raw.other_elements.insert(raw.other_elements.end(), elements.begin(), elements.end());
    raw.ignored.push_back("*ELEMENT, TYPE=" + type + " (line " + std::to_string(key.line) + ")");
  }
  if (key.has("ELSET")) raw.cell_sets.add(key.parameters.at("ELSET"), elements, key.line);
}

void read_set(InpLines& in, const Keyword& key, InpSets& sets) {
  const std::string parameter = key.name;  // *NSET, NSET=name
  if (!key.has(parameter)) in.fail_here("*", key.name, " without ", parameter, "=name");
  if (key.name == "NSET" && key.has("ELSET")) in.fail_here("*NSET from an ELSET is not supported");
  const std::string& name = key.parameters.at(parameter);
  sets.add(name, {}, key.line);
  while (in.next_data()) {
    const auto& fields = in.fields();
    if (key.has("GENERATE")) {
      if (fields.size() < 2 || fields.size() > 3) in.fail_here("GENERATE needs first, last and step");
      const auto number = [&](int i) { return in.parse_field<Tag>(fields[i], "a number of a range"); };
      const Tag step = fields.size() == 3 ? number(2) : 1;
      if (step < 1) in.fail_here("the step of a range is ", step, ", must be positive");
      sets.add_range(name, number(0), number(1), step, in.number());
      continue;
    }
    for (std::string_view field : fields) {
      if (const auto number = parse<Tag>(field)) {
        sets.add(name, {*number}, in.number());
      } else if (!field.empty()) {
        sets.add_set(name, std::string(field), in.number());
      }
    }
  }
}

void read_surface(InpLines& in, const Keyword& key, Raw& raw) {
  if (!key.has("NAME")) in.fail_here("*SURFACE without NAME=name");
  const std::string name = raw.surfaces.first_spelling(key.parameters.at("NAME"));
  while (in.next_data()) {
    const auto& fields = in.fields();
    const std::string label = fields.size() == 2 ? upper(fields[1]) : "";
    const bool known = label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] < '1' + kMaxSides;
    if (!known)
      in.fail_here("surface '", name, "' needs an element or element set and a face S1..S6, found '",
                   fields.size() > 1 ? fields[1] : "", "'");
    raw.surface_lines.push_back({name, std::string(fields[0]), label[1] - '1', in.number()});
  }
}

void ignore(InpLines& in, const Keyword& key, Raw& raw) {
  const bool has_data = in.next_data();
  if (has_data && key.name == "INSTANCE")
    in.fail_here("*INSTANCE with a translation or rotation is not supported");
  while (has_data && in.next_data()) continue;
  raw.ignored.push_back("*" + key.name + " (line " + std::to_string(key.line) + ")");
}

void read_keyword(InpLines& in, Raw& raw) {
  const Keyword key = in.keyword();
  if (key.name == "NODE") return read_nodes(in, key, raw);
  if (key.name == "ELEMENT") return read_elements(in, key, raw);
  if (key.name == "NSET") return read_set(in, key, raw.node_sets);
  if (key.name == "ELSET") return read_set(in, key, raw.cell_sets);
  if (key.name == "INCLUDE") in.fail_here("*INCLUDE is not supported, the mesh must stand in one file");
  const bool by_element = !key.has("TYPE") || upper(key.parameters.at("TYPE")) == "ELEMENT";
  if (key.name == "SURFACE" && by_element) return read_surface(in, key, raw);
  ignore(in, key, raw);
}

// Our own files announce their last line, so that a cut at a line end is noticed.
void check_end(const std::string& path, const std::string& content, Raw& raw) {
  if (content.starts_with(inp_format::kFirstLine))
    require(content.ends_with(inp_format::kLastLine), path, ": the file ends before its last line '",
            inp_format::kLastLine.substr(0, inp_format::kLastLine.size() - 1), "': it is truncated");
  if (!content.ends_with('\n')) raw.ignored.push_back("the last line has no line end: truncated?");
}

void build_surfaces(const InpLines& in, const Raw& raw, const TagTable& cells, Mesh& mesh) {
  for (const auto& [key, name] : raw.surfaces.spelling) mesh.face_sets[name];
  for (const SurfaceLine& line : raw.surface_lines) {
    auto& faces = mesh.face_sets[line.name];
    const auto add = [&](int cell) {
      const auto sides = cell_sides(mesh.cells.type[cell], mesh.cells[cell]);
      if (line.side >= std::ssize(sides))
        in.fail_at(line.line, "surface '", line.name, "' names side S", line.side + 1, " of a ",
                   name(mesh.cells.type[cell]), ", which has ", sides.size());
      faces.insert(faces.end(), sides[line.side].begin(), sides[line.side].end());
    };
    if (const auto number = parse<Tag>(line.members)) {
      const int cell = cells.find(*number);
      if (cell < 0)
        in.fail_at(line.line, "surface '", line.name, "' names element ", *number,
                   ", which the file does not define");
      add(cell);
    } else {
      const std::string* set = raw.cell_sets.spelling(line.members);
      if (!set)
        in.fail_at(line.line, "surface '", line.name, "' names the unknown element set '", line.members, "'");
      for (int cell : mesh.cell_sets.at(*set)) add(cell);
    }
  }
}

Mesh build(const std::string& path, const InpLines& in, const Raw& raw, double unit_in_m) {
  const TagTable nodes(raw.node, "node", path), cells(raw.cell, "element", path);
  require(cells.size() > 0, path, ": the mesh has no solid elements (C3D...)");
  Mesh mesh;
  mesh.X.resize(3, nodes.size());
  for (int i = 0; i < nodes.size(); ++i)
    mesh.X.col(i) = unit_in_m * Eigen::Map<const Eigen::Vector3d>(&raw.X[3 * nodes.position(i)]);
  for (int i = 0; i < cells.size(); ++i) {
    const int at = cells.position(i);
    std::vector<int> cell_nodes;
    for (std::size_t k = raw.cell_offset[at]; k < raw.cell_offset[at + 1]; ++k)
      cell_nodes.push_back(
          nodes.at(raw.cell_node[k], [&] { return "element " + std::to_string(raw.cell[at]); }));
    mesh.cells.add(raw.cell_type[at], cell_nodes);
  }
  const auto fail_at = [&](int line, const std::string& text) { in.fail_at(line, text); };
  mesh.node_sets = raw.node_sets.resolve(nodes, {}, fail_at);
  mesh.cell_sets =
      raw.cell_sets.resolve(cells, {raw.other_elements.begin(), raw.other_elements.end()}, fail_at);
  build_surfaces(in, raw, cells, mesh);
  validate(mesh, path);
  return mesh;
}

}  // namespace

Mesh read_inp(const std::string& path, double unit_in_m, ReadReport* report) {
  std::string content = read_file(path);
  Raw raw;
  check_end(path, content, raw);
  InpLines in(path, std::move(content));
  while (in.next()) {
    if (!in.at_keyword()) in.fail_here("data before the first keyword");
    read_keyword(in, raw);
  }
  Mesh mesh = build(path, in, raw, unit_in_m);
  if (!report) return mesh;
  std::sort(raw.node.begin(), raw.node.end());
  report->node_number = std::move(raw.node);
  report->ignored = std::move(raw.ignored);
  return mesh;
}

}  // namespace elastogear::mesh
