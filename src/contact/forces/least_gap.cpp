#include "contact/forces/least_gap.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <utility>

#include "contact/forces/bracket.h"
#include "contact/forces/hermite.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector2d;

constexpr int kSteps = 20;
constexpr double kConverged = Bracket::kConverged;
constexpr double kDistinct = 1e-6;  // of a length, that a minimum lies below its ends
constexpr double kApart = 1e-4;     // of a face, between minima that are not the same

// A slave point that may be a minimum.
struct Trial {
  SlavePoint point;
  SlaveGeometry geometry;
  Projection nearest;
  PointGap over;
};

// Gap at a slave point; nothing without a foot point. start: a face of the master near the point.
std::optional<Trial> evaluate(const GapField& field, const SlavePoint& point, int start) {
  Trial t{point, slave_geometry(field.slave, field.heights, point), {}, {}};
  const auto w = walk_to_projection(field.master.surface, t.geometry.x, field.reach.limits, start);
  if (!w) return {};
  t.nearest = *w;
  t.over = point_gap(field.master, *w, t.geometry.x, field.offset);
  return t;
}

Minimum minimum(const GapField& field, const Trial& t) {
  return {t.point, t.geometry, open_point(field.master, t.nearest, t.geometry.x, field.offset)};
}

// Limits of a search for minima of a gap.
struct Sought {
  double below = kNoGap;  // m, larger ones are of no interest
  int known = -1;         // face of the master over which the least gap is known; -1: none
};

// Is the least gap surely of no interest, by a value that falls at most by `fall` (m) along its parabola? Not
// so over the master's extensions, where it fades.
bool is_surely_open(const Sought& sought, const Trial& t, double fall) {
  constexpr double kUncertain = 0.5;  // of the fall
  return t.over.gap.g - (1 + kUncertain) * fall > sought.below && !on_extension(t.nearest);
}

// A minimum of no interest, of which nothing but the estimated gap and a place nearby is known.
Minimum open_minimum(const Trial& t, double fall) {
  Minimum m{t.point, t.geometry, {}};
  m.open.projection = t.over.projection;
  m.open.gap.g = t.over.gap.g - fall;
  return m;
}

// A point of a side, by the share s of its length, from which a search for the least gap begins, and a face
// of the master near it.
struct SideStart {
  double s;
  int face;
};

SideStart estimate(const SideGaps& side, int face) {
  const bool known = side.g[0] != kNoGap && side.g[1] != kNoGap;
  return {known ? least_of_cubic(side.g, side.slope).s : 0.5, face};
}

// The boundary side of a master face that a point near it has crossed most of, of those that it is moved out
// by; -1: there is none.
int side_crossed(const Face& face, const Projection& w) {
  int crossed = -1;
  double most = 0;  // of the extension
  for (int side = 0; side < face.sides; ++side) {
    if (face.extension[side] == 0) continue;
    const double share = share_of_extension(face, side, w.point.u, w.point.v).f;
    if (share > most) crossed = side, most = share;
  }
  return crossed;
}

// The point at which a side of the slave's boundary leaves the master, by Newton's method from a trial
// shortly before. Nothing where the two sides run along each other.
std::optional<Minimum> crossing(const GapField& field, const SideGaps& side, const Trial& before, double s) {
  constexpr double kAcross = 0.1,
                   kNear = 1e-3;  // sine of their angle; of the side, that the point may be off
  constexpr double kMet = 1e-12;
  Trial t = before;
  const double from = s;
  const Face face = face_of(field.master.surface, before.nearest.face);
  const int crossed = side_crossed(face, before.nearest);
  for (int step = 0; step < kSteps && crossed >= 0; ++step) {
    const FaceFunction share = share_of_extension(face, crossed, t.nearest.point.u, t.nearest.point.v);
    const Eigen::Vector3d gradient =
        slave_kinematics(face, t.nearest, t.geometry.x).D.transpose() * share.f_a;
    const double across = gradient.dot(t.geometry.a.col(0));
    if (std::abs(across) < kAcross * gradient.norm() * t.geometry.a.col(0).norm()) return {};
    const double way = (1 - share.f) / across;
    if (std::abs(way) < kMet) {
      Minimum m = minimum(field, t);
      m.crossing = Crossing{share.f_a};
      return m;
    }
    s += way;
    if (std::abs(s - from) > kNear || s < 0 || s > 1) return {};
    t.point.at = on_side(side.sides, side.side, s);
    t.geometry = slave_geometry(field.slave, field.heights, t.point);
    const auto w = extended_projection(face, t.geometry.x, t.nearest);
    if (!w) return {};
    t.nearest = *w;
  }
  return {};
}

