#include "gear/tooth_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;
using Curve = std::function<Vector2d(double)>;

constexpr double kGrading =
    0.4;  // slope of graded() is 1 + kGrading at the inner end, 1 - kGrading at the root
constexpr int kArcLengthSamples = 400;            // of a fillet curve
constexpr double kDifference = 1e-5;              // step of a curve parameter in [0, 1]
constexpr double kCorner = std::numbers::pi / 3;  // three blocks meet on a smooth boundary

// n + 1 points on a curve, equally spaced by arc length.
Points equally_spaced(const Curve& curve, int n) {
  std::vector<double> length{0};
  for (int i = 1; i <= kArcLengthSamples; ++i) {
    const double t = static_cast<double>(i) / kArcLengthSamples;
    length.push_back(length.back() + (curve(t) - curve(t - 1.0 / kArcLengthSamples)).norm());
  }
  Points points{curve(0)};
  for (int i = 1; i < n; ++i) {
    const double target = length.back() * i / n;
    const auto above = std::upper_bound(length.begin(), length.end(), target);
    const double part = (target - above[-1]) / (above[0] - above[-1]);
    points.push_back(curve((above - 1 - length.begin() + part) / kArcLengthSamples));
  }
  points.push_back(curve(1));
  return points;
}

// Position of line `line` of n, 0 to 1: each step is `growth` times the next; see graded_row.
double graded(double line, int n, double growth) {
  const double t = line / n;
  if (growth == 0) return t * (1 + kGrading * (1 - t));
  if (growth == 1) return t;
  return (1 - std::pow(growth, -line)) / (1 - std::pow(growth, -n));
}

std::vector<double> uniform(int n) {
  std::vector<double> t;
  for (int i = 0; i <= n; ++i) t.push_back(static_cast<double>(i) / n);
  return t;
}

// Four edges of a block with common corners, and the parameters (0..1) of its columns and rows.
struct Block {
  Points bottom, top, left, right;
  std::vector<double> s, t;
};

// Transfinite interpolation, column by column.
Points interpolate(const Block& b) {
  Points points;
  for (std::size_t i = 0; i < b.s.size(); ++i)
    for (std::size_t j = 0; j < b.t.size(); ++j) {
      const double s = b.s[i], t = b.t[j];
      const Vector2d edges = (1 - t) * b.bottom[i] + t * b.top[i] + (1 - s) * b.left[j] + s * b.right[j];
      const Vector2d corners = (1 - s) * ((1 - t) * b.bottom.front() + t * b.top.front()) +
                               s * ((1 - t) * b.bottom.back() + t * b.top.back());
      points.push_back(edges - corners);
    }
  return points;
}

Points sample(const Curve& curve, const std::vector<double>& parameters) {
  Points points;
  for (double t : parameters) points.push_back(curve(t));
  return points;
}

std::vector<double> graded_rows(int n, const ToothGridCounts& counts, double growth) {
  std::vector<double> t;
  for (int i = 0; i <= n * counts.order; ++i)
    t.push_back(graded_row(static_cast<double>(i) / counts.order, n, growth));
  return t;
}

// Columns across half a tooth get thinner towards the flank; without a growth they are equal.
std::vector<double> tooth_columns(const ToothGridCounts& n) {
  return graded_rows(n.tooth / 2, n, n.tooth_growth == 0 ? 1 : n.tooth_growth);
}

// The middle of the fillet, where the blocks meet, and the directions of the two inner edges that leave it.
struct Junction {
  Vector2d x, to_axis, inwards;
};

Junction junction(const Profile& p) {
  const Vector2d up = (p.fillet(0.5 + kDifference) - p.fillet(0.5 - kDifference)).normalized();
  return {p.fillet(0.5), Eigen::Rotation2Dd(kCorner) * up, Eigen::Rotation2Dd(2 * kCorner) * up};
}

// Parabola from the tooth's axis, where it is level, to the junction.
Points tooth_bottom(const Junction& j, const std::vector<double>& columns) {
  const double drop = j.x[0] * j.to_axis[1] / std::abs(j.to_axis[0]) / 2;
  const Vector2d axis(0, j.x[1] + drop), control(j.x[0] / 2, axis[1]);
  return sample(
      [&](double t) { return Vector2d((1 - t) * (1 - t) * axis + 2 * t * (1 - t) * control + t * t * j.x); },
      columns);
}

// Hermite curve from the inner end, which it leaves at right angles, to the junction.
Points strip_divider(const Profile& p, const Junction& j, double c, const std::vector<double>& rows) {
  const Vector2d from = p.point(c, p.r_inner),
                 upwards = (p.inwards ? -1 : 1) * (p.point(c, p.r_inner + 1) - from);
  const double length = (j.x - from).norm();
  return sample(
      [&](double t) {
        const double u = 1 - t;
        return Vector2d(u * u * (1 + 2 * t) * from + t * t * (1 + 2 * u) * j.x +
                        t * u * u * length * upwards + t * t * u * length * j.inwards);
      },
      rows);
}

Points inner_end(const Profile& p, double from, double to, int n) {
  return sample([&](double s) { return p.point(std::lerp(from, to, s), p.r_inner); }, uniform(n));
}

// Top of the strip beside the tooth: lower half of the fillet, then the root land.
Points space_top(const Profile& p, int fillet, int land) {
  Points top = equally_spaced([&](double t) { return p.fillet(0.5 * (1 - t)); }, fillet);
  const double from = p.lateral(p.fillet(0));
  for (int i = 1; i <= land; ++i)
    top.push_back(p.point(std::lerp(from, p.half_pitch, static_cast<double>(i) / land), p.r_f));
  return top;
}

