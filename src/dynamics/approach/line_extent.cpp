#include "dynamics/approach/line_extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace elastogear::dynamics {

using Eigen::Index;
using Eigen::Vector3d;

namespace {

using Piece = std::pair<double, double>;

// The pieces of the line over single faces, by their beginning.
std::vector<Piece> pieces(const model::Surface& surface, int group, const Vector3d& x, const Vector3d& along,
                          const Vector3d& across) {
  std::vector<Piece> pieces;
  for (Index f = 0; f < surface.face.cols(); ++f) {
    if (surface.group[static_cast<std::size_t>(f)] != group) continue;
    Eigen::Vector4d t, s;
    for (int i = 0; i < 4; ++i) {
      const Vector3d away = surface.X.col(surface.face(i, f)) - x;
      t[i] = along.dot(away);
      s[i] = across.dot(away);
    }
    if (s.minCoeff() > 0 || s.maxCoeff() < 0) continue;
    Piece piece{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      if ((s[i] > 0) == (s[j] > 0)) continue;
      const double at = t[i] + (t[j] - t[i]) * s[i] / (s[i] - s[j]);
      piece = {std::min(piece.first, at), std::max(piece.second, at)};
    }
    if (piece.second >= piece.first) pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end());
  return pieces;
}

}  // namespace

LineExtent line_extent(const model::Surface& surface, int group, const Vector3d& x, const Vector3d& along,
                       const Vector3d& normal) {
  constexpr double kGap = 0.01;  // of a piece, between pieces of neighbouring faces
  LineExtent nearest, joined;
  double least = std::numeric_limits<double>::max();
  const auto take = [&] {
    const double away = std::max({joined.from, -joined.to, 0.0});
    if (away < least) nearest = joined;
    least = std::min(least, away);
  };
  bool any = false;
  for (const auto& [from, to] : pieces(surface, group, x, along, normal.cross(along))) {
    const double face = to - from;
    if (any && from <= joined.to + kGap * face) {
      joined.to = std::max(joined.to, to);
      joined.face = std::max(joined.face, face);
      continue;
    }
    if (any) take();
    joined = {from, to, face};
    any = true;
  }
  if (any) take();
  return nearest;
}

}  // namespace elastogear::dynamics
