#include "gear/worm/worm_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/assembly.h"
#include "gear/second_order.h"
#include "gear/worm/profiles.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

// The end of the helical layers, chosen for the best shape of the cells there.
constexpr int kPlainLayers = 1;         // layers between the last thread's pitch and the steps
constexpr double kSinking = 0.4;        // at the bore, part of the last pitch by which the layers sink
constexpr double kSinkingLength = 0.5;  // of a pitch: the shaft's rings are flat again beyond it
constexpr double kFade = 0.06;          // of a turn: the tooth's footprint in the core ends within it

void check(const WormCounts& n, const Design& d, double p_x) {
  check_order("worm", n.order);
  const double section =
      (2.0 * n.space + n.tooth) * n.ring + static_cast<double>(n.tooth) * (n.fillet + n.flank);
  check_counts("worm", {n.tooth, n.space, n.flank, n.fillet, n.ring, n.shaft},
               n.turn * (section * (d.thread_length / p_x + 2) + 2.0 * n.shaft * n.ring));
  check_growth("worm", {n.growth, n.tooth_growth});
  require(n.tooth % 2 == 0, "the worm's count tooth = ", n.tooth, " must be even");
  const int columns = d.z1 * (2 * n.space + n.tooth);
  require(n.turn >= 2 * columns && n.turn % columns == 0, "the worm's count turn = ", n.turn,
          " must be a multiple, at least twice, of z1 (2 space + tooth) = ", columns);
}

double row_fraction(const WormGrid& g, double row) { return graded_row(row, g.n.ring, g.n.growth); }

double row_radius(const WormGrid& g, double row, double r_outer) {
  const double bore = g.design.worm_bore / 2;
  return bore + (r_outer - bore) * row_fraction(g, row);
}

// Height where the treads stand, in layers.
double tread_height(const WormGrid& g) { return g.helix.top_0 + (g.helix.m + 1.0) / (2 * g.helix.m); }

// Near the bore the helices are steep. Towards the upper end the inner layers are made thinner (the whole
// stack sinks towards the bore), which flattens them and so keeps the cells at the steps open.
double sunk(const WormGrid& g, double height, double row) {
  const double x = std::max(0.0, 1 - (tread_height(g) - height) / g.columns);
  return kSinking * g.geometry.p_x * (1 - row_fraction(g, row)) * x * x;
}

// 1 where tooth t stands on section j, falling to 0 within a part of a turn beyond its end.
double tooth_weight(const WormGrid& g, int t, double j) {
  const double beyond = std::abs(g.helix.m * t * g.columns + j) - g.half_thread;
  return std::clamp(1 - beyond / (kFade * g.n.turn), 0.0, 1.0);
}

// Index of a point of the tooth's grid, from that of a node or of the middle between two.
int point_index(const WormGrid& g, double index) { return static_cast<int>(std::lround(g.n.order * index)); }

// The place of a node of the worm by its indices k, j and its row; halves of them belong to midside nodes.
Polar inner_position(const WormGrid& g, double k, double j, double row) {
  const int t = static_cast<int>(std::floor((k + g.tooth_grid.half_pitch) / g.columns));
  const double q = k - t * g.columns, weight = tooth_weight(g, t, j);
  const Eigen::Vector2d plain(q * g.layer, row_radius(g, row, g.geometry.worm.r_f));
  const Eigen::Vector2d x =
      plain + weight * (g.points.strip_point(point_index(g, q), point_index(g, row)) - plain);
  const double section = j / g.helix.m;
  return {2 * pi * j / g.n.turn, x[0] + (t * g.columns + section) * g.layer - sunk(g, k + section, row),
          x[1]};
}

// Position of a node at the rim; the nodes are equally spaced in angle.
Polar rim_position(const WormGrid& g, HelixNode node, int row) {
  const int m = g.helix.m;
  const int first = node.j / m * m;
  const double j = first + 0.5 + (node.j % m - 1) * static_cast<double>(m) / (m - 1);
  return {2 * pi * j / g.n.turn, tread_height(g) * g.layer - sunk(g, tread_height(g), row),
          row_radius(g, row, g.geometry.worm.r_f)};
}

// The foot of a step goes to the mean of its three neighbours.
Polar step_position(const WormGrid& g, HelixNode foot, int row) {
  Polar mean{0, 0, 0};
  const double phi_0 = 2 * pi * foot.j / g.n.turn;
  for (const HelixNode& at : {HelixNode{foot.k + 1, foot.j}, {foot.k, foot.j - 1}, {foot.k - 1, foot.j}}) {
    const Polar x = core_position(g, canonical(g.helix, at), row);
    mean.phi += (phi_0 + std::remainder(x.phi - phi_0, 2 * pi)) / 3;
    mean.z += x.z / 3;
    mean.r += x.r / 3;
  }
  return mean;
}

