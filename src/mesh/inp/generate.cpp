#include "mesh/inp/generate.h"

#include <algorithm>
#include <array>

namespace elastogear::mesh {
namespace {

constexpr Tag kMostGenerated = 10'000'000;  // nodes or elements of one line
constexpr int kRows = 3;                    // rows, layers, blocks

std::size_t position_of(const InpLines& in, const std::vector<Tag>& numbers, Tag number, const char* kind) {
  // Those that generate stand right behind their masters.
  const auto found = std::find(numbers.rbegin(), numbers.rend(), number);
  if (found == numbers.rend()) in.fail_here(kind, " ", number, " is not defined above");
  return static_cast<std::size_t>(numbers.rend() - found) - 1;
}

// The line's numbers; fields that are empty or missing have the values of `fallback`.
template <std::size_t n>
std::array<Tag, n> integers(InpLines& in, std::array<Tag, n> fallback) {
  const auto& fields = in.fields();
  if (fields.size() > n) in.fail_here("more than ", n, " numbers");
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!fields[i].empty()) fallback[i] = in.parse_field<Tag>(fields[i], "a number");
  return fallback;
}

}  // namespace

void generate_nodes(InpLines& in, const Keyword& key, InpDeck& deck) {
  while (in.next_data()) {
    const auto [first, last, given] = integers<3>(in, {0, 0, 1});
    const Tag step = last < first ? -std::abs(given) : std::abs(given);
    if (step == 0 || (last - first) % step != 0)
      in.fail_here("*NGEN from node ", first, " to ", last, " in steps of ", given, " does not end there");
    const Tag n = (last - first) / step;
    if (n > kMostGenerated) in.fail_here("*NGEN of ", n, " nodes: no sensible mesh has as many in a line");
    const std::size_t a = position_of(in, deck.node, first, "node"),
                      b = position_of(in, deck.node, last, "node");
    const std::array<double, 3> A = {deck.X[3 * a], deck.X[3 * a + 1], deck.X[3 * a + 2]},
                                B = {deck.X[3 * b], deck.X[3 * b + 1], deck.X[3 * b + 2]};
    std::vector<Tag> members{first, last};
    for (Tag i = 1; i < n; ++i) {
      members.push_back(first + i * step);
      deck.node.push_back(members.back());
      const double t = static_cast<double>(i) / static_cast<double>(n);
      for (std::size_t k = 0; k < 3; ++k) deck.X.push_back((1 - t) * A[k] + t * B[k]);
    }
    if (key.has("NSET")) deck.node_sets.add(key.parameters.at("NSET"), members, in.number());
  }
}

void generate_elements(InpLines& in, const Keyword& key, InpDeck& deck) {
  while (in.next_data()) {
    const auto f = integers<1 + 3 * kRows>(in, {0, 1, 1, 1, 1, 0, 0, 1, 0, 0});
    const Tag n[kRows] = {std::max<Tag>(f[1], 1), std::max<Tag>(f[4], 1), std::max<Tag>(f[7], 1)};
    if (n[0] > kMostGenerated || n[1] > kMostGenerated / n[0] || n[2] > kMostGenerated / n[0] / n[1])
      in.fail_here("*ELGEN of ", n[0], " x ", n[1], " x ", n[2], " elements: no sensible mesh has as many");
    const std::size_t at = position_of(in, deck.cell, f[0], "element of a solid,");
    const CellType type = deck.cell_type[at];
    const std::vector<Tag> master(
        deck.cell_node.begin() + static_cast<std::ptrdiff_t>(deck.cell_offset[at]),
        deck.cell_node.begin() + static_cast<std::ptrdiff_t>(deck.cell_offset[at + 1]));
    std::vector<Tag> members{f[0]};
    for (Tag i = 1; i < n[0] * n[1] * n[2]; ++i) {
      const Tag at_row[kRows] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
      Tag number = f[0], shift = 0;
      for (int k = 0; k < kRows; ++k) {
        shift += at_row[k] * f[2 + 3 * k];
        number += at_row[k] * f[3 + 3 * k];
      }
      std::vector<Tag> nodes = master;
      for (Tag& node : nodes) node += shift;
      deck.add_cell(type, number, nodes);
      if (const auto element = deck.collapsed.find(f[0]); element != deck.collapsed.end()) {
        CellNodes& copy = deck.collapsed[number] = element->second;
        for (Tag& node : copy.nodes) node += shift;
      }
      members.push_back(number);
    }
    if (key.has("ELSET")) deck.cell_sets.add(key.parameters.at("ELSET"), members, in.number());
  }
}

}  // namespace elastogear::mesh
