#include "gear/gear_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/assembly.h"
#include "gear/second_order.h"

namespace elastogear::gear {
namespace {

// The section of the teeth in a plane.
struct PlaneSection {
  ToothGrid grid;
  std::function<double(double)> shift;  // rad, see Profile
};

// One sector: columns q = -half_pitch .. half_pitch (the last is the next sector's first), rows from the
// bore, or the outside of an internal gear, to the tip (hub, web, ring, rim, tooth), planes along z. A row of
// cells fills the planes within its half width.
struct Sector {
  ToothGrid tooth_grid;                // in the first plane; all planes have its counts
  std::vector<PlaneSection> sections;  // of all planes, or one for all
  double half_pitch = 0;               // rad
  std::vector<double> radius;          // m, rows 0 .. below the rim
  std::vector<double> half_width;      // m, of each row of cells
  std::vector<double> z;               // m, planes
  int rim = 0, tooth = 0;              // rows of nodes where rim and tooth begin
  bool internal = false;

  int rows() const { return static_cast<int>(half_width.size()); }
  int planes() const { return static_cast<int>(z.size()); }
  const PlaneSection& section(int plane) const {
    return sections[std::min(static_cast<std::size_t>(plane), sections.size() - 1)];
  }
};

constexpr double kSamePlane = 1e-9;  // m, far below any layer

void check(const std::string& name, const WheelCounts& n, int z) {
  check_order(name, n.order);
  const double layers = n.web_layers + 2.0 * (n.face_layers + n.hub_layers);
  const double section = (2.0 * n.space + n.tooth) * (n.rim + n.ring + n.web + n.hub) +
                         static_cast<double>(n.tooth) * (n.fillet + n.flank);
  check_counts(name,
               {n.tooth, n.space, n.flank, n.fillet, n.rim, n.ring, n.web, n.hub, n.web_layers, n.face_layers,
                n.hub_layers},
               z * layers * section);
  check_growth(name, {n.growth, n.tooth_growth, n.web_growth});
  require(n.tooth % 2 == 0, "the ", name, "'s count tooth = ", n.tooth, " must be even");
}

// Ends of a band of rows at which the web has corners.
struct Corners {
  bool inner = false, outer = false;
};

// Rows of a band get thinner towards the corners, each of them `growth` times as thick as the next; 0: equal
// ones. A row of a second-order mesh is two of its points, which halve it.
struct RowGrading {
  double growth;
  int order;

