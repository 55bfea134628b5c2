#include "elastogear/gear/worm.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "elastogear/base/error.h"
#include "gear/assembly.h"
#include "gear/second_order.h"
#include "gear/worm/worm_grid.h"

namespace elastogear::gear {
namespace {

// The mesh under construction. Nodes are numbered as cells ask for them.
struct Builder {
  WormGrid g;
  mesh::Mesh mesh;
  std::vector<Polar> place;  // of all nodes
  std::vector<std::array<int, 5>> key;
  std::map<std::array<int, 5>, int> number;

  // A left-handed worm is the image of a right-handed one, its angles changed in sign.
  int hand() const { return g.design.hand == Hand::left ? -1 : 1; }

  Eigen::Vector3d position(const Polar& x) const {
    const double theta = hand() * x.phi + g.geometry.worm.theta_1;
    return {x.r * std::cos(theta), x.r * std::sin(theta), x.z};
  }

  int node(const std::array<int, 5>& of_node, const Polar& x) {
    const auto [at, is_new] = number.try_emplace(of_node, static_cast<int>(place.size()));
    if (is_new) {
      place.push_back(x);
      key.push_back(of_node);
    }
    return at->second;
  }
};

enum Part { kCore, kTooth, kShaft };

int core_node(Builder& b, HelixNode node, int row) {
  node = canonical(b.g.helix, node);
  return b.node({kCore, node.k, node.j, row, 0}, core_position(b.g, node, row));
}

// Thread i stands on tooth t = -i of the axial section.
int tooth_node(Builder& b, int thread, int J, int q, int row) {
  const WormGrid& g = b.g;
  const int k = -thread * g.columns;
  if (row == 0) return core_node(b, {k + q, J - g.helix.m * k}, g.n.ring);
  return b.node({kTooth, thread, J, q, row}, tooth_position(g, thread, J, q, row));
}

int shaft_node(Builder& b, int end, int ring, int column, int row) {
  const WormGrid& g = b.g;
  const int sign = end == 0 ? -1 : 1;
  column %= static_cast<int>(g.treads.size());
  if (ring == 0) return core_node(b, {sign * g.treads[column].k, sign * g.treads[column].j}, row);
  return b.node({kShaft, end, ring, column, row}, shaft_position(g, end, ring, column, row));
}

// Corner order (r, phi, z): node(dr, dphi, dz).
template <class Node>
std::vector<mesh::Face> add_cell(Builder& b, Node node) {
  std::array<int, 8> nodes = {node(0, 0, 0), node(1, 0, 0), node(1, 1, 0), node(0, 1, 0),
                              node(0, 0, 1), node(1, 0, 1), node(1, 1, 1), node(0, 1, 1)};
  if (b.hand() < 0)
    for (int corner : {1, 5}) std::swap(nodes[corner], nodes[corner + 2]);
  return add_hex(b.mesh, nodes);
}

void add_core(Builder& b) {
  const Helix& h = b.g.helix;
  for (int j = 0; j < h.turn(); ++j)
    for (int k = h.bottom(j); k < h.top(j); ++k)
      for (int row = 0; row < b.g.n.ring; ++row)
        add_cell(b, [&](int dr, int dphi, int dz) { return core_node(b, {k + dz, j + dphi}, row + dr); });
}

// Threads are numbered counter-clockwise.
std::string thread_name(const Builder& b, const char* prefix, int thread) {
  const int z1 = b.g.design.z1;
  return numbered(prefix, b.hand() > 0 ? thread : (z1 - thread) % z1, z1);
}

void add_threads(Builder& b) {
  const WormGrid& g = b.g;
  const int half = g.tooth_grid.half_tooth;
  for (int thread = 0; thread < g.design.z1; ++thread)
    for (int J = -g.half_thread; J < g.half_thread; ++J)
      for (int q = -half; q < half; ++q)
        for (int row = 0; row < g.tooth_grid.rows; ++row) {
          const auto faces = add_cell(
              b, [&](int dr, int dphi, int dz) { return tooth_node(b, thread, J + dphi, q + dz, row + dr); });
          const std::string name = thread_name(b, "thread", thread);
          const bool right = b.hand() > 0;
          if (row >= g.n.fillet && q == -half) add_flank(b.mesh, faces[0], name, right ? "left" : "right");
          if (row >= g.n.fillet && q == half - 1) add_flank(b.mesh, faces[1], name, right ? "right" : "left");
        }
}

void add_shaft(Builder& b, int end) {
  const WormGrid& g = b.g;
  for (int ring = 0; ring + 1 < static_cast<int>(g.shaft[end].size()); ++ring)
    for (int column = 0; column < static_cast<int>(g.treads.size()); ++column)
      for (int row = 0; row < g.n.ring; ++row)
        // The lower end is the upper one turned by pi: angle and height both change sign.
        add_cell(b, [&](int dr, int dphi, int dz) {
          return shaft_node(b, end, ring + dz, column + dphi, row + dr);
        });
}

// Midside node of an edge. A node of the core beside one of a tooth is in the tooth's row 0.
Polar midside(const Builder& b, int node_1, int node_2) {
  std::array<int, 5> key_1 = b.key[node_1], key_2 = b.key[node_2];
  if (key_2[0] == kTooth) std::swap(key_1, key_2);
  if (key_1[0] == kTooth) {
    const auto [part, thread, J, q, row] = key_1;
    if (key_2[0] != kTooth) return tooth_position(b.g, thread, J, q, row - 0.5);
    return tooth_position(b.g, thread, (J + key_2[2]) / 2.0, (q + key_2[3]) / 2.0, (row + key_2[4]) / 2.0);
  }
  if (key_1[0] == kCore && key_2[0] == kCore)
    return core_midside(b.g, {key_1[1], key_1[2]}, key_1[3], {key_2[1], key_2[2]}, key_2[3]);
  return middle(b.place[node_1], b.place[node_2]);
}

void add_root(Builder& b, int thread, int node) {
  b.mesh.node_sets["root"].push_back(node);
  b.mesh.node_sets[thread_name(b, "root", thread)].push_back(node);
}

void add_root_set(Builder& b) {
  const WormGrid& g = b.g;
  for (int thread = 0; thread < g.design.z1; ++thread)
    for (int J = -g.half_thread; J <= g.half_thread; ++J)
      for (int side : {-1, 1}) {
        for (int row = 0; row <= g.n.fillet; ++row)
          add_root(b, thread, tooth_node(b, thread, J, side * g.tooth_grid.half_tooth, row));
        for (int q = g.tooth_grid.half_tooth + 1; q <= g.tooth_grid.fillet_end; ++q)
          add_root(b, thread, tooth_node(b, thread, J, side * q, 0));
      }
}

void add_seat_sets(Builder& b) {
  const Design& d = b.g.design;
  const double from[] = {-d.seat_1_end, d.seat_2_begin}, to[] = {-d.seat_1_begin, d.seat_2_end};
  for (int end : {0, 1})
    for (int ring = 0; ring < static_cast<int>(b.g.shaft[end].size()); ++ring) {
      const double z = b.g.shaft[end][ring].z;
      if (z < from[end] || z > to[end]) continue;
      for (int column = 0; column < static_cast<int>(b.g.treads.size()); ++column)
        for (const char* name : {"seats", end == 0 ? "seat_1" : "seat_2"})
          b.mesh.node_sets[name].push_back(shaft_node(b, end, ring, column, b.g.n.ring));
    }
}

// Counts of a mesh of 8-node hexahedra for a worm of two starts.
WormCounts equal_counts(Size size) {
  WormCounts n;
  if (size == Size::small)
    n = {.tooth = 4, .space = 3, .flank = 7, .fillet = 2, .ring = 3, .turn = 40, .shaft = 18};
  if (size == Size::medium)
    n = {.tooth = 6, .space = 3, .flank = 7, .fillet = 2, .ring = 3, .turn = 48, .shaft = 22};
  if (size == Size::paper)
    n = {.tooth = 8, .space = 4, .flank = 14, .fillet = 3, .ring = 5, .turn = 64, .shaft = 36};
  return n;
}

// Counts of a mesh of 20-node hexahedra, which below the fillet are as deep as they are long and grow
// inwards.
WormCounts graded_counts(Size size) {
  WormCounts n{.tooth = 4, .order = 2, .growth = 4, .tooth_growth = 4};
  if (size == Size::small) {
    n.space = n.fillet = 2;
    n.flank = n.ring = 3;
    n.turn = 32;
    n.growth = 3;
  }
  if (size == Size::medium) {
    n.space = n.flank = n.fillet = 3;
    n.ring = 4;
    n.turn = 40;
    n.growth = 3;
    n.tooth_growth = 8;
  }
  if (size == Size::paper) {
    n.tooth = 6;
    n.space = 2;
    n.fillet = 3;
    n.flank = n.ring = 4;
    n.turn = 40;
    n.growth = n.tooth_growth = 3;
  }
  return n;
}

// Sections per turn next to those of the counts that a worm of z1 starts can have.
WormCounts with_whole_turn(WormCounts n, int z1) {
  const int columns = z1 * (2 * n.space + n.tooth);
  n.turn = columns * std::max(2L, std::lround(static_cast<double>(n.turn) / columns));
  return n;
}

}  // namespace

WormCounts worm_counts(Size size, int z1, int order) {
  require(z1 >= 1, "z1 = ", z1, ": the worm needs at least 1 start");
  check_order("worm", order);
  return with_whole_turn(order == 2 ? graded_counts(size) : equal_counts(size), z1);
}

WormCounts refined(WormCounts n, int z1, double times) {
  if (times == 1) return n;
  n.tooth = 2 * refined(n.tooth / 2, times);
  for (int* count : {&n.space, &n.flank, &n.fillet, &n.ring, &n.turn}) *count = refined(*count, times);
  n.shaft = refined(n.shaft, std::sqrt(times));
  for (double* growth : {&n.growth, &n.tooth_growth}) *growth = refined_growth(*growth, times);
  return with_whole_turn(n, z1);
}

mesh::Mesh worm_mesh(const Design& design, const WormCounts& counts) {
  Builder b{.g = worm_grid(design, counts), .mesh = {}, .place = {}, .key = {}, .number = {}};
  add_core(b);
  add_threads(b);
  for (int end : {0, 1}) add_shaft(b, end);
  add_root_set(b);
  add_seat_sets(b);
  sort_node_sets(b.mesh);
  b.mesh.X.resize(3, static_cast<Eigen::Index>(b.place.size()));
  for (std::size_t node = 0; node < b.place.size(); ++node)
    b.mesh.X.col(static_cast<Eigen::Index>(node)) = b.position(b.place[node]);
  std::vector<int>& body = b.mesh.cell_sets["body"];
  for (int cell = 0; cell < b.mesh.cells.size(); ++cell) body.push_back(cell);
  if (counts.order == 2)
    b.mesh =
        second_order(b.mesh, [&](int node_1, int node_2) { return b.position(midside(b, node_1, node_2)); });
  check_cells(b.mesh, "worm");
  return b.mesh;
}

}  // namespace elastogear::gear
