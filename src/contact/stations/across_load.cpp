// How a unit force is spread across the profile and along the face.

#include <algorithm>
#include <cmath>

#include "contact/stations/smooth_load.h"
#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

// max(0, x), but a parabola from -blend to blend: with a continuous derivative. Eq. (6.44).
double smooth_ramp(double x, double blend) {
  if (std::abs(x) >= blend) return std::max(x, 0.);
  return (x + blend) * (x + blend) / (4 * blend);
}

// The second integral of an even share over c to both sides: its second differences are what lies on strips.
double spread_primitive(double x, double c) {
  if (x <= -c) return 0;
  if (x >= c) return x;
  return (x + c) * (x + c) / (4 * c);
}

// How much of the load of one strip lies on another one when it is spread over c to both sides.
double share_on(const Strip& on, const Strip& of, double c) {
  return (spread_primitive(on.to - of.from, c) - spread_primitive(on.to - of.to, c) -
          spread_primitive(on.from - of.from, c) + spread_primitive(on.from - of.to, c)) /
         of.length();
}

void require_side_by_side(const std::vector<Strip>& strips) {
  for (std::size_t i = 1; i < strips.size(); ++i)
    require(std::abs(strips[i].from - strips[i - 1].to) <= 1e-9 * strips[i].length(),
            "loads are spread along strips that lie side by side; one ends at ", strips[i - 1].to,
            " m and the next begins at ", strips[i].from, " m");
}

}  // namespace

LoadWidth load_width(const FlankGrid& flank) {
  LoadWidth width{0, 0};
  for (const FlankPatch& patch : flank.patch) {
    const Eigen::Vector2d size = patch.at.rowwise().maxCoeff() - patch.at.rowwise().minCoeff();
    width.a = std::max(width.a, 0.75 * size[0]);
    width.c = std::max(width.c, 0.5 * size[1]);
  }
  if (!flank.patch.empty()) return width;
  for (std::size_t i = 1; i < flank.v.size(); ++i)
    width.a = std::max(width.a, 0.75 * (flank.v[i] - flank.v[i - 1]));
  for (std::size_t i = 1; i < flank.z.size(); ++i)
    width.c = std::max(width.c, 0.5 * (flank.z[i] - flank.z[i - 1]));
  return width;
}

AcrossLoad across_load(double v, double a, double lower, double upper) {
  v = std::clamp(v, lower, upper);
  a = std::min(a, (upper - lower) / 2);
  const double room = upper - lower - 2 * a;  // of the middle
  double middle = lower + a + room / 2;
  if (const double blend = std::min(a, room) / 2; blend > 0)
    middle = lower + a + smooth_ramp(v - lower - a, blend) - smooth_ramp(v - upper + a, blend);
  return {middle - a, middle + a, 3 * (v - middle) / (a * a)};
}

Strip point_strip(const FlankGrid& flank, double z, const LoadWidth& width) {
  const AcrossLoad along = across_load(z, width.c, flank.z.front(), flank.z.back());
  return {along.from, along.to};
}

Eigen::MatrixXd spread_along(const std::vector<Strip>& strips, double c) {
  const auto n = static_cast<Eigen::Index>(strips.size());
  if (n == 0 || c <= 0) return Eigen::MatrixXd::Identity(n, n);
  require_side_by_side(strips);
  const double upper = strips.back().to, face = upper - strips.front().from;
  const int turns = static_cast<int>(std::ceil(c / face)) + 1;
  Eigen::MatrixXd share = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Strip &of = strips[static_cast<std::size_t>(i)], &on = strips[static_cast<std::size_t>(j)];
      for (int turn = -turns; turn <= turns; ++turn) {  // the face, unfolded by reflections at both ends
        const double shift = 2 * face * turn;
        share(i, j) += share_on({on.from + shift, on.to + shift}, of, c) +
                       share_on({2 * upper - on.to + shift, 2 * upper - on.from + shift}, of, c);
      }
    }
  return share;
}

}  // namespace elastogear::contact
