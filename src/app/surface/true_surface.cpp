#include "app/surface/true_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "app/console/console.h"
#include "app/gear/design_options.h"
#include "app/gear/drive_options.h"
#include "app/gear/modification_options.h"
#include "app/input/column_table.h"
#include "app/surface/exact_flanks.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/contact/topology.h"
#include "elastogear/gear/flank.h"

namespace elastogear::app {
namespace {

constexpr double kOnFlank = 1e-6;  // m: the meshes are exact to 1e-9, and files may round to single precision

struct TrueSurfaceFiles {
  std::vector<std::string> flanks = {};
  std::string deviation = {};
};

const Rows<TrueSurfaceFiles> kTrueSurfaceRows = {
    {"<body>_flanks", &TrueSurfaceFiles::flanks, "-",
     "with contact_surface exact: the gear data that the body was meshed from, the YAML files of elastogear "
     "mesh; its flanks take the place of the faces of tooth_<ii>_... and thread_<i>_..."},
    {"<body>_deviation", &TrueSurfaceFiles::deviation, "-",
     "CSV file of how far the surface stands out of its mesh: a line for each node, its number in "
     "/surface/nodes of the body file and m along the outward normal (> 0: material added); linear between "
     "nodes, 0 at others"},
};

// The teeth of a body.
struct Teeth {
  gear::Toothing toothing;
  std::optional<gear::FlankDeviations> deviations = {};
  Layers layers = Layers::transverse;
};

Layers layers_of(bool is_worm) { return is_worm ? Layers::axial : Layers::transverse; }

// Those of a body that is a member of the run's drive; nothing for other bodies.
std::optional<Teeth> teeth_of_drive(const Options& options, const std::string& body) {
  if (!is_drive(options)) return {};
  for (const DriveMember& member : read_drive(options).members)
    if (member.name == body) return Teeth{member.toothing, member.deviations, layers_of(member.is_worm)};
  return {};
}

// The teeth of the part that files of gear data describe.
Teeth read_teeth(const std::vector<std::string>& files) {
  const Options options = Options::of_files("mesh", table_of(design_rows()), files);
  require(options.given("part"), join(files), ": names no part; add 'part: worm' or 'part: wheel'");
  const bool worm = is_worm(options);
  gear::Design design;
  read_rows(options, design_rows(), design);
  try {
    const gear::Geometry geometry = gear::derive(design);
    return {worm ? geometry.worm : geometry.wheel, {}, layers_of(worm)};
  } catch (const Error& error) {
    fail(join(files), ": ", error.what());
  }
}

struct OffNode {
  double distance = 0;  // m, from its flank
  int node = -1;        // mesh number
  std::string group;
};

// A body may have been meshed with its deviations or without them.
double off_flank(const Teeth& teeth, const gear::Flank& flank, const Eigen::Vector3d& x) {
  const double d = gear::flank_distance(teeth.toothing, flank.tooth, flank.side, x);
  if (!teeth.deviations) return std::abs(d);
  const double deviation = gear::flank_deviation(teeth.toothing, *teeth.deviations, flank, x);
  return std::min(std::abs(d), std::abs(d - deviation));
}

// The node of all flanks that is farthest from its flank.
OffNode farthest_node(const model::Surface& surface, const Teeth& teeth) {
  OffNode farthest;
  for (int f = 0; f < surface.face.cols(); ++f) {
    const std::string& group = surface.group_name[surface.group[f]];
    const auto flank = gear::flank_of(teeth.toothing, group);
    if (!flank) continue;
    for (int node : surface.face.col(f)) {
      const double d = off_flank(teeth, *flank, surface.X.col(node));
      if (farthest.node < 0 || d > farthest.distance) farthest = {d, surface.node[node], group};
    }
  }
  return farthest;
}

struct Heights {
  int n_faces = 0;   // that have some
  double error = 0;  // m, the most by which their polynomials miss the flank
};

// An involute is a smooth function of its roll angle, and its radius one of the square of that: over a face
// near the base circle heights are polynomials of a coordinate that is linear in the roll angle, Eq. (6.19b).
// Sides across the profile are chords of a helix, whose middle has a smaller radius: the bulge is where the
// face has that of its corners, Eq. (6.19c). An undercut flank ends there, at an edge that the fillet falls
// away from.
contact::Stretch stretch_by_roll(const model::Surface& surface, int f, const gear::Toothing& toothing) {
  static constexpr double kMost = 0.9;        // keeps derivatives with (u, v) finite on the base circle
  static constexpr double kMostBulge = 0.25;  // of half a face
  if (toothing.r_b == 0 || contact::side_count(surface.face, f) != 4) return {};
  const auto corner = [&](int c) { return Eigen::Vector2d(surface.X.col(surface.face(c % 4, f)).head<2>()); };
  const auto roll = [&](int c) {
    return std::sqrt(std::max(0.0, corner(c).squaredNorm() / (toothing.r_b * toothing.r_b) - 1));
  };
  contact::Stretch stretch;
  const std::array<std::array<int, 2>, 2> ends{{{3, 1}, {0, 2}}};  // sides at -1 and 1 of u and of v
  for (int k : {0, 1}) {
    const auto [first, last] = ends[static_cast<std::size_t>(k)];
    const double low = roll(first) + roll(first + 1), high = roll(last) + roll(last + 1);
    const double amount = low + high > 0 ? (high - low) / (high + low) : 0;
    if (std::abs(amount) <= std::abs(stretch.amount)) continue;
    const int fine = amount > 0 ? first : last, coarse = amount > 0 ? last : first;
    const auto middle = [&](int side) { return (corner(side) + corner(side + 1)).norm() / 2; };
    const double sag = (corner(fine).norm() + corner(fine + 1).norm()) / 2 - middle(fine);
    const double half = std::clamp(sag / std::abs(middle(coarse) - middle(fine)), 0.0, kMostBulge);
    stretch = {k, std::clamp(amount, -kMost, kMost), 2 * half / (1 - half)};
    if (toothing.undercut && corner(fine).norm() < toothing.r_form + kOnFlank)
      stretch.fall = std::abs(middle(coarse) - middle(fine)) / 2;
  }
  return stretch;
}

// Finds faces of flanks that are turned copies of each other, from tooth to tooth.
class TurnedFaces {
 public:
  explicit TurnedFaces(const gear::Toothing& toothing) : toothing_(toothing) {}

