#include "elastogear/gear/worm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "assembly.h"
#include "comb.h"
#include "elastogear/base/error.h"
#include "helix.h"

namespace elastogear::gear {
namespace {

constexpr double kPi = std::numbers::pi;

// The end of the helical layers, chosen for the best shape of the cells there.
constexpr int kPlainLayers = 1;         // layers between the last thread's pitch and the steps
constexpr double kSinking = 0.4;        // at the bore, part of the last pitch by which the layers sink
constexpr double kSinkingLength = 0.5;  // of a pitch: the shaft's rings are flat again beyond it
constexpr double kFade = 0.06;          // of a turn: the tooth's footprint in the core ends within it

constexpr int kMaxCount = 1000;  // of one kind of elements

// Cylinder coordinates; phi is counted from tooth 1's centre at z = 0.
struct Polar {
  double phi, z, r;
};

// A ring of the plain shaft: z is counted outwards on either end.
struct Ring {
  double z, r;
};

struct Grid {
  Design design;
  Geometry geometry;
  WormCounts n;
  Comb comb;
  Helix helix;
  int columns = 0;      // layers per axial pitch
  int half_thread = 0;  // sections from the middle of a thread to its end
  double layer = 0;     // m, axial pitch / columns
  std::vector<HelixNode> treads;
  std::vector<Ring> shaft[2];
};

void check_counts(const WormCounts& n, int z1) {
  for (int count : {n.tooth, n.space, n.flank, n.fillet, n.ring, n.shaft})
    require(count >= 1 && count <= kMaxCount, "the worm's element counts must be 1 to ", kMaxCount,
            ", one is ", count);
  require(n.tooth % 2 == 0, "the worm's count tooth = ", n.tooth, " must be even");
  const int columns = z1 * (2 * n.space + n.tooth);
  require(n.turn >= 2 * columns && n.turn % columns == 0, "the worm's count turn = ", n.turn,
          " must be a multiple, at least twice, of z1 (2 space + tooth) = ", columns);
}

double row_fraction(const Grid& g, int row) { return graded(static_cast<double>(row) / g.n.ring); }

double row_radius(const Grid& g, int row, double r_outer) {
  const double bore = g.design.worm_bore / 2;
  return bore + (r_outer - bore) * row_fraction(g, row);
}

// Height where the treads stand, in layers.
double tread_height(const Grid& g) { return g.helix.top_0 + (g.helix.m + 1.0) / (2 * g.helix.m); }

// Near the bore the helices are steep. Towards the upper end the inner layers are made thinner (the whole
// stack sinks towards the bore), which flattens them and so keeps the cells at the steps open.
double sunk(const Grid& g, double height, int row) {
  const double x = std::max(0.0, 1 - (tread_height(g) - height) / g.columns);
  return kSinking * g.geometry.p_x * (1 - row_fraction(g, row)) * x * x;
}

// 1 where tooth t stands on section j, falling to 0 within a part of a turn beyond its end.
double tooth_weight(const Grid& g, int t, int j) {
  const int beyond = std::abs(g.helix.m * t * g.columns + j) - g.half_thread;
  return std::clamp(1 - beyond / (kFade * g.n.turn), 0.0, 1.0);
}

Polar inner_position(const Grid& g, HelixNode node, int row) {
  const int t = floor_div(node.k + g.comb.half_pitch, g.columns), q = node.k - t * g.columns;
  const double weight = tooth_weight(g, t, node.j);
  const Eigen::Vector2d plain(q * g.layer, row_radius(g, row, g.geometry.worm.r_f));
  const Eigen::Vector2d x = plain + weight * (g.comb.strip_point(q, row) - plain);
  const double section = static_cast<double>(node.j) / g.helix.m;
  return {2 * kPi * node.j / g.n.turn,
          x[0] + (t * g.columns + section) * g.layer - sunk(g, node.k + section, row), x[1]};
}

// Equally spaced in angle.
Polar rim_position(const Grid& g, HelixNode node, int row) {
  const int m = g.helix.m;
  const double j = node.j / m * m + 0.5 + (node.j % m - 1) * static_cast<double>(m) / (m - 1);
  return {2 * kPi * j / g.n.turn, tread_height(g) * g.layer - sunk(g, tread_height(g), row),
          row_radius(g, row, g.geometry.worm.r_f)};
}

Polar position(const Grid& g, HelixNode node, int row);

// The foot of a step goes to the mean of its three neighbours.
Polar step_position(const Grid& g, HelixNode foot, int row) {
  Polar mean{0, 0, 0};
  const double phi_0 = 2 * kPi * foot.j / g.n.turn;
  for (const HelixNode& at : {HelixNode{foot.k + 1, foot.j}, {foot.k, foot.j - 1}, {foot.k - 1, foot.j}}) {
    const Polar x = position(g, canonical(g.helix, at), row);
    mean.phi += (phi_0 + std::remainder(x.phi - phi_0, 2 * kPi)) / 3;
    mean.z += x.z / 3;
    mean.r += x.r / 3;
  }
  return mean;
}

// The lower half is the upper one turned about the axis through tooth 1's centre.
Polar position(const Grid& g, HelixNode node, int row) {
  if (node.k * g.helix.m + node.j < 0) {
    const Polar x = position(g, canonical(g.helix, {-node.k, -node.j}), row);
    return {-x.phi, -x.z, x.r};
  }
  switch (kind(g.helix, node)) {
    case NodeKind::rim:
      return rim_position(g, node, row);
    case NodeKind::step:
      return step_position(g, node, row);
    case NodeKind::inner:
      break;
  }
  return inner_position(g, node, row);
}

// Rings of the plain shaft, each section between two changes of slope with its share of the layers.
std::vector<Ring> rings(const Grid& g, double seat_begin, double seat_end, double end, double r_seat,
                        double r_end) {
  const double root = g.geometry.worm.r_f, begin = tread_height(g) * g.layer, cone = g.design.shoulder;
  require(begin < seat_begin - cone, "the helical layers end ", begin,
          " m from the thread's middle, beyond the begin of a seat's shoulder at ", seat_begin - cone,
          " m: raise the columns per pitch 2 space + tooth = ", g.columns);
  const Ring stops[] = {{begin, root},      {seat_begin - cone, root}, {seat_begin, r_seat},
                        {seat_end, r_seat}, {seat_end + cone, r_end},  {end, r_end}};
  std::vector<Ring> all{stops[0]};
  for (int i = 1; i < 6; ++i) {
    const Ring &a = stops[i - 1], &b = stops[i];
    const int layers = std::max(1L, std::lround(g.n.shaft * (b.z - a.z) / (end - begin)));
    for (int l = 1; l <= layers; ++l) {
      const double x = static_cast<double>(l) / layers;
      all.push_back({std::lerp(a.z, b.z, x), std::lerp(a.r, b.r, x)});
    }
  }
  return all;
}

Grid grid(const Design& d, const WormCounts& n) {
  Grid g{.design = d, .geometry = derive(d), .n = n, .comb = {}, .helix = {}, .treads = {}, .shaft = {}};
  check_counts(n, d.z1);
  g.comb = comb(worm_profile(d, g.geometry),
                {.tooth = n.tooth, .space = n.space, .flank = n.flank, .fillet = n.fillet, .ring = n.ring});
  g.columns = 2 * g.comb.half_pitch;
  g.layer = g.geometry.p_x / g.columns;
  g.helix.K = d.z1 * g.columns;
  g.helix.m = n.turn / g.helix.K;
  g.half_thread = static_cast<int>(std::lround(d.thread_length / 2 / g.layer * g.helix.m));
  g.helix.top_0 = (g.half_thread - 1) / g.helix.m + 1 + g.comb.half_pitch + kPlainLayers;
  g.treads = treads(g.helix);
  g.shaft[0] =
      rings(g, -d.seat_1_end, -d.seat_1_begin, -d.shaft_1_end, d.seat_1_diameter / 2, d.shaft_1_diameter / 2);
  g.shaft[1] =
      rings(g, d.seat_2_begin, d.seat_2_end, d.shaft_2_end, d.seat_2_diameter / 2, d.shaft_2_diameter / 2);
  return g;
}

// The mesh under construction. Nodes are numbered as cells ask for them.
struct Builder {
  Grid g;
  mesh::Mesh mesh;
  std::vector<Eigen::Vector3d> X;
  std::map<std::array<int, 5>, int> number;

