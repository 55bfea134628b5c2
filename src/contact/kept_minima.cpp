#include "contact/kept_minima.h"

#include <algorithm>
#include <optional>

namespace elastogear::contact {
namespace {

// The minimum with this number over this face of the master.
std::vector<Minimum>::iterator find(std::vector<Minimum>& found, int number, int face) {
  return std::find_if(found.begin(), found.end(), [&](const Minimum& m) {
    return m.point.number == number && m.open.projection.face == face;
  });
}

int master_face(const KeptMinimum& kept) { return kept.last.open.projection.face; }

// Numbers of points that stay begin with it, beyond those of all minima of a slave.
int first_of_kept(const GapField& field) {
  constexpr int kMostBeside = 8;  // more than the minima of one side or face
  return kMostBeside * (field.slave.topology.edge_sides.size() +
                        static_cast<int>(field.slave.face.cols() + field.slave.x.cols()));
}

void let_stay(KeptMinima& kept, KeptMinimum point, int first) {
  point.stays = true;
  int& number = point.last.point.number;
  for (number += first; kept.contains(number);) number += first;
  kept.emplace(number, point);
}

// The point where it is on its face; nothing if the master is not near. start: a face of the master.
std::optional<Minimum> fixed(const GapField& field, SlavePoint point, int start) {
  point.n_dir = 0;
  Minimum m{point, slave_geometry(field.slave, field.heights, point), {}};
  const auto w = walk_to_projection(field.master.surface, m.geometry.x, field.reach.limits, start);
  if (!w) return {};
  m.open = open_point(field.master, *w, m.geometry.x, field.offset);
  return m;
}

}  // namespace

void keep_loaded(const std::vector<ContactPoint>& contacts, int slave_side,
                 const std::vector<Minimum>& minima, KeptMinima& kept) {
  for (const ContactPoint& c : contacts) {
    if (c.slave_side != slave_side || !(c.p > 0)) continue;
    for (const Minimum& m : minima)
      if (m.point.number == c.slave_point && !kept[c.slave_point].stays) kept[c.slave_point].last = m;
  }
}

void add_kept(const GapField& field, KeptMinima& kept, std::vector<Minimum>& found) {
  const int first = first_of_kept(field);
  std::vector<KeptMinimum> vanished;
  std::erase_if(kept, [&](const auto& entry) {
    const auto& [number, point] = entry;
    const bool vanishes = !point.stays && find(found, number, master_face(point)) == found.end();
    if (vanishes) vanished.push_back(point);
    return vanishes;
  });
  for (const KeptMinimum& point : vanished) let_stay(kept, point, first);
  for (const auto& [number, point] : kept) {
    if (!point.stays) continue;
    if (const auto same = find(found, number % first, master_face(point)); same != found.end())
      found.erase(same);
    if (const auto m = fixed(field, point.last.point, master_face(point))) found.push_back(*m);
  }
}

std::map<int, StandingPoint> standing_points(const std::vector<Minimum>& minima,
                                             const std::map<int, StandingPoint>& before) {
  std::map<int, StandingPoint> points;
  for (const Minimum& m : minima) {
    const auto last = before.find(m.point.number);
    const bool stayed = last != before.end() && last->second.face == m.point.face;
    const Eigen::Vector2d way =
        stayed ? Eigen::Vector2d(m.point.at - last->second.at) : Eigen::Vector2d::Zero();
    points[m.point.number] = {m.point.face, m.point.at, way, m.open.projection.face};
  }
  return points;
}

std::vector<Minimum> standing_minima(const GapField& field, const std::map<int, StandingPoint>& points) {
  std::vector<Minimum> minima;
  for (const auto& [number, point] : points) {
    const int sides = side_count(field.slave.face, point.face);
    const Eigen::Vector2d at = held_inside(sides, point.at + 0.5 * point.way);
    if (const auto m = fixed(field, {number, point.face, at}, point.master_face)) minima.push_back(*m);
  }
  return minima;
}

}  // namespace elastogear::contact
