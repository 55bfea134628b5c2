#include "elastogear/mesh/named_nodes.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/base/text.h"

namespace elastogear::mesh {
namespace {

std::vector<int> nodes_of(const std::vector<Face>& faces) {
  std::vector<int> nodes;
  for (const Face& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
  sort_unique(nodes);
  return nodes;
}

std::string shown(const std::string& name) { return name.find(',') == name.npos ? name : '"' + name + '"'; }

template <class Set>
std::string names(const std::map<std::string, Set>& sets) {
  return sets.empty() ? "none" : join(sets, ", ", [](const auto& entry) { return shown(entry.first); });
}

// Names with commas are taken for several where they are named without quotes.
std::string remedy_for_commas(const Mesh& mesh) {
  const auto example = [](const auto& sets) -> std::string {
    for (const auto& [name, members] : sets)
      if (name.find(',') != name.npos)
        return "; a list has names with commas between quotes, '" + shown(name) + "'";
    return "";
  };
  const std::string of_nodes = example(mesh.node_sets);
  return of_nodes.empty() ? example(mesh.face_sets) : of_nodes;
}

}  // namespace

NamedNodes named_nodes(const Mesh& mesh, const std::string& name) {
  const auto nodes = mesh.node_sets.find(name);
  const auto faces = mesh.face_sets.find(name);
  const bool in_nodes = nodes != mesh.node_sets.end(), in_faces = faces != mesh.face_sets.end();
  require(in_nodes || in_faces, "the mesh has no node set and no face set '", name,
          "'; its node sets: ", names(mesh.node_sets), "; its face sets: ", names(mesh.face_sets),
          remedy_for_commas(mesh));
  const std::vector<int> of_faces = in_faces ? nodes_of(faces->second) : std::vector<int>();
  if (!in_nodes) return {of_faces, true, 0};
  return {nodes->second, false,
          in_faces && of_faces != nodes->second ? static_cast<int>(of_faces.size()) : 0};
}

bool names_nodes(const Mesh& mesh, const std::string& name) {
  return mesh.node_sets.contains(name) || mesh.face_sets.contains(name);
}

}  // namespace elastogear::mesh