bool is_below_ends(const SideGaps& side, double g) {
  return g < std::min(side.g[0], side.g[1]) - kDistinct * side.length;
}

// Newton's method for the slope of the gap, kept between places where it falls and rises, or that have no
// foot point. A side leaves the master over an extension of that; elsewhere a foot point was missed from
// afar. Over the face of a known minimum it would find that one.
std::optional<Minimum> least_on_side(const GapField& field, SideGaps side, const SideStart& begin,
                                     const Sought& sought) {
  constexpr int kMostSteps = 2 * kSteps;
  Bracket left;
  std::optional<Trial> last;
  double s = begin.s, at = side.g[0] != kNoGap ? 0 : 1, slope = 0;  // of the last trial: at, slope
  int start = begin.face;
  for (int step = 0; step < kMostSteps && left.is_left(slope); ++step) {
    side.point.at = on_side(side.sides, side.side, s);
    std::optional<Trial> t = evaluate(field, side.point, start);
    if (!t) {
      left.cut(s, at);
      s = left.middle();
      continue;
    }
    at = s;
    start = t->over.projection.face;
    if (start == sought.known) return {};
    slope = t->over.gap.n.dot(t->geometry.a.col(0));
    left.narrow(s, slope);
    if (!left.is_left(slope) && !on_extension(t->nearest)) left.join_again();
    last = std::move(t);
    const double curvature = gap_curvature(last->geometry, 1, last->over.gap)(0, 0),
                 next = curvature > 0 ? s - slope / curvature : left.middle();
    if (std::abs(next - s) < kConverged) {
      left = {};  // nothing is cut
      break;
    }
    const bool is_within = next > left.low && next < left.high;
    const double fall = 0.5 * slope * (s - next);
    if (curvature > 0 && is_within && !left.is_cut() && is_surely_open(sought, *last, fall)) {
      if (!is_below_ends(side, last->over.gap.g - fall)) return {};
      return open_minimum(*last, fall);
    }
    s = is_within ? next : left.middle();
  }
  if (!last || !is_below_ends(side, last->over.gap.g)) return {};
  if (!left.falls_to_cut(slope)) return minimum(field, *last);
  return field.slave.topology.is_open(side.point.face, side.side) ? crossing(field, side, *last, at)
                                                                  : std::nullopt;
}

// The side of the slave face that the point moves along, without gaps.
SideGaps side_with(const GapField& field, const SlavePoint& point) {
  SideGaps side;
  side.point = point;
  side.sides = side_count(field.slave.face, point.face);
  for (int i = 0; i < side.sides; ++i)
    if (on_side(side.sides, i, 1) - on_side(side.sides, i, 0) == point.along.col(0)) side.side = i;
  return side;
}

double share_of_side(const SideGaps& side, const Vector2d& at) {
  const Vector2d along = side.point.along.col(0);
  return (at - on_side(side.sides, side.side, 0)).dot(along) / along.squaredNorm();
}

bool is_inside(int sides, const Vector2d& at) {
  if (sides == 3) return at[0] > 0 && at[1] > 0 && at[0] + at[1] < 1;
  return at.cwiseAbs().maxCoeff() < 1;
}

// The step of Newton's method on a face, whose sides hold it: along a side that it would leave, down the
// slope there. Nothing where the gap is not convex.
std::optional<Vector2d> step_on_face(int sides, const Vector2d& at, const Vector2d& slope,
                                     const Eigen::Matrix2d& H) {
  if (!(H(0, 0) > 0 && H.determinant() > 0)) return {};
  const Vector2d newton = -H.inverse() * slope;
  const Vector2d next = held_inside(sides, at + newton / std::max(1.0, newton.cwiseAbs().maxCoeff()));
  if (sides == 3 || is_inside(sides, next)) return Vector2d(next - at);
  for (int i : {0, 1}) {
    if (!(std::abs(at[i]) == 1 && at[i] * slope[i] < 0)) continue;
    Vector2d along = Vector2d::Zero();
    along[1 - i] = -slope[1 - i] / H(1 - i, 1 - i);
    return Vector2d(held_inside(sides, at + along) - at);
  }
  return Vector2d(next - at);
}

