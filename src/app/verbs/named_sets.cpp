#include "app/verbs/named_sets.h"

#include <algorithm>

#include "app/console/console.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/mesh/hold.h"
#include "elastogear/mesh/named_nodes.h"

namespace elastogear::app {
namespace {

std::string nodes(std::size_t n) { return std::to_string(n) + (n == 1 ? " node" : " nodes"); }

void print_named_set(const mesh::Mesh& mesh, const std::string& what, const std::string& name,
                     const std::string& how) {
  if (!mesh::names_nodes(mesh, name)) return;
  const mesh::NamedNodes meant = mesh::named_nodes(mesh, name);
  require(!meant.node.empty(), what, " '", name, "': the set is empty");
  print_item(what,
             name + how + ": " + (meant.of_faces ? "face set, " : "node set, ") + nodes(meant.node.size()));
  if (meant.other_of_faces > 0)
    print_item("warning", "'" + name + "' is a node set of " + nodes(meant.node.size()) +
                              " and a face set of " + nodes(static_cast<std::size_t>(meant.other_of_faces)) +
                              ": the node set is taken; rename one in the mesh to take the other");
}

}  // namespace

void add_numbered_nodes(mesh::Mesh& mesh, const std::vector<std::int64_t>& numbers, const std::string& option,
                        const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto number = parse<std::int64_t>(name);
    if (!number || mesh::names_nodes(mesh, name)) continue;
    const auto at = std::lower_bound(numbers.begin(), numbers.end(), *number);
    require(at != numbers.end() && *at == *number, "option -", option, ": '", name,
            "' is no set of the mesh, and there is no node of this number");
    mesh.node_sets[name] = {static_cast<int>(at - numbers.begin())};
  }
}

std::vector<std::string> restrained_sets(const mesh::Mesh& mesh, const std::vector<std::string>& restrain) {
  std::vector<std::string> sets;
  for (const std::string& text : restrain) sets.push_back(mesh::parse_hold(mesh, text).set);
  return sets;
}

void print_restraint(const mesh::Mesh& mesh, const std::vector<std::string>& restrain) {
  if (mesh.n_nodes() == 0) return;  // other ranks
  for (const std::string& text : restrain) {
    const mesh::Hold hold = mesh::parse_hold(mesh, text);
    const bool whole = hold.directions == mesh::kAllDirections;
    print_named_set(mesh, "restrained", hold.set,
                    whole ? "" : " in " + mesh::direction_names(hold.directions));
  }
}

void print_named_sets(const mesh::Mesh& mesh, const std::string& what,
                      const std::vector<std::string>& names) {
  for (const std::string& name : names) print_named_set(mesh, what, name, "");
}

}  // namespace elastogear::app