// Columns of the half space that the lower half of the fillet gets: its share of the length, so that its end
// is a node. A single column spans fillet and land.
int fillet_columns(const Profile& p, const ToothGridCounts& n) {
  if (n.land > 0) return n.space - n.land;
  const double fillet = (p.fillet(0) - p.fillet(0.5)).norm();
  const double land = (p.point(p.half_pitch, p.r_f) - p.fillet(0)).norm();
  return std::clamp(static_cast<int>(std::lround(n.space * fillet / (fillet + land))), 1,
                    std::max(1, n.space - 1));
}

// The point half way along the lower half of the fillet and the root land.
Vector2d space_middle(const Profile& p) {
  const double from = p.lateral(p.fillet(0)), fillet = (p.fillet(0) - p.fillet(0.5)).norm(),
               land = (p.point(p.half_pitch, p.r_f) - p.fillet(0)).norm(), part = fillet / (fillet + land);
  const auto top = [&](double t) {
    return t < part ? p.fillet(0.5 * (1 - t / part))
                    : p.point(std::lerp(from, p.half_pitch, (t - part) / (1 - part)), p.r_f);
  };
  return equally_spaced(top, 2)[1];
}

Points space_edge(const Profile& p, const ToothGridCounts& n) {
  if (n.space > 1) {
    const int fillet = fillet_columns(p, n);
    return space_top(p, n.order * fillet, n.order * (n.space - fillet));
  }
  Points ends{p.fillet(0.5), p.point(p.half_pitch, p.r_f)};
  if (n.order == 2) ends.insert(ends.begin() + 1, space_middle(p));
  return ends;
}

// Side of the tooth block: upper half of the fillet, then the flank, equally spaced in radius.
Points tooth_side(const Profile& p, const ToothGridCounts& n) {
  Points side = equally_spaced([&](double t) { return p.fillet(0.5 * (1 + t)); }, n.order * n.fillet);
  side.back() = p.point(p.half_width(p.r_form), p.r_form);
  for (int i = 1; i <= n.order * n.flank; ++i) {
    const double r = std::lerp(p.r_form, p.r_a, static_cast<double>(i) / (n.order * n.flank));
    side.push_back(p.point(p.half_width(r), r));
  }
  return side;
}

Points tooth_block(const Profile& p, const ToothGridCounts& n, const Points& bottom) {
  Block block{
      .bottom = bottom, .top = {}, .left = {}, .right = tooth_side(p, n), .s = tooth_columns(n), .t = {0}};
  const double tip = p.half_width(p.r_a);
  block.top = sample([&](double s) { return p.point(s * tip, p.r_a); }, block.s);
  for (std::size_t j = 1; j < block.right.size(); ++j)
    block.t.push_back(block.t.back() + (block.right[j] - block.right[j - 1]).norm());
  for (double& t : block.t) t /= block.t.back();
  block.t.back() = 1;
  block.left =
      sample([&](double t) { return Vector2d((1 - t) * bottom.front() + t * block.top.front()); }, block.t);
  return interpolate(block);
}

Points line(const Vector2d& from, const Vector2d& to, const std::vector<double>& t) {
  return sample([&](double s) { return Vector2d((1 - s) * from + s * to); }, t);
}

}  // namespace

double graded_row(double row, int n, double growth) {
  const double below = std::floor(row);
  return std::lerp(graded(below, n, growth), graded(below + 1, n, growth), row - below);
}

Eigen::Vector2d ToothGrid::strip_point(int q, int row) const {
  const Vector2d x = strip[static_cast<std::size_t>(std::abs(q)) * static_cast<std::size_t>(ring + 1) +
                           static_cast<std::size_t>(row)];
  return q < 0 ? Vector2d(-x[0], x[1]) : x;
}

Eigen::Vector2d ToothGrid::tooth_point(int q, int row) const {
  const Vector2d x = tooth[static_cast<std::size_t>(std::abs(q)) * static_cast<std::size_t>(rows + 1) +
                           static_cast<std::size_t>(row)];
  return q < 0 ? Vector2d(-x[0], x[1]) : x;
}

ToothGrid tooth_grid(const Profile& p, const ToothGridCounts& n) {
  const int half_tooth = n.order * (n.tooth / 2), space = n.order * n.space, half_pitch = half_tooth + space;
  const double divider = p.half_pitch * half_tooth / half_pitch;
  const std::vector<double> rows = graded_rows(n.ring, n, n.growth), columns = tooth_columns(n);
  const Junction j = junction(p);
  const Points bottom = tooth_bottom(j, columns), split = strip_divider(p, j, divider, rows);
  const Points below = interpolate({.bottom = inner_end(p, 0, divider, half_tooth),
                                    .top = bottom,
                                    .left = line(p.point(0, p.r_inner), bottom.front(), rows),
                                    .right = split,
                                    .s = columns,
                                    .t = rows});
  const Points beside =
      interpolate({.bottom = inner_end(p, divider, p.half_pitch, space),
                   .top = space_edge(p, n),
                   .left = split,
                   .right = line(p.point(p.half_pitch, p.r_inner), p.point(p.half_pitch, p.r_f), rows),
                   .s = uniform(space),
                   .t = rows});
  ToothGrid grid{.half_tooth = half_tooth,
                 .half_pitch = half_pitch,
                 .ring = n.order * n.ring,
                 .fillet = n.order * n.fillet,
                 .rows = n.order * (n.fillet + n.flank),
                 .fillet_end = half_tooth + (n.space == 1 ? 0 : n.order * fillet_columns(p, n)),
                 .strip = below,
                 .tooth = tooth_block(p, n, bottom)};
  grid.strip.insert(grid.strip.end(), beside.begin() + grid.ring + 1, beside.end());
  return grid;
}

}  // namespace elastogear::gear
