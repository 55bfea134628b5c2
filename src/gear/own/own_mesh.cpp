#include "elastogear/gear/own_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <tuple>

#include "elastogear/base/error.h"
#include "elastogear/gear/flank.h"
#include "elastogear/mesh/outer_sides.h"
#include "gear/assembly.h"
#include "gear/own/tooth_sides.h"

namespace elastogear::gear {
namespace {

constexpr double kOffFlank = 2e-3;   // modules, of corners of faces: splines of CAD programs are nearer
constexpr double kOffMiddle = 2e-2;  // modules, of midside nodes, which may stand on chords
constexpr double kBeside = 0.05;     // of a flank's height, at both of its ends: no part of fillets or tips
constexpr double kAround = 0.3;      // of normals, that flanks have around the axis at least
constexpr double kFacing = 0.8;      // cosine between the normals of faces and flanks
constexpr double kWider = 0.02;      // of the width of the teeth
constexpr double kTip = 0.05;        // modules, of the tip
constexpr double kBelowRoot = 0.3;   // modules, of a root surface that is not that of the data
constexpr double kAxial = 0.9;       // of normals, of the ends of the gear
constexpr double kRoundoff = 1e-12;  // of a length of the gear

using Sides = std::vector<ToothSide>;
using Outer = std::vector<std::vector<int>>;  // nodes of sides at the surface

// Sides that can only be parts of flanks.
Sides between_tip_and_root(const Sides& all, const Toothing& t) {
  const double beside = kBeside * flank_height(t);
  const double from = std::min(t.r_form, t.r_a) + beside, to = std::max(t.r_form, t.r_a) - beside;
  Sides found;
  for (const ToothSide& side : all)
    if (const double r = radius(side.middle); r > from && r < to && std::abs(around_axis(side)) > kAround)
      found.push_back(side);
  return found;
}

// Along z, to the middle of the teeth.
double centre(mesh::Mesh& mesh, const Outer& outer, const OwnGear& gear) {
  const Toothing& t = gear.toothing;
  const Eigen::VectorXd r = mesh.X.topRows<2>().colwise().norm();
  const Sides sides = between_tip_and_root(tooth_sides(mesh, outer), t);
  require(!sides.empty(), gear.name, ": no face of the mesh is on a flank, between the diameters ",
          in_mm(2 * t.r_form), " and ", in_mm(2 * t.r_a), "; its nodes stand at ", in_mm(2 * r.minCoeff()),
          " to ", in_mm(2 * r.maxCoeff()), " about the z axis of the file, which must be that of the gear; ",
          gear.name, ": {unit: mm} is for a file in mm");
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ToothSide& side : sides)
    for (int i = 0; i < side.corners; ++i) {
      const double z = mesh.X(2, side.node[static_cast<std::size_t>(i)]);
      low = std::min(low, z);
      high = std::max(high, z);
    }
  require(std::abs(high - low - gear.width) <= kWider * gear.width, gear.name, ": the teeth of the mesh are ",
          in_mm(high - low), " wide, from z = ", in_mm(low), " to ", in_mm(high), ", those of the data ",
          in_mm(gear.width), ": give the gear's face_width");
  const double shift = -(low + high) / 2;
  if (std::abs(shift) <= kRoundoff * gear.width) return 0;
  mesh.X.row(2).array() += shift;
  return shift;
}

// By the mean of where the flanks' nodes say that the nearest tooth stands.
double turn(mesh::Mesh& mesh, const Outer& outer, const OwnGear& gear) {
  const Toothing& t = gear.toothing;
  std::complex<double> sum = 0;
  for (const ToothSide& side : between_tip_and_root(tooth_sides(mesh, outer), t))
    for (int i = 0; i < side.corners; ++i) {
      const Eigen::Vector3d x = mesh.X.col(side.node[static_cast<std::size_t>(i)]);
      const double half = psi(t, radius(x), 0), s = around_axis(side) > 0 ? 1 : -1;
      sum += std::polar(1.0, t.z * (std::atan2(x[1], x[0]) - x[2] / t.p - s * half - t.theta_1));
    }
  const double angle = -std::arg(sum) / t.z;
  if (std::abs(angle) <= kRoundoff) return 0;
  mesh.X = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix() * mesh.X;
  return angle;
}

Flank flank_of_side(const Toothing& t, const ToothSide& side) {
  return {nearest_flank(t, side.middle).tooth, around_axis(side) > 0 ? 1 : -1};
}

double allowed(const OwnGear& gear, const ToothSide& side, std::size_t i) {
  return (static_cast<int>(i) < side.corners ? kOffFlank : kOffMiddle) * normal_module(gear.toothing);
}

// Returns the largest distance of a corner.
double require_on_flanks(const mesh::Mesh& mesh, const OwnGear& gear, const Sides& sides) {
  const Toothing& t = gear.toothing;
  double worst = 0, farthest = 0, mean = 0, n = 0, off = 0, most = 0;
  int node = -1;
  Flank of;
  for (const ToothSide& side : sides)
    for (std::size_t i = 0; i < side.node.size(); ++i) {
      const Flank flank = flank_of_side(t, side);
      const double d = flank_distance(t, flank.tooth, flank.side, mesh.X.col(side.node[i]));
      if (static_cast<int>(i) < side.corners) {
        farthest = std::max(farthest, std::abs(d));
        mean += d;
        ++n;
      }
      if (std::abs(d) <= worst * allowed(gear, side, i)) continue;
      worst = std::abs(d) / allowed(gear, side, i);
      std::tie(node, of, off, most) = std::tuple(side.node[i], flank, d, allowed(gear, side, i));
    }
  if (worst <= 1) return farthest;
  const Eigen::Vector3d x = mesh.X.col(node);
  const bool chord = most > kOffFlank * normal_module(t);
  fail(gear.name, ": ", mesh::node_text(mesh, node), " of the mesh, at the diameter ", in_mm(2 * radius(x)),
       " and ", in_mm(x[2]), " from the middle of the teeth, is ", in_mm(std::abs(off)),
       off > 0 ? " outside" : " inside", " the ", of.side > 0 ? "left" : "right", " flank of tooth ",
       of.tooth + 1, " by the data, allowed are ", in_mm(most), " (", chord ? kOffMiddle : kOffFlank,
       " modules); all flanks stand out by ", in_mm(mean / n),
       " on the average: give the data that the mesh was made by (module, teeth, profile_shift, helix_angle, "
       "pressure_angle, and backlash, which thins teeth), or mesh it anew",
       chord ? ", with midside nodes on the curved flanks" : "");
}

// Names that fit_own_mesh gives itself.
bool is_found(const std::string& set) {
  return set == "left" || set == "right" || set == "flanks" || set == "root" || set.starts_with("root_") ||
         flank_of(set).has_value();
}

void drop_found(mesh::Mesh& mesh) {
  std::erase_if(mesh.node_sets, [](const auto& set) { return is_found(set.first); });
  std::erase_if(mesh.face_sets, [](const auto& set) { return is_found(set.first); });
}

bool is_on_flank(const mesh::Mesh& mesh, const OwnGear& gear, const ToothSide& side, const Flank& flank) {
  const Toothing& t = gear.toothing;
  const double beside = kBeside * flank_height(t), tip = kTip * normal_module(t);
  if (side.n.dot(flank_normal(t, flank, side.middle)) < kFacing) return false;
  for (std::size_t i = 0; i < side.node.size(); ++i) {
    const Eigen::Vector3d x = mesh.X.col(side.node[i]);
    const double up = t.sign() * (radius(x) - t.r_form), over = t.sign() * (radius(x) - t.r_a);
    if (up < -beside || over > tip) return false;
    if (std::abs(flank_distance(t, flank.tooth, flank.side, x)) > allowed(gear, side, i)) return false;
  }
  return true;
}

void put_onto(const Toothing& t, const Flank& flank, Eigen::Ref<Eigen::Vector3d> x) {
  constexpr int kSteps = 3;
  for (int step = 0; step < kSteps; ++step) {
    const double d = flank_distance(t, flank.tooth, flank.side, x);
    if (std::abs(d) <= kRoundoff * t.r) return;
    x -= d * flank_normal(t, flank, x);
  }
}

void add_flanks(mesh::Mesh& mesh, const OwnGear& gear, const Sides& sides) {
  const Toothing& t = gear.toothing;
  std::vector<std::array<double, 2>> covered(static_cast<std::size_t>(t.z));
  for (const ToothSide& side : sides) {
    const Flank flank = flank_of_side(t, side);
    if (!is_on_flank(mesh, gear, side, flank)) continue;
    covered[static_cast<std::size_t>(flank.tooth)][flank.side > 0 ? 1 : 0] += side.area;
    for (const mesh::Face& face : mesh::side_faces(side.node))
      add_flank(mesh, face, numbered("tooth", flank.tooth, t.z), flank.side > 0 ? "left" : "right");
    for (int node : side.node) put_onto(t, flank, mesh.X.col(node));
  }
  require_covered(gear.name, t, gear.width, covered);
}

bool all_corners(const mesh::Mesh& mesh, const ToothSide& side, const auto& is) {
  return std::all_of(side.node.begin(), side.node.begin() + side.corners,
                     [&](int node) { return is(Eigen::Vector3d(mesh.X.col(node))); });
}

void add_roots(mesh::Mesh& mesh, const OwnGear& gear, const Sides& sides) {
  const Toothing& t = gear.toothing;
  const double m = normal_module(t), end = gear.width / 2 * (1 + kWider);
  for (const ToothSide& side : sides) {
    const bool between = all_corners(mesh, side, [&](const Eigen::Vector3d& x) {
      const double below = t.sign() * (t.r_form - radius(x)), depth = t.sign() * (t.r_form - t.r_f);
      return below > -kOffFlank * m && below < depth + kBelowRoot * m && std::abs(x[2]) <= end;
    });
    if (!between || std::abs(side.n[2]) > kAxial) continue;
    for (int node : side.node) {
      mesh.node_sets["root"].push_back(node);
      mesh.node_sets[numbered("root", nearest_flank(t, mesh.X.col(node)).tooth, t.z)].push_back(node);
    }
  }
  require(mesh.node_sets.contains("root"), gear.name,
          ": no face of the mesh is between its flanks, from the root ", "diameter ", in_mm(2 * t.r_f),
          " to ", in_mm(2 * t.r_form), ": give the rack that the mesh was made by");
}

void add_held(mesh::Mesh& mesh, const OwnGear& gear, const Sides& sides) {
  if (gear.held.empty() || mesh.node_sets.contains(gear.held) || mesh.face_sets.contains(gear.held)) return;
  const double near = kOffMiddle * normal_module(gear.toothing);
  std::vector<int> held;
  for (const ToothSide& side : sides)
    if (all_corners(mesh, side,
                    [&](const auto& x) { return std::abs(radius(x) - gear.held_radius) <= near; }))
      held.insert(held.end(), side.node.begin(), side.node.end());
  require(!held.empty(), gear.name, ": the mesh has no set '", gear.held,
          "', and no face on the cylinder of ", in_mm(2 * gear.held_radius),
          " that the data have for it: give ", gear.name,
          gear.held == "bore" ? ": {bore: ...}" : ": {outer_diameter: ...}", ", or name what is held by ",
          gear.name, ": {restrain: [...]}");
  mesh.node_sets[gear.held] = std::move(held);
}

}  // namespace

MeshFit fit_own_mesh(mesh::Mesh& mesh, const OwnGear& gear) {
  const Outer outer = mesh::outer_sides(mesh);
  MeshFit fit;
  fit.shift = centre(mesh, outer, gear);
  fit.turn = turn(mesh, outer, gear);
  const Sides sides = tooth_sides(mesh, outer);
  fit.farthest = require_on_flanks(mesh, gear, between_tip_and_root(sides, gear.toothing));
  drop_found(mesh);
  add_flanks(mesh, gear, sides);
  add_roots(mesh, gear, sides);
  add_held(mesh, gear, sides);
  sort_node_sets(mesh);
  return fit;
}

}  // namespace elastogear::gear
