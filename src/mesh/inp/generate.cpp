#include "mesh/inp/generate.h"

#include <algorithm>
#include <array>
#include <optional>

namespace elastogear::mesh {
namespace {

constexpr Tag kLargest = 1'000'000'000'000'000;  // number or step, so that sums of two stay integers
constexpr int kRows = 3;                         // rows, layers, blocks

std::size_t position_of(const InpLines& in, Positions& positions, const std::vector<Tag>& numbers, Tag number,
                        const char* kind) {
  const auto found = positions.find(numbers, number);
  if (!found) in.fail_here(kind, " ", number, " is not defined above");
  return *found;
}

// a + n * step, which must be an integer of 64 bits.
Tag stepped(const InpLines& in, Tag a, Tag n, Tag step) {
  Tag product = 0, sum = 0;
  if (__builtin_mul_overflow(n, step, &product) || __builtin_add_overflow(a, product, &sum))
    in.fail_here("*ELGEN in steps of ", step, " from ", a, " reaches numbers beyond 64 bits");
  return sum;
}

using Counts = std::array<Tag, kRows>;

// The product of the counts, taken off what the deck may still generate.
Tag spend(const InpLines& in, InpDeck& deck, const char* keyword, const Counts& n) {
  const Tag most = deck.left_to_generate;
  if (n[0] > most || n[1] > most / n[0] || n[2] > most / n[0] / n[1])
    in.fail_here(keyword, " of ", n[0], " x ", n[1], " x ", n[2], ", where *NGEN and *ELGEN may make ", most,
                 " more nodes and elements: no sensible mesh has as many");
  deck.left_to_generate -= n[0] * n[1] * n[2];
  return n[0] * n[1] * n[2];
}

// The line's numbers; fields that are empty or missing have the values of `fallback`.
template <std::size_t n>
std::array<Tag, n> integers(InpLines& in, std::array<Tag, n> fallback) {
  const auto& fields = in.fields();
  if (fields.size() > n) in.fail_here("more than ", n, " numbers");
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!fields[i].empty()) fallback[i] = in.parse_field<Tag>(fields[i], "a number");
  for (const Tag number : fallback)
    if (number < -kLargest || number > kLargest) in.fail_here("the number ", number, " is beyond ", kLargest);
  return fallback;
}

// An element of which others are made.
struct Master {
  CellType type;
  std::vector<Tag> nodes;
  std::optional<CellNodes> collapsed;
};

Master master_of(const InpDeck& deck, std::size_t at) {
  const auto node = [&](std::size_t i) { return deck.cell_node.begin() + static_cast<std::ptrdiff_t>(i); };
  Master master{deck.cell_type[at], {node(deck.cell_offset[at]), node(deck.cell_offset[at + 1])}, {}};
  if (const auto element = deck.collapsed.find(deck.cell[at]); element != deck.collapsed.end())
    master.collapsed = element->second;
  return master;
}

// The element with the nodes whose numbers are larger by `shift`.
void add_copy(const InpLines& in, InpDeck& deck, const Master& master, Tag number, Tag shift) {
  Master copy = master;
  for (Tag& node : copy.nodes) node = stepped(in, node, 1, shift);
  deck.add_cell(copy.type, number, copy.nodes);
  if (!copy.collapsed) return;
  for (Tag& node : copy.collapsed->nodes) node = stepped(in, node, 1, shift);
  deck.collapsed[number] = *copy.collapsed;
}

}  // namespace

void generate_nodes(InpLines& in, const Keyword& key, InpDeck& deck) {
  while (in.next_data()) {
    const auto [first, last, given] = integers<3>(in, {0, 0, 1});
    const Tag step = last < first ? -std::abs(given) : std::abs(given);
    if (step == 0 || (last - first) % step != 0)
      in.fail_here("*NGEN from node ", first, " to ", last, " in steps of ", given, " does not end there");
    const Tag n = (last - first) / step;
    const std::size_t a = position_of(in, deck.node_at, deck.node, first, "node"),
                      b = position_of(in, deck.node_at, deck.node, last, "node");
    spend(in, deck, "*NGEN", {std::max<Tag>(n, 1), 1, 1});
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
    const Counts n = {std::max<Tag>(f[1], 1), std::max<Tag>(f[4], 1), std::max<Tag>(f[7], 1)};
    const std::size_t at = position_of(in, deck.cell_at, deck.cell, f[0], "element of a solid,");
    const Tag n_elements = spend(in, deck, "*ELGEN", n);
    const Master master = master_of(deck, at);
    std::vector<Tag> members{f[0]};
    for (Tag i = 1; i < n_elements; ++i) {
      const Tag at_row[kRows] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
      Tag number = f[0], shift = 0;
      for (std::size_t k = 0; k < kRows; ++k) {
        shift = stepped(in, shift, at_row[k], f[2 + 3 * k]);
        number = stepped(in, number, at_row[k], f[3 + 3 * k]);
      }
      add_copy(in, deck, master, number, shift);
      members.push_back(number);
    }
    if (key.has("ELSET")) deck.cell_sets.add(key.parameters.at("ELSET"), members, in.number());
  }
}

}  // namespace elastogear::mesh