  int node(const std::array<int, 5>& key, const Polar& x) {
    const auto [at, is_new] = number.try_emplace(key, static_cast<int>(X.size()));
    const double theta = x.phi + g.geometry.worm.theta_1;
    if (is_new) X.emplace_back(x.r * std::cos(theta), x.r * std::sin(theta), x.z);
    return at->second;
  }
};

enum Block { kCore, kTooth, kShaft };

int core_node(Builder& b, HelixNode node, int row) {
  node = canonical(b.g.helix, node);
  return b.node({kCore, node.k, node.j, row, 0}, position(b.g, node, row));
}

// Thread i stands on tooth t = -i of the axial section; J counts sections along it, 0 in the thread's middle.
int tooth_node(Builder& b, int thread, int J, int q, int row) {
  const Grid& g = b.g;
  const int k = -thread * g.columns, j = J - g.helix.m * k;
  if (row == 0) return core_node(b, {k + q, j}, g.n.ring);
  const Eigen::Vector2d x = g.comb.tooth_point(q, row);
  const double z = static_cast<double>(J) / g.helix.m * g.layer;
  return b.node({kTooth, thread, J, q, row}, {2 * kPi * j / g.n.turn, z + x[0], x[1]});
}

int shaft_node(Builder& b, int end, int ring, int column, int row) {
  const Grid& g = b.g;
  const int sign = end == 0 ? -1 : 1;
  column %= static_cast<int>(g.treads.size());
  const HelixNode tread = g.treads[column];
  if (ring == 0) return core_node(b, {sign * tread.k, sign * tread.j}, row);
  const Ring& at = g.shaft[end][ring];
  const double recovery = (at.z - g.shaft[end][0].z) / (kSinkingLength * g.geometry.p_x);
  const double z = at.z - sunk(g, tread_height(g), row) * std::max(0.0, 1 - recovery);
  return b.node({kShaft, end, ring, column, row},
                {sign * rim_position(g, tread, row).phi, sign * z, row_radius(g, row, at.r)});
}

// Corner order (r, phi, z): node(dr, dphi, dz).
template <class Node>
std::vector<mesh::Face> add_cell(Builder& b, Node node) {
  return add_hex(b.mesh, {node(0, 0, 0), node(1, 0, 0), node(1, 1, 0), node(0, 1, 0), node(0, 0, 1),
                          node(1, 0, 1), node(1, 1, 1), node(0, 1, 1)});
}

void add_core(Builder& b) {
  const Helix& h = b.g.helix;
  for (int j = 0; j < h.turn(); ++j)
    for (int k = h.bottom(j); k < h.top(j); ++k)
      for (int row = 0; row < b.g.n.ring; ++row)
        add_cell(b, [&](int dr, int dphi, int dz) { return core_node(b, {k + dz, j + dphi}, row + dr); });
}

void add_threads(Builder& b) {
  const Grid& g = b.g;
  const int half = g.comb.half_tooth;
  for (int thread = 0; thread < g.design.z1; ++thread)
    for (int J = -g.half_thread; J < g.half_thread; ++J)
      for (int q = -half; q < half; ++q)
        for (int row = 0; row < g.comb.rows; ++row) {
          const auto faces = add_cell(
              b, [&](int dr, int dphi, int dz) { return tooth_node(b, thread, J + dphi, q + dz, row + dr); });
          const std::string name = numbered("thread", thread, g.design.z1);
          if (row >= g.n.fillet && q == -half) add_flank(b.mesh, faces[0], name, "left");
          if (row >= g.n.fillet && q == half - 1) add_flank(b.mesh, faces[1], name, "right");
        }
}

void add_shaft(Builder& b, int end) {
  const Grid& g = b.g;
  for (int ring = 0; ring + 1 < static_cast<int>(g.shaft[end].size()); ++ring)
    for (int column = 0; column < static_cast<int>(g.treads.size()); ++column)
      for (int row = 0; row < g.n.ring; ++row)
        // The lower end is the upper one turned by pi: angle and height both change sign.
        add_cell(b, [&](int dr, int dphi, int dz) {
          return shaft_node(b, end, ring + dz, column + dphi, row + dr);
        });
}

void add_root(Builder& b, int thread, int node) {
  b.mesh.node_sets["root"].push_back(node);
  b.mesh.node_sets[numbered("root", thread, b.g.design.z1)].push_back(node);
}

void add_root_set(Builder& b) {
  const Grid& g = b.g;
  for (int thread = 0; thread < g.design.z1; ++thread)
    for (int J = -g.half_thread; J <= g.half_thread; ++J)
      for (int side : {-1, 1}) {
        for (int row = 0; row <= g.n.fillet; ++row)
          add_root(b, thread, tooth_node(b, thread, J, side * g.comb.half_tooth, row));
        for (int q = g.comb.half_tooth + 1; q <= g.comb.fillet_end; ++q)
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

}  // namespace

WormCounts worm_counts(Size size, int z1) {
  require(z1 >= 1 && z1 <= kMaxCount, "z1 = ", z1, ": must be 1 to ", kMaxCount);
  WormCounts n;
  if (size == Size::small)
    n = {.tooth = 4, .space = 3, .flank = 7, .fillet = 2, .ring = 3, .turn = 40, .shaft = 18};
  if (size == Size::medium)
    n = {.tooth = 6, .space = 3, .flank = 7, .fillet = 2, .ring = 3, .turn = 48, .shaft = 22};
  if (size == Size::paper)
    n = {.tooth = 8, .space = 4, .flank = 14, .fillet = 3, .ring = 5, .turn = 64, .shaft = 36};
  const int columns = z1 * (2 * n.space + n.tooth);
  n.turn = columns * std::max(2L, std::lround(static_cast<double>(n.turn) / columns));
  return n;
}

mesh::Mesh worm_mesh(const Design& design, const WormCounts& counts) {
  Builder b{.g = grid(design, counts), .mesh = {}, .X = {}, .number = {}};
  add_core(b);
  add_threads(b);
  for (int end : {0, 1}) add_shaft(b, end);
  add_root_set(b);
  add_seat_sets(b);
  sort_node_sets(b.mesh);
  b.mesh.X = Eigen::Map<const Eigen::Matrix3Xd>(b.X.front().data(), 3, static_cast<Eigen::Index>(b.X.size()));
  std::vector<int>& body = b.mesh.cell_sets["body"];
  for (int cell = 0; cell < b.mesh.cells.size(); ++cell) body.push_back(cell);
  return b.mesh;
}

}  // namespace elastogear::gear
