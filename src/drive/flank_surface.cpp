#include "elastogear/drive/flank_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "elastogear/base/error.h"
#include "elastogear/contact/topology.h"
#include "elastogear/gear/flank.h"

namespace elastogear::drive {
namespace {

// A body may have been meshed with its deviations or without them.
double off_flank(const Teeth& teeth, const gear::Flank& flank, const Eigen::Vector3d& x) {
  const double d = gear::flank_distance(teeth.toothing, flank.tooth, flank.side, x);
  if (!teeth.deviations) return std::abs(d);
  const double deviation = gear::flank_deviation(teeth.toothing, *teeth.deviations, flank, x);
  return std::min(std::abs(d), std::abs(d - deviation));
}

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
    auto entry = key.begin() + 1;
    for (int c = 0; c < 4; ++c)
      for (const double x : Eigen::Vector3d(back * Eigen::Vector3d(surface.X.col(surface.face(c, f))) / unit))
        *entry++ = std::llround(x);
    return first_.emplace(key, f).first->second;
  }

 private:
  static constexpr double kRoundoff = 1e-12;  // of the radius: some hundred times the roundoff of coordinates
  using Key = std::array<long long, 13>;

  const gear::Toothing& toothing_;
  std::map<Key, int> first_;
};

}  // namespace

OffNode farthest_node(const Teeth& teeth, const model::Surface& surface) {
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

FlankHeights flank_heights(const Teeth& teeth, const model::Surface& surface, bool with_error) {
  FlankHeights heights;
  heights.height.resize(static_cast<std::size_t>(surface.face.cols()));
  TurnedFaces turned(teeth.toothing);
  for (int f = 0; f < surface.face.cols(); ++f) {
    const auto flank = gear::flank_of(teeth.toothing, surface.group_name[surface.group[f]]);
    if (!flank) continue;
    ++heights.n_faces;
    if (!teeth.deviations)
      if (const int first = turned.first(surface, f, *flank); first != f) {
        heights.height[f] = heights.height[first];
        continue;
      }
    const auto distance = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& n) {
      return teeth.deviations ? gear::flank_distance_along(teeth.toothing, *teeth.deviations, *flank, x, n)
                              : gear::flank_distance_along(teeth.toothing, *flank, x, n);
    };
    heights.height[f] =
        contact::sampled_heights(surface, f, distance, stretch_by_roll(surface, f, teeth.toothing));
    if (teeth.deviations && with_error)
      heights.error = std::max(heights.error, contact::height_error(surface, f, heights.height[f], distance));
  }
  return heights;
}

FlankSurface flank_surface(const Teeth& teeth, const model::Surface& surface, bool with_error) {
  FlankSurface found;
  found.farthest = farthest_node(teeth, surface);
  require(found.farthest.node >= 0,
          "no faces of sets tooth_<ii>_left, ..._right or thread_<i>_left, ..._right are on its surface");
  require(found.farthest.distance <= kOnFlank, "node ", found.farthest.node, ", in ", found.farthest.group,
          ", is ", found.farthest.distance, " m off the flank of this gear data, allowed is ", kOnFlank,
          " m");
  FlankHeights heights = flank_heights(teeth, surface, with_error);
  found.surface.height = std::move(heights.height);
  found.surface.flanks = exact_flanks(teeth.toothing, teeth.deviations, teeth.layers);
  found.n_faces = heights.n_faces;
  found.error = heights.error;
  return found;
}

}  // namespace elastogear::drive