  double thickness(int i, int n, const Corners& at) const {
    const int row = i / order, last = n / order - 1;
    const int inner = at.inner ? row : last, outer = at.outer ? last - row : last;
    return growth == 0 || (!at.inner && !at.outer) ? 1 : std::pow(growth, std::min(inner, outer));
  }
};

void add_rows(Sector& sector, int n, double r_outer, double width, const RowGrading& grading,
              const Corners& at) {
  std::vector<double> height{0};
  for (int i = 0; i < n; ++i) height.push_back(height.back() + grading.thickness(i, n, at));
  const double r_inner = sector.radius.back();
  for (int i = 1; i <= n; ++i) {
    sector.radius.push_back(std::lerp(r_inner, r_outer, height[static_cast<std::size_t>(i)] / height.back()));
    sector.half_width.push_back(width / 2);
  }
}

// Planes on the positive side, from the web outwards; the negative side mirrors them.
std::vector<double> plane_positions(const Blank& blank, const WheelCounts& n) {
  const double middle = blank.has_web() ? blank.web_width : blank.face_width;
  std::vector<double> upper{middle / 2};
  std::pair<double, int> steps[] = {{blank.face_width / 2, n.face_layers},
                                    {blank.hub_width / 2, n.hub_layers}};
  std::sort(std::begin(steps), std::end(steps));
  for (const auto& [z, layers] : steps) {
    const double from = upper.back();
    for (int i = 1; i <= layers && z - from > kSamePlane; ++i)
      upper.push_back(std::lerp(from, z, static_cast<double>(i) / layers));
  }
  std::vector<double> all;
  for (auto z = upper.rbegin(); z != upper.rend(); ++z) all.push_back(-*z);
  for (int i = 1; i < n.web_layers; ++i)
    all.push_back(middle * (static_cast<double>(i) / n.web_layers - 0.5));
  all.insert(all.end(), upper.begin(), upper.end());
  return all;
}

// The columns of fillet and root land are the same in all planes. order: see ToothGridCounts.
std::vector<PlaneSection> sections(const std::function<Profile(double)>& profile,
                                   const std::vector<double>& z, const WheelCounts& n, int order) {
  ToothGridCounts counts{
      .tooth = n.tooth, .space = n.space, .flank = n.flank, .fillet = n.fillet, .ring = n.rim};
  counts.order = order;
  counts.growth = n.growth;
  counts.tooth_growth = n.tooth_growth;
  std::vector<PlaneSection> all;
  for (double at : z) {
    const Profile p = profile(at);
    all.push_back({tooth_grid(p, counts), p.shift});
    if (n.space > 1) counts.land = (all[0].grid.half_pitch - all[0].grid.fillet_end) / order;
  }
  return all;
}

// order: 2 of a grid with the midside nodes of a second-order mesh.
Sector sector(const Toothing& toothing, std::vector<PlaneSection> sections, const Blank& blank,
              const WheelCounts& n, int order) {
  Sector s{.tooth_grid = sections[0].grid,
           .sections = {},
           .radius = {blank.end_diameter() / 2},
           .half_width = {},
           .z = plane_positions(blank, n)};
  s.sections = std::move(sections);
  s.half_pitch = std::numbers::pi / toothing.z;
  s.internal = toothing.internal;
  const RowGrading grading{n.web_growth, order};
  if (blank.has_web()) {
    add_rows(s, n.hub, blank.hub_diameter / 2, blank.hub_width, grading, {.outer = true});
    add_rows(s, n.web, blank.web_diameter / 2, blank.web_width, grading, {.inner = true, .outer = true});
  }
  if (blank.rim_diameter != 2 * s.radius.back())
    add_rows(s, n.ring, blank.rim_diameter / 2, blank.face_width, grading, {.inner = blank.has_web()});
  s.rim = static_cast<int>(s.half_width.size());
  s.tooth = s.rim + n.rim;
  s.half_width.resize(static_cast<std::size_t>(s.tooth) + static_cast<std::size_t>(s.tooth_grid.rows),
                      blank.face_width / 2);
  return s;
}

bool has_cell(const Sector& s, int q, int row, int plane) {
  const bool within = row < s.tooth || (q >= -s.tooth_grid.half_tooth && q < s.tooth_grid.half_tooth);
  return within && std::max(std::abs(s.z[plane]), std::abs(s.z[plane + 1])) < s.half_width[row] + kSamePlane;
}

// (angle from the tooth's axis, radius) of a node of the section.
Eigen::Vector2d polar_point(const Sector& s, int q, int row, int plane) {
  if (row < s.rim) return {s.half_pitch * q / s.tooth_grid.half_pitch, s.radius[row]};
  const PlaneSection& section = s.section(plane);
  const Eigen::Vector2d x =
      row <= s.tooth ? section.grid.strip_point(q, row - s.rim) : section.grid.tooth_point(q, row - s.tooth);
  const double r = x.norm(), angle = std::atan2(x[0], s.internal ? -x[1] : x[1]);
  return {angle + (section.shift ? section.shift(r) : 0), r};
}

bool has_node(const Sector& s, int q, int row, int plane) {
  const double below = row > 0 ? s.half_width[row - 1] : 0, above = row < s.rows() ? s.half_width[row] : 0;
  return (row <= s.tooth || std::abs(q) <= s.tooth_grid.half_tooth) &&
         std::abs(s.z[plane]) < std::max(below, above) + kSamePlane;
}

// Node numbers of one sector. Its last column is the first of the next sector, whose numbers lie `count`
// further on.
struct Numbering {
  int half_pitch, rows, count = 0;
  std::vector<int> number;

