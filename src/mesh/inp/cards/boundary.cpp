#include "mesh/inp/cards/boundary.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastogear/mesh/hold.h"

namespace elastogear::mesh {
namespace {

constexpr int kX = 1, kY = 2, kZ = 4, kAll = kAllDirections;

struct Label {
  const char* name;
  int directions;
};
constexpr Label kLabels[] = {{"ENCASTRE", kAll},  {"PINNED", kAll},   {"XSYMM", kX},
                             {"YSYMM", kY},       {"ZSYMM", kZ},      {"XASYMM", kY | kZ},
                             {"YASYMM", kX | kZ}, {"ZASYMM", kX | kY}};

std::optional<int> label_directions(const std::string& name) {
  for (const Label& label : kLabels)
    if (name == label.name) return label.directions;
  return std::nullopt;
}

// Degrees of freedom first..last; those above 3 are no displacements.
int directions_between(const InpLines& in, int first, int last) {
  if (first < 1 || last < first) in.fail_here("*BOUNDARY from degree of freedom ", first, " to ", last);
  int directions = 0;
  for (int k = first; k <= std::min(last, 3); ++k) directions |= 1 << (k - 1);
  return directions;
}

// Node or set, first and last degree of freedom, displacement; or node or set and a label.
BoundaryLine read_line(InpLines& in, InpNotes& notes) {
  const auto& f = in.fields();
  if (f.size() < 2 || f.size() > 4 || f[0].empty())
    in.fail_here("*BOUNDARY needs a node or node set and degrees of freedom");
  BoundaryLine line{std::string(f[0]), 0, in.number()};
  if (const auto label = label_directions(upper(f[1]))) {
    line.directions = *label;
    return line;
  }
  const char* const what = "a degree of freedom";
  const int first = in.parse_field<int>(f[1], what);
  const int last = f.size() > 2 && !f[2].empty() ? in.parse_field<int>(f[2], what) : first;
  const double value = f.size() > 3 && !f[3].empty() ? in.real(f[3], "a displacement") : 0;
  line.directions = directions_between(in, first, last);
  if (line.directions == 0)
    notes.ignore(in, "*BOUNDARY", in.number(), "no displacement");
  else if (value != 0)
    notes.lose(
        in, "*BOUNDARY", in.number(),
        "nodes with a displacement other than 0 are held where they are: the displacement is left out");
  return line;
}

}  // namespace

std::string unused_name(const Mesh& mesh, std::string name) {
  while (mesh.node_sets.contains(name) || mesh.face_sets.contains(name)) name += "_";
  return name;
}

void read_boundary(InpLines& in, const Keyword& key, std::vector<BoundaryLine>& boundary, InpNotes& notes) {
  const std::string type = key.value("TYPE");
  if (!type.empty() && type != "DISPLACEMENT") {
    while (in.next_data()) continue;
    notes.lose(in, "*BOUNDARY, TYPE=" + type, key.line, "what it moves is not held");
    return;
  }
  while (in.next_data()) {
    BoundaryLine line = read_line(in, notes);
    if (line.directions != 0) boundary.push_back(std::move(line));
  }
}

std::vector<Directions> held_nodes(const InpLines& in, const std::vector<BoundaryLine>& boundary,
                                   const InpSets& node_sets, const TagTable& nodes, const Mesh& mesh) {
  std::vector<Directions> held(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const BoundaryLine& line : boundary) {
    const auto number = parse<Tag>(line.members);
    const std::string* set = number ? nullptr : node_sets.spelling(line.members);
    const int node = number ? nodes.find(*number) : -1;
    if (node < 0 && !set)
      in.fail_at(line.line, "*BOUNDARY names the unknown node or node set '", line.members, "'");
    for (int i : number ? std::vector<int>{node} : mesh.node_sets.at(*set))
      held[i] = static_cast<Directions>(held[i] | line.directions);
  }
  return held;
}

void make_restraint(const std::vector<Directions>& held, Mesh& mesh, ReadReport& report) {
  for (int directions = kAll; directions > 0; --directions) {
    std::vector<int> nodes;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (held[i] == directions) nodes.push_back(i);
    if (nodes.empty()) continue;
    const std::string letters =
        directions == kAll ? "" : direction_names(static_cast<Directions>(directions));
    const std::string name = unused_name(mesh, letters.empty() ? "BOUNDARY" : "BOUNDARY_" + letters);
    mesh.node_sets[name] = std::move(nodes);
    report.restrained.push_back(letters.empty() ? name : std::string(name).append(":").append(letters));
  }
}

}  // namespace elastogear::mesh