  // The first face that was asked for whose corners, seen from its tooth, are those of face f; f when there
  // is none.
  int first(const model::Surface& surface, int f, const gear::Flank& flank) {
    const double unit = kRoundoff * std::max(toothing_.r_a, toothing_.r_f);
    const Eigen::AngleAxisd back(-gear::tooth_angle(toothing_, flank.tooth), Eigen::Vector3d::UnitZ());
    Key key{flank.side};
    for (int c = 0; c < 4; ++c) {
      const Eigen::Vector3d x = back * Eigen::Vector3d(surface.X.col(surface.face(c, f))) / unit;
      for (int i = 0; i < 3; ++i) key[static_cast<std::size_t>(1 + 3 * c + i)] = std::llround(x[i]);
    }
    return first_.emplace(key, f).first->second;
  }

 private:
  static constexpr double kRoundoff = 1e-12;  // of the radius: some hundred times the roundoff of coordinates
  using Key = std::array<long long, 13>;

  const gear::Toothing& toothing_;
  std::map<Key, int> first_;
};

// Adds the heights of all flanks.
Heights add_heights(const model::Surface& surface, const Teeth& teeth, contact::TrueSurface& known) {
  Heights heights;
  known.height.resize(static_cast<std::size_t>(surface.face.cols()));
  TurnedFaces turned(teeth.toothing);
  for (int f = 0; f < surface.face.cols(); ++f) {
    const auto flank = gear::flank_of(teeth.toothing, surface.group_name[surface.group[f]]);
    if (!flank) continue;
    ++heights.n_faces;
    if (!teeth.deviations)
      if (const int first = turned.first(surface, f, *flank); first != f) {
        known.height[f] = known.height[first];
        continue;
      }
    const auto distance = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& n) {
      return teeth.deviations ? gear::flank_distance_along(teeth.toothing, *teeth.deviations, *flank, x, n)
                              : gear::flank_distance_along(teeth.toothing, *flank, x, n);
    };
    known.height[f] =
        contact::sampled_heights(surface, f, distance, stretch_by_roll(surface, f, teeth.toothing));
    if (teeth.deviations && !is_silenced())
      heights.error = std::max(heights.error, contact::height_error(surface, f, known.height[f], distance));
  }
  return heights;
}

// file: where the gear data come from.
void add_flanks(const Teeth& teeth, const std::string& file, const std::string& body,
                const model::Surface& surface, contact::TrueSurface& known) {
  const OffNode farthest = farthest_node(surface, teeth);
  require(farthest.node >= 0, file, ": body '", body, "' has no faces of sets tooth_<ii>_left, ..._right or ",
          "thread_<i>_left, ..._right: reduce it with -surface flanks, from a mesh of elastogear mesh, or "
          "leave out -",
          body, "_flanks");
  require(farthest.distance <= kOnFlank, file, ": node ", farthest.node, " of body '", body, "', in ",
          farthest.group, ", is ", farthest.distance, " m off the flank of this gear data, allowed is ",
          kOnFlank, " m: name the files that the body was meshed from by -", body,
          "_flanks, or mesh it anew");
  const Heights heights = add_heights(surface, teeth, known);
  known.flanks = exact_flanks(teeth.toothing, teeth.deviations, teeth.layers);
  print_detail("flanks of " + body, std::to_string(heights.n_faces) + " faces, nodes within " +
                                        with_unit(farthest.distance, "m") + " of " + file);
  if (teeth.deviations)
    print_item("modified flanks of " + body,
               "followed within " + with_unit(heights.error * 1e6, "um") + " by polynomials over the faces");
}

void add_deviations(const std::string& file, const std::string& body, const model::Surface& surface,
                    contact::TrueSurface& known) {
  ColumnTable reader(file);
  const double allowed = contact::face_size(surface.X, surface.face);
  known.deviation = Eigen::VectorXd::Zero(surface.X.cols());
  std::vector<bool> given(surface.node.size(), false);
  while (reader.next()) {
    if (reader.n_columns() != 2) reader.fail_here("must be two numbers, a node and its deviation in m");
    const double number = reader.number(0, "-"), value = reader.number(1, "m");
    const auto at = std::lower_bound(surface.node.begin(), surface.node.end(), number);
    if (at == surface.node.end() || *at != number)
      reader.fail_here("node ", number, " is not on the surface of body '", body,
                       "'; /surface/nodes of its body file lists the nodes");
    const auto node = at - surface.node.begin();
    if (given[node]) reader.fail_here("node ", number, " is given twice");
    if (std::abs(value) > allowed)
      reader.fail_here("deviation ", value, " m of node ", number, " exceeds the size of a face, ", allowed,
                       " m; give it in m");
    given[node] = true;
    known.deviation[node] = value;
  }
  print_item("deviation of " + body, with_unit(known.deviation.minCoeff(), "m") + " to " +
                                         with_unit(known.deviation.maxCoeff(), "m") + " by " + file);
}

}  // namespace

OptionTable true_surface_table() { return table_of(kTrueSurfaceRows); }

std::string true_surface_input(const Options& options, const std::string& body) {
  std::string input = options.text("contact_surface");
  OptionTable table = modification_table();
  for (const OptionSpec& spec : true_surface_table()) table.push_back(spec);
  for (const OptionSpec& spec : table)
    if (const std::string name = with_word(spec.name, body); options.given(name))
      input += "\n" + name + " " + options.text(name);
  return input;
}

std::shared_ptr<const contact::TrueSurface> true_surface(const Options& options, const std::string& body,
                                                         const model::Surface& surface) {
  TrueSurfaceFiles files;
  read_rows(options, kTrueSurfaceRows, files, body);
  const bool exact = options.text("contact_surface") == "exact";
  auto known = std::make_shared<contact::TrueSurface>();
  if (exact && !files.flanks.empty())
    add_flanks(read_teeth(files.flanks), join(files.flanks), body, surface, *known);
  else if (const auto teeth = teeth_of_drive(options, body); exact && teeth)
    add_flanks(*teeth, join(options.files()), body, surface, *known);
  if (!files.deviation.empty()) add_deviations(files.deviation, body, surface, *known);
  return known;
}

}  // namespace elastogear::app