  std::size_t index(int q, int row, int plane) const {
    return (static_cast<std::size_t>(plane) * 2 * half_pitch + q + half_pitch) * (rows + 1) + row;
  }
  int at(int q, int row, int plane) const {
    return q == half_pitch ? count + number[index(-half_pitch, row, plane)] : number[index(q, row, plane)];
  }
};

Numbering number_nodes(const Sector& s) {
  Numbering n{.half_pitch = s.tooth_grid.half_pitch, .rows = s.rows(), .number = {}};
  for (int plane = 0; plane < s.planes(); ++plane)
    for (int q = -n.half_pitch; q < n.half_pitch; ++q)
      for (int row = 0; row <= n.rows; ++row) n.number.push_back(has_node(s, q, row, plane) ? n.count++ : -1);
  return n;
}

template <class Visit>
void for_nodes(const Sector& s, const Numbering& n, Visit visit) {
  for (int plane = 0; plane < s.planes(); ++plane)
    for (int q = -n.half_pitch; q < n.half_pitch; ++q)
      for (int row = 0; row <= n.rows; ++row)
        if (n.at(q, row, plane) >= 0) visit(q, row, plane);
}

// Places the nodes of a gear on the grid of a sector, which has `order` intervals from one corner node to the
// next.
struct Placement {
  const Sector& fine;
  const Toothing& toothing;
  int order;