// Returns whether the gap does not grow along one direction of the face. The curvatures are those of H in the
// metric of the face's tangents a. Where such a gap is least within the face is a matter of roundoff; the
// minima on the sides that the line of contact crosses stand for it.
bool is_flat(const Eigen::Matrix<double, 3, 2>& a, const Eigen::Matrix2d& H) {
  constexpr double kLine = 1e-6;  // ratio of the curvatures
  const Eigen::Matrix2d C = (a.transpose() * a).inverse() * H;
  const double mean = 0.5 * C.trace(), product = C.determinant();
  const double most = mean + std::sqrt(std::max(0.0, mean * mean - product));
  return product < kLine * most * most;
}

// The end of a search within a face, which may have come to none.
struct Search {
  std::optional<Minimum> minimum;
  bool ended = true;
};

// Newton's method while it is held on the face, half as far where that leads off the master. on_sides: m, the
// least gap known on the face's sides. Over the master's face of a known minimum it would find that one.
Search least_within(const GapField& field, SlavePoint point, const FaceStart& start, double on_sides,
                    const Sought& sought) {
  const int sides = side_count(field.slave.face, point.face);
  int face = start.face;
  Vector2d way = Vector2d::Zero();
  point.at = start.at;
  for (int step = 0; step < kSteps; ++step) {
    const std::optional<Trial> t = evaluate(field, point, face);
    if (!t) {
      if (step == 0) break;
      way /= 2;
      point.at -= way;
      continue;
    }
    face = t->over.projection.face;
    if (face == sought.known) return {};
    const Vector2d slope = t->geometry.a.transpose() * t->over.gap.n;
    const Eigen::Matrix2d H = gap_curvature(t->geometry, 2, t->over.gap);
    const auto newton = step_on_face(sides, point.at, slope, H);
    if (!newton) break;
    way = *newton;
    if (is_flat(t->geometry.a.leftCols<2>(), H)) return {};
    if (const Vector2d down = H.inverse() * slope;
        down.cwiseAbs().maxCoeff() <= 1 && is_surely_open(sought, *t, 0.5 * slope.dot(down)))
      return {};
    if (way.cwiseAbs().maxCoeff() < kConverged) {
      const double length = t->geometry.a.colwise().norm().maxCoeff();
      const bool is_minimum = is_inside(sides, point.at) && t->over.gap.g < on_sides - kDistinct * length;
      return {is_minimum ? std::optional(minimum(field, *t)) : std::nullopt};
    }
    point.at += way;
  }
  return {{}, false};
}

// A master face beyond a side near a foot point, and the way of the slave point over it, m.
struct Beyond {
  int face;
  Eigen::Vector3d way;
};

// The deformed master has kinks between its faces, so that a gap may have a minimum over each of two faces.
std::vector<Beyond> beyond_sides(const SurfaceView& master, const Projection& w) {
  constexpr double kNear = 0.5, kOver = 0.25;  // of the way from the middle of a face to its sides
  const Face face = face_of(master, w.face);
  const Vector2d at(w.point.u, w.point.v), centre = Vector2d::Constant(face.sides == 4 ? 0 : 1.0 / 3);
  const Shape s = shape(face.sides, at[0], at[1]);
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  std::vector<Beyond> result;
  for (int side = 0; side < face.sides; ++side) {
    const Vector2d outward = on_side(face.sides, side, 0.5) - centre;
    const double left = 1 - (at - centre).dot(outward) / outward.squaredNorm();
    const int edge = master.topology.edge(side, w.face);
    if (edge < 0 || left > kNear) continue;
    for (int entry : master.topology.edge_sides[edge])
      if (entry / 4 != w.face) result.push_back({entry / 4, a * ((left + kOver) * outward)});
  }
  return result;
}

// Adds the minima over the master's faces beside that of the first; search: from a change of the point's own
// coordinates and a master face.
template <class Search>
void add_beside(const GapField& field, std::vector<Minimum>& minima, const Search& search) {
  const Minimum first = minima.front();
  const auto n = first.point.n_dir;
  const Eigen::MatrixXd a = first.geometry.a.leftCols(n);
  for (const Beyond& beyond : beyond_sides(field.master.surface, first.open.projection)) {
    const Eigen::VectorXd step = (a.transpose() * a).inverse() * (a.transpose() * beyond.way);
    if (!step.allFinite()) continue;
    const std::optional<Minimum> other = search(step, beyond.face);
    const auto is_same = [&](const Minimum& m) { return (m.point.at - other->point.at).norm() < kApart; };
    if (other && std::none_of(minima.begin(), minima.end(), is_same)) minima.push_back(*other);
  }
  const auto by_face = [](const Minimum& l, const Minimum& r) {
    return l.open.projection.face < r.open.projection.face;
  };
  std::sort(minima.begin(), minima.end(), by_face);
  const int stride = field.slave.topology.edge_sides.size() + static_cast<int>(field.slave.face.cols());
  for (std::size_t i = 0; i < minima.size(); ++i)
    minima[i].point.number = first.point.number + static_cast<int>(i) * stride;
}

