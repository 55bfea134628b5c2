#include "mesh/inp/cards/others.h"

#include <algorithm>
#include <array>

#include "mesh/inp/cards/boundary.h"
#include "mesh/raw/face_owner.h"

namespace elastogear::mesh {
namespace {

constexpr std::string_view kMass = "MASS";
// Plane elements, shells, membranes and rigid faces; their nodes are those of a cell's side in order.
constexpr std::array<std::string_view, 9> kPlane = {"CPS", "CPE",   "CAX", "S",   "STRI",
                                                    "M3D", "SFM3D", "R3D", "DC2D"};

bool is_plane(const std::string& type, std::size_t n_nodes) {
  const bool side = n_nodes == 3 || n_nodes == 4 || n_nodes == 6 || n_nodes == 8;
  return side && std::any_of(kPlane.begin(), kPlane.end(), [&](std::string_view name) {
           return type.starts_with(name) && type.size() > name.size() && std::isdigit(type[name.size()]);
         });
}

const OtherElements::Group& group_of(const OtherElements& others, const TagTable& numbers, int i) {
  return others.groups[others.element[numbers.position(i)].group];
}

// The faces of a plane element, or nothing when the file lacks a node of it.
std::vector<Face> faces_of(const std::vector<Tag>& tags, const TagTable& nodes) {
  std::vector<int> side;
  for (Tag tag : tags) {
    side.push_back(nodes.find(tag));
    if (side.back() < 0) return {};
  }
  return side_faces(side);
}

// Faces of the set's plane elements; nothing when it holds none or one of them is the side of no cell.
std::vector<Face> faces_of_set(const OtherElements& others, const TagTable& numbers,
                               const std::vector<int>& set, const TagTable& nodes) {
  std::vector<Face> faces;
  for (int i : set) {
    const OtherElement& element = others.element[numbers.position(i)];
    if (!is_plane(group_of(others, numbers, i).type, element.nodes.size())) continue;
    const std::vector<Face> of_element = faces_of(element.nodes, nodes);
    if (of_element.empty()) return {};
    faces.insert(faces.end(), of_element.begin(), of_element.end());
  }
  return faces;
}

// Takes the sets that hold a face of no cell off the mesh again.
void keep_owned(const std::vector<std::string>& names, Mesh& mesh) {
  const FaceOwners owners(mesh);
  for (const std::string& name : names) {
    const auto& faces = mesh.face_sets.at(name);
    if (!std::all_of(faces.begin(), faces.end(),
                     [&](const Face& face) { return owners.find(face).has_value(); }))
      mesh.face_sets.erase(name);
  }
}

void note_left_out(const InpLines& in, const OtherElements& others, const std::vector<bool>& used,
                   const TagTable& numbers, InpNotes& notes) {
  std::vector<char> has_unused(others.groups.size(), 0);
  for (int i = 0; i < numbers.size(); ++i)
    if (!used[i]) has_unused[others.element[numbers.position(i)].group] = 1;
  for (std::size_t g = 0; g < others.groups.size(); ++g) {
    const auto& [type, line] = others.groups[g];
    const std::string what = "*ELEMENT, TYPE=" + type;
    if (type == kMass) continue;
    if (has_unused[g])
      notes.lose(in, what, line, "left out, a body is made of solids alone");
    else
      notes.ignore(in, what, line, "faces of solids, read as face sets");
  }
}

}  // namespace

std::vector<Tag> read_other_elements(InpLines& in, const Keyword& key, OtherElements& others) {
  others.groups.push_back({key.value("TYPE"), key.line});
  const auto first = others.number.size();
  for (bool continued = false; in.next_data(); continued = in.continues()) {
    const auto& fields = in.fields();
    if (!continued) {
      others.number.push_back(in.parse_field<Tag>(fields.at(0), "an element number"));
      others.element.push_back({{}, static_cast<int>(others.groups.size()) - 1});
    }
    for (std::size_t k = continued ? 0 : 1; k < fields.size(); ++k)
      others.element.back().nodes.push_back(parse<Tag>(fields[k]).value_or(0));
  }
  return {others.number.begin() + static_cast<std::ptrdiff_t>(first), others.number.end()};
}

void read_mass(InpLines& in, const Keyword& key, OtherElements& others) {
  if (!key.has("ELSET")) in.fail_here("*MASS without ELSET=name");
  if (!in.next_data()) in.fail_at(key.line, "*MASS without a mass");
  const std::vector<double> values = in.reals("a mass");
  if (values.empty() || values[0] < 0) in.fail_here("a mass is negative or missing");
  if (values[0] > 0) others.masses.push_back({key.parameters.at("ELSET"), values[0], key.line});
  if (in.next_data()) in.fail_here("*MASS with more than one line");
}

void add_faces(const InpLines& in, const OtherElements& others, const TagTable& numbers,
               const OtherSets& sets, const TagTable& nodes, Mesh& mesh, InpNotes& notes) {
  std::vector<std::string> names;
  for (const auto& [name, members] : sets) {
    if (mesh.face_sets.contains(name)) continue;
    std::vector<Face> faces = faces_of_set(others, numbers, members, nodes);
    if (faces.empty()) continue;
    mesh.face_sets[name] = std::move(faces);
    names.push_back(name);
  }
  keep_owned(names, mesh);
  orient_faces(mesh);
  std::vector<bool> used(static_cast<std::size_t>(numbers.size()), false);
  for (const std::string& name : names)
    if (mesh.face_sets.contains(name))
      for (int i : sets.at(name))
        used[i] =
            is_plane(group_of(others, numbers, i).type, others.element[numbers.position(i)].nodes.size());
  note_left_out(in, others, used, numbers, notes);
}

void add_masses(const InpLines& in, const OtherElements& others, const TagTable& numbers,
                const InpSets& cell_sets, const OtherSets& sets, const TagTable& nodes, double unit_in_m,
                Mesh& mesh, ReadReport& report) {
  std::map<int, double> mass_of;  // by node, kg
  for (const MassCard& card : others.masses) {
    const std::string* set = cell_sets.spelling(card.members);
    if (!set) in.fail_at(card.line, "*MASS names the unknown element set '", card.members, "'");
    const auto members = sets.find(*set);
    for (int i : members == sets.end() ? std::vector<int>() : members->second) {
      const OtherElement& element = others.element[numbers.position(i)];
      const int node = element.nodes.size() == 1 ? nodes.find(element.nodes[0]) : -1;
      if (others.groups[element.group].type != kMass || node < 0)
        in.fail_at(card.line, "*MASS: element ", numbers.tags()[static_cast<std::size_t>(i)],
                   " is no element of type MASS on a node of the file");
      mass_of[node] += card.mass / unit_in_m;  // N s^2 per unit of length
    }
  }
  std::map<double, std::vector<int>> nodes_with;
  for (const auto& [node, mass] : mass_of) nodes_with[mass].push_back(node);
  for (const auto& [mass, members] : nodes_with) {
    const std::string name = unused_name(mesh, "MASS");
    report.point_mass[name] = mass * static_cast<double>(members.size());
    mesh.node_sets[name] = members;
  }
}

}  // namespace elastogear::mesh