  // Indices count points of the fine grid.
  Eigen::Vector3d operator()(int tooth, int q, int row, int plane) const {
    const Eigen::Vector2d x = polar_point(fine, q, row, plane);
    const double theta = tooth_angle(toothing, tooth) + x[0] + fine.z[plane] / toothing.p;
    return {x[1] * std::cos(theta), x[1] * std::sin(theta), fine.z[plane]};
  }
};

Eigen::Matrix3Xd positions(const Sector& s, const Numbering& n, const Placement& at) {
  Eigen::Matrix3Xd X(3, n.count * at.toothing.z);
  for_nodes(s, n, [&](int q, int row, int plane) {
    for (int tooth = 0; tooth < at.toothing.z; ++tooth)
      X.col(tooth * n.count + n.at(q, row, plane)) =
          at(tooth, at.order * q, at.order * row, at.order * plane);
  });
  return X;
}

// The ends of an edge differ by one in one of their indices. An edge between two sectors ends in the second
// one's first column.
Midside midside(const Sector& s, const Numbering& n, const Placement& at) {
  std::vector<std::array<int, 3>> index(static_cast<std::size_t>(n.count));
  for_nodes(s, n, [&](int q, int row, int plane) { index[n.at(q, row, plane)] = {q, row, plane}; });
  return [=](int a, int b) {
    const auto [q_a, row_a, plane_a] = index[a % n.count];
    const auto [q_b, row_b, plane_b] = index[b % n.count];
    const bool within = a / n.count == b / n.count, from_a = within || q_a > q_b;
    const int tooth = (from_a ? a : b) / n.count, turned = within ? 0 : 2 * n.half_pitch;
    return at(tooth, q_a + q_b + turned, row_a + row_b, plane_a + plane_b);
  };
}

// Nodes of the fillet's surface: beside the tooth up to the flank, and on the strip's top down to the root
// land.
bool on_fillet(const Sector& s, int q, int row) {
  const int column = std::abs(q);
  if (row == s.tooth) return column >= s.tooth_grid.half_tooth && column <= s.tooth_grid.fillet_end;
  return row > s.tooth && row <= s.tooth + s.tooth_grid.fillet && column == s.tooth_grid.half_tooth;
}

void add_node_sets(mesh::Mesh& mesh, const Sector& s, const Numbering& n, int teeth) {
  for (int tooth = 0; tooth < teeth; ++tooth)
    for_nodes(s, n, [&](int q, int row, int plane) {
      const int node = tooth * n.count + n.at(q, row, plane);
      if (row == 0) mesh.node_sets[s.internal ? "outer" : "bore"].push_back(node);
      if (!on_fillet(s, q, row)) return;
      mesh.node_sets["root"].push_back(node);
      mesh.node_sets[numbered("root", tooth, teeth)].push_back(node);
    });
}

void add_cell(mesh::Mesh& mesh, const Sector& s, const Numbering& n, std::array<int, 4> cell) {
  const int tooth = cell[0], q = cell[1], row = cell[2], plane = cell[3];
  const int n_nodes = static_cast<int>(mesh.X.cols()), teeth = n_nodes / n.count;
  const auto node = [&](int dq, int drow, int dplane) {  // rows inwards: the upper plane first
    return (tooth * n.count + n.at(q + dq, row + drow, plane + (s.internal ? 1 - dplane : dplane))) % n_nodes;
  };
  mesh.cell_sets[row < s.rim ? "body" : "rim"].push_back(mesh.cells.size());
  const auto faces = add_hex(mesh, {node(0, 0, 0), node(0, 1, 0), node(1, 1, 0), node(1, 0, 0), node(0, 0, 1),
                                    node(0, 1, 1), node(1, 1, 1), node(1, 0, 1)});
  if (row < s.tooth + s.tooth_grid.fillet) return;
  if (q == -s.tooth_grid.half_tooth) add_flank(mesh, faces[2], numbered("tooth", tooth, teeth), "right");
  if (q == s.tooth_grid.half_tooth - 1) add_flank(mesh, faces[4], numbered("tooth", tooth, teeth), "left");
}

mesh::Mesh mesh_of(const std::string& name, const Sector& s, const Placement& at) {
  const Numbering n = number_nodes(s);
  const int teeth = at.toothing.z;
  mesh::Mesh mesh;
  mesh.X = positions(s, n, at);
  for (int tooth = 0; tooth < teeth; ++tooth)
    for (int plane = 0; plane + 1 < s.planes(); ++plane)
      for (int q = -n.half_pitch; q < n.half_pitch; ++q)
        for (int row = 0; row < n.rows; ++row)
          if (has_cell(s, q, row, plane)) add_cell(mesh, s, n, {tooth, q, row, plane});
  add_node_sets(mesh, s, n, teeth);
  sort_node_sets(mesh);
  if (at.order == 2) mesh = second_order(mesh, midside(s, n, at), teeth);
  check_cells(mesh, name);
  return mesh;
}

// The counts of rows and layers between which a second-order mesh has none.
WheelCounts with_points_between(WheelCounts n) {
  for (int WheelCounts::*count :
       {&WheelCounts::ring, &WheelCounts::web, &WheelCounts::hub, &WheelCounts::web_layers,
        &WheelCounts::face_layers, &WheelCounts::hub_layers, &WheelCounts::rim})
    n.*count *= 2;
  return n;
}

// is_constant: the profile is the same at all z.
mesh::Mesh make_mesh(const std::string& name, const Toothing& toothing,
                     const std::function<Profile(double z)>& profile, bool is_constant, const Blank& blank,
                     const WheelCounts& n) {
  check(name, n, toothing.z);
  const std::vector<double> ends{blank.face_width / -2};
  if (n.order == 1) {
    const std::vector<double> z = is_constant ? ends : plane_positions(blank, n);
    const Sector s = sector(toothing, sections(profile, z, n, 1), blank, n, 1);
    return mesh_of(name, s, {s, toothing, 1});
  }
  const WheelCounts twice = with_points_between(n);
  const std::vector<double> z = is_constant ? ends : plane_positions(blank, twice);
  const Sector coarse = sector(toothing, sections(profile, ends, n, 1), blank, n, 1);
  const Sector fine = sector(toothing, sections(profile, z, n, 2), blank, twice, 2);
  return mesh_of(name, coarse, {fine, toothing, 2});
}

}  // namespace

mesh::Mesh gear_mesh(const std::string& name, const Toothing& toothing,
                     const std::function<Profile(double z)>& profile, const Blank& blank,
                     const WheelCounts& counts) {
  return make_mesh(name, toothing, profile, false, blank, counts);
}

mesh::Mesh gear_mesh(const std::string& name, const Toothing& toothing, const Profile& profile,
                     const Blank& blank, const WheelCounts& counts) {
  return make_mesh(
      name, toothing, [&](double) { return profile; }, true, blank, counts);
}

}  // namespace elastogear::gear