// Rises of the gap from a minimum to each side of its range, by its curvature H, are above this.
bool is_sure(const GapField& field, const Minimum& m) {
  constexpr double kSurely = 4 * kDistinct;
  const GapBy<3> gap{m.open.gap.g, m.open.gap.n, m.open.gap.n_x.leftCols<3>()};
  const Eigen::Matrix2d H = gap_curvature(m.geometry, m.point.n_dir, gap);
  const double length = m.geometry.a.colwise().norm().maxCoeff();
  const auto rises = [&](double left, double compliance) {
    return 0.5 * left * left > kSurely * length * compliance;
  };
  const int sides = side_count(field.slave.face, m.point.face);
  if (m.point.n_dir == 1) {
    const SideGaps side = side_with(field, m.point);
    const double s = share_of_side(side, m.point.at);
    return H(0, 0) > 0 && rises(std::min(s, 1 - s), 1 / H(0, 0));
  }
  if (!(H(0, 0) > 0 && H.determinant() > 0)) return false;
  const Eigen::Matrix2d C = H.inverse();
  for (int side = 0; side < sides; ++side) {
    const Vector2d along = on_side(sides, side, 1) - on_side(sides, side, 0);
    const Vector2d across(-along[1], along[0]);
    if (!rises(across.dot(m.point.at - on_side(sides, side, 0)), across.dot(C * across))) return false;
  }
  return true;
}

}  // namespace

std::optional<Minimum> followed_minimum(const GapField& field, const Minimum& last) {
  std::optional<Minimum> now;
  const int face = last.open.projection.face;
  if (last.point.n_dir == 1) {
    const SideGaps side = side_with(field, last.point);
    now = least_on_side(field, side, {share_of_side(side, last.point.at), face}, {});
  } else {
    now = least_within(field, last.point, {0, last.point.at, face}, kNoGap, {}).minimum;
  }
  if (!now || now->crossing.has_value() != last.crossing.has_value()) return {};
  if (!now->crossing && !is_sure(field, *now)) return {};
  return now;
}

bool have_met(const Minimum& a, const Minimum& b) {
  return a.point.face == b.point.face && a.point.n_dir == b.point.n_dir &&
         (a.point.at - b.point.at).norm() < kApart;
}

Vector2d held_inside(int sides, const Vector2d& at) {
  if (sides == 4) return at.cwiseMax(-1).cwiseMin(1);
  const Vector2d positive = at.cwiseMax(0);
  return positive / std::max(1.0, positive.sum());
}

std::vector<Minimum> minima_on_side(const GapField& field, const SideGaps& side, int face) {
  std::vector<Minimum> minima;
  const auto first = least_on_side(field, side, estimate(side, face), {field.reach.gap});
  if (!first) return minima;
  minima.push_back(*first);
  const double s = share_of_side(side, first->point.at);
  const Sought other{field.reach.gap, first->open.projection.face};
  add_beside(field, minima, [&](const Eigen::VectorXd& step, int beyond) {
    return least_on_side(field, side, {std::clamp(s + step[0], 0.0, 1.0), beyond}, other);
  });
  return minima;
}

std::vector<Minimum> minima_within(const GapField& field, const SlavePoint& point,
                                   std::span<const FaceStart> starts, double on_sides) {
  std::vector<Minimum> minima;
  Search first{{}, false};
  for (auto start = starts.begin(); start != starts.end() && !first.ended; ++start)
    first = least_within(field, point, *start, on_sides, {field.reach.gap});
  if (!first.minimum) return minima;
  minima.push_back(*first.minimum);
  const int sides = side_count(field.slave.face, point.face);
  const Sought other{field.reach.gap, first.minimum->open.projection.face};
  add_beside(field, minima, [&](const Eigen::VectorXd& step, int beyond) {
    const Vector2d at = held_inside(sides, first.minimum->point.at + step);
    return least_within(field, point, {0, at, beyond}, on_sides, other).minimum;
  });
  return minima;
}

}  // namespace elastogear::contact
