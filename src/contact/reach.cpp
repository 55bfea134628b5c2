#include "contact/reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastogear::contact {
namespace {

double largest_diagonal(const model::Surface& surface) {
  double largest = 0;
  for (int f = 0; f < surface.face.cols(); ++f)
    for (int i = 0; i < 2; ++i)
      largest = std::max(largest,
                         (surface.X.col(surface.face(i + 2, f)) - surface.X.col(surface.face(i, f))).norm());
  return largest;
}

// The rise of a sphere of the relative curvature over a face; never more than a side of the face.
double sag(const std::array<const Tracked*, 2>& tracked, const std::array<const Heights*, 2>& heights) {
  double curvature = 0, diagonal = 0;
  for (int i : {0, 1}) {
    const model::Surface& surface = *tracked[i]->surface;
    curvature += largest_curvature({surface.face, tracked[i]->topology, surface.X, 0}, *heights[i]);
    diagonal = std::max(diagonal, largest_diagonal(surface));
  }
  return std::min(curvature * diagonal * diagonal / 8, diagonal / std::numbers::sqrt2);
}

}  // namespace

// Facets that a surface with heights lies behind are touched from outside, and so is what the offset moves
// out. Open candidates of the unilateral law are near enough to close within an evaluation; others are found
// in the next one.
Reach reach_of(const Settings& settings, const std::array<const Tracked*, 2>& tracked,
               const std::array<const Heights*, 2>& heights) {
  constexpr double kReach = 0.02;  // of the depth
  const bool minima = settings.points == SlavePoints::minima;
  Reach r;
  r.gap = settings.law == ContactLaw::unilateral ? kReach * settings.depth : 0;
  const double height = r.gap + std::max(largest_height(*heights[0], settings.extension),
                                         largest_height(*heights[1], settings.extension));
  if (minima) r.sag = sag(tracked, heights);
  r.limits.depth = settings.depth + height + std::max(0.0, settings.offset);
  r.limits.cos_angle = std::cos(settings.normal_angle * std::numbers::pi / 180);
  r.limits.outside = height + r.sag + std::max(0.0, -settings.offset);
  for (int slave : minima ? slave_sides(settings) : std::vector<int>())
    r.limits.around =
        std::max(r.limits.around, largest_diagonal(*tracked[slave]->surface) + r.limits.outside);
  return r;
}

}  // namespace elastogear::contact