// Rings of the plain shaft, each section between two changes of slope with its share of the layers.
std::vector<Ring> rings(const WormGrid& g, double seat_begin, double seat_end, double end, double r_seat,
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

// Tells whether inner_position gives the place of a node. The lower half of the worm mirrors the upper one.
bool is_inner(const WormGrid& g, HelixNode node) {
  const bool lower = node.k * g.helix.m + node.j < 0;
  return kind(g.helix, lower ? canonical(g.helix, {-node.k, -node.j}) : node) == NodeKind::inner;
}

}  // namespace

// The lower half is the upper one turned about the axis through tooth 1's centre.
Polar core_position(const WormGrid& g, HelixNode node, int row) {
  if (node.k * g.helix.m + node.j < 0) {
    const Polar x = core_position(g, canonical(g.helix, {-node.k, -node.j}), row);
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
  return inner_position(g, node.k, node.j, row);
}

// Between nodes of the lower half and of the upper one both formulas agree. Places at the steps and treads
// are not those of the formula; edges to them are on plain cylinders.
Polar core_midside(const WormGrid& g, HelixNode a, int row_a, HelixNode b, int row_b) {
  const Helix& h = g.helix;
  for (int turn : {-1, 0, 1}) {
    const HelixNode at{b.k + turn * h.K, b.j - turn * h.turn()};
    if (std::abs(at.k - a.k) > 1 || std::abs(at.j - a.j) > 1) continue;
    if (!is_inner(g, a) || !is_inner(g, b)) break;
    const double k = (a.k + at.k) / 2.0, j = (a.j + at.j) / 2.0, row = (row_a + row_b) / 2.0;
    if (k * h.m + j >= 0) return inner_position(g, k, j, row);
    const Polar x = inner_position(g, -k, -j, row);
    return {-x.phi, -x.z, x.r};
  }
  return middle(core_position(g, a, row_a), core_position(g, b, row_b));
}

Polar middle(const Polar& a, const Polar& b) {
  return {a.phi + std::remainder(b.phi - a.phi, 2 * pi) / 2, (a.z + b.z) / 2, (a.r + b.r) / 2};
}

Polar tooth_position(const WormGrid& g, int thread, double J, double q, double row) {
  const Eigen::Vector2d x = g.points.tooth_point(point_index(g, q), point_index(g, row));
  const double section = J / g.helix.m;
  return {2 * pi * (J + g.helix.m * thread * g.columns) / g.n.turn, section * g.layer + x[0], x[1]};
}

Polar shaft_position(const WormGrid& g, int end, int ring, int column, int row) {
  const int sign = end == 0 ? -1 : 1;
  const Ring& at = g.shaft[end][ring];
  const double recovery = (at.z - g.shaft[end][0].z) / (kSinkingLength * g.geometry.p_x);
  const double z = at.z - sunk(g, tread_height(g), row) * std::max(0.0, 1 - recovery);
  return {sign * rim_position(g, g.treads[column], row).phi, sign * z, row_radius(g, row, at.r)};
}

WormGrid worm_grid(const Design& d, const WormCounts& n) {
  WormGrid g{.design = d,
             .geometry = derive(d),
             .n = n,
             .tooth_grid = {},
             .points = {},
             .helix = {},
             .treads = {},
             .shaft = {}};
  check(n, d, g.geometry.p_x);
  ToothGridCounts counts{
      .tooth = n.tooth, .space = n.space, .flank = n.flank, .fillet = n.fillet, .ring = n.ring};
  counts.growth = n.growth;
  counts.tooth_growth = n.tooth_growth;
  const Profile profile = worm_profile(d, g.geometry);
  g.tooth_grid = tooth_grid(profile, counts);
  counts.order = n.order;
  g.points = tooth_grid(profile, counts);
  g.columns = 2 * g.tooth_grid.half_pitch;
  g.layer = g.geometry.p_x / g.columns;
  g.helix.K = d.z1 * g.columns;
  g.helix.m = n.turn / g.helix.K;
  g.half_thread = static_cast<int>(std::lround(d.thread_length / 2 / g.layer * g.helix.m));
  g.helix.top_0 = (g.half_thread - 1) / g.helix.m + 1 + g.tooth_grid.half_pitch + kPlainLayers;
  g.treads = treads(g.helix);
  g.shaft[0] =
      rings(g, -d.seat_1_end, -d.seat_1_begin, -d.shaft_1_end, d.seat_1_diameter / 2, d.shaft_1_diameter / 2);
  g.shaft[1] =
      rings(g, d.seat_2_begin, d.seat_2_end, d.shaft_2_end, d.seat_2_diameter / 2, d.shaft_2_diameter / 2);
  return g;
}

}  // namespace elastogear::gear
