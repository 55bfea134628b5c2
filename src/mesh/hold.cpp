#include "elastogear/mesh/hold.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/mesh/named_nodes.h"

namespace elastogear::mesh {
namespace {

constexpr std::string_view kNames = "xyz";

}  // namespace

std::string direction_names(Directions directions) {
  std::string names;
  for (int d = 0; d < 3; ++d)
    if (holds(directions, d)) names += kNames[static_cast<std::size_t>(d)];
  return names;
}

Hold parse_hold(const Mesh& mesh, const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == text.npos || names_nodes(mesh, text)) return {text};
  Hold hold{text.substr(0, colon), 0};
  const std::string letters = text.substr(colon + 1);
  for (char letter : letters) {
    const std::size_t direction = kNames.find(letter);
    require(direction != kNames.npos, "restraint '", text, "': '", letters,
            "' must be directions of the mesh, as in ", hold.set, ":z or ", hold.set, ":xy");
    hold.directions = static_cast<Directions>(hold.directions | 1 << direction);
  }
  require(!letters.empty(), "restraint '", text, "': directions are missing behind the colon, as in ",
          hold.set, ":z or ", hold.set, ":xy");
  return hold;
}

std::vector<Directions> held_by(const Mesh& mesh, const std::vector<std::string>& holds) {
  std::vector<Directions> held(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const std::string& text : holds) {
    const Hold hold = parse_hold(mesh, text);
    for (int node : named_nodes(mesh, hold.set).node)
      held[node] = static_cast<Directions>(held[node] | hold.directions);
  }
  return held;
}

bool has_single_directions(const std::vector<Directions>& held) {
  return std::any_of(held.begin(), held.end(), [](Directions d) { return d != 0 && d != kAllDirections; });
}

}  // namespace elastogear::mesh
