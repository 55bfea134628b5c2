#pragma once
// The places on one side or face of the slave where its gap is least, by Newton's method (docs/theory,
// section 6.12).

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "contact/forces/slave_point.h"
#include "contact/search/reach.h"

namespace elastogear::contact {

inline constexpr double kNoGap = std::numeric_limits<double>::infinity();

/// The slave surface and what its points are held against.
struct GapField {
  const MasterSide& master;
  const SurfaceView& slave;  ///< without extensions
  const Heights& heights;    ///< of the slave's faces
  const Reach& reach;        ///< larger gaps are of no interest
  int slave_side = 0;
  double offset = 0;  ///< m, added to every gap
  bool whole = true;  ///< the whole surface; otherwise its boundary alone
};

struct Minimum {
  SlavePoint point;
  SlaveGeometry geometry;
  OpenPoint open;
  std::optional<Crossing> crossing = {};  ///< of a point that is least as the side leaves the master
};

/// One side of a slave face with the gaps at its ends; kNoGap where they are beyond the limits.
struct SideGaps {
  SlavePoint point;
  int side = 0, sides = 4;
  std::array<double, 2> g{kNoGap, kNoGap}, slope{-kNoGap, kNoGap};  ///< m
  double length = 0;                                                ///< m
};

/// A point of a slave face from which a search for the least gap begins.
struct FaceStart {
  double g = kNoGap;  ///< m
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  int face = -1;  ///< of the master
};

/// The coordinates (u, v) or, where they are beyond a face of so many sides, some on its border.
Eigen::Vector2d held_inside(int sides, const Eigen::Vector2d& at);

/// Where the minimum, which is one of the functions below, is now that both surfaces have moved a little;
/// nothing where it has surely not stayed within its side or face.
std::optional<Minimum> followed_minimum(const GapField& field, const Minimum& last);
/// Are they minima over two faces of the master that are at the same place now?
bool have_met(const Minimum& a, const Minimum& b);

/// The minimum on the side and those over the master's faces beside it; none that differ from the ends by
/// less than a millionth of the length. On the slave's boundary that is also the point at which a side leaves
/// the master through the master's boundary, where the gap falls up to there. face: of the master, near the
/// side.
std::vector<Minimum> minima_on_side(const GapField& field, const SideGaps& side, int face);

/// The minimum within the point's face and those over the master's faces beside it; none that differ by less
/// than a millionth of the face's length from the least gap on its sides, on_sides (m). A start from which
/// the search comes to no end is followed by the next.
std::vector<Minimum> minima_within(const GapField& field, const SlavePoint& point,
                                   std::span<const FaceStart> starts, double on_sides);

}  // namespace elastogear::contact
