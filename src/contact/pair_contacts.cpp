#include <algorithm>
#include <limits>
#include <utility>

#include "contact/faces/face_contacts.h"
#include "contact/forces/impacts.h"
#include "contact/pair_data.h"
#include "contact/projection/edges.h"
#include "contact/settings.h"

namespace elastogear::contact {
namespace {

// From the common frame to the world.
void rotate(ContactPoint& contact, const Eigen::Matrix3d& R) {
  contact.n = R * contact.n;
  contact.f = R * contact.f;
  for (LocalVectors* vectors : {&contact.F, &contact.F_p, &contact.g_x, &contact.v})
    for (auto vector : vectors->colwise()) vector = (R * vector).eval();
  contact.slip = R * contact.slip;
  contact.elastic_slip = R * contact.elastic_slip;
  if (contact.tangential) contact.tangential->T = R * contact.tangential->T;
  const auto rotate_rows = [&](auto& columns) {  // three by three they are vectors, one after the other
    for (auto vector : Eigen::Map<Eigen::Matrix3Xd>(columns.data(), 3, columns.size() / 3).colwise())
      vector = (R * vector).eval();
  };
  for (LocalColumns* columns : {&contact.W, &contact.V, &contact.V_dot})
    if (!columns->isZero(0)) rotate_rows(*columns);
  if (!contact.tangential) return;
  rotate_rows(contact.tangential->F_t);
  rotate_rows(contact.tangential->u_x);
}

}  // namespace

// The law of a slave point with the force that it is given. Where no body has a static response that could
// close the gap the compliance of the penalty stands in for it.
Law Pair::Data::law(const OnSlave& at, int master_face) const {
  const Side &slaves = side[at.side], &masters = side[1 - at.side];
  Law law = slaves.law[at.nodes[0]];
  law.c_p = 0;
  law.mass = 0;
  for (int i = 0; i < 4; ++i) {
    law.c_p += at.N[i] * slaves.law[at.nodes[i]].c_p;
    law.mass += at.N[i] * slaves.law[at.nodes[i]].mass;
  }
  set_given(history[at.side], at.point, law);
  const auto any = [](const std::vector<bool>& responds, const Eigen::Vector4i& of) {
    return responds.empty() || std::any_of(of.begin(), of.end(), [&](int node) { return responds[node]; });
  };
  if (!any(slaves.responds, at.nodes) && !any(masters.responds, surface(1 - at.side).face.col(master_face)))
    law.compliance = 1;
  return law;
}

// How far the slave's own surface stands out of a node: deviations, where both surfaces are met.
Eigen::Vector3d Pair::Data::node_height(int slave_side, const SurfaceView& slave, int node) const {
  if (settings.points == SlavePoints::nodes || !side[slave_side].stands_out[static_cast<std::size_t>(node)])
    return Eigen::Vector3d::Zero();
  const int corner = slave.topology.node_corners[node][0];
  SlavePoint point;
  point.face = corner / 4;
  point.at = on_side(side_count(slave.face, point.face), corner % 4, 0);
  return slave_geometry(slave, side[slave_side].heights, point).e;
}

// Contact of a node with a share of its stiffness; its gap goes to `gaps` where minima are sought.
std::optional<ContactPoint> Pair::Data::node_contact(const MasterSide& master, const PlacedNode& slave,
                                                     const Projection& w, double share,
                                                     std::map<int, NodeGap>& gaps) {
  const int slave_side = slave.side, node = slave.node;
  Law law = this->law({slave_side, node, Eigen::Vector4i::Constant(node), Eigen::Vector4d::Unit(0)}, w.face);
  law.c_p *= share;
  if (has_potential(settings) && master.heights.empty() && !on_extension(w))
    return potential_contact(master, w, law, settings.full_tangent);
  if (settings.points == SlavePoints::minima) {
    const PointGap over = point_gap(master, w, slave.x, settings.offset);
    if (over.gap.g < largest_gap_at(reach, slave_side, tracker.side(slave_side).topology.node_corners[node],
                                    over.projection.face))
      gaps[node] = {over.gap.g, over.gap.n, over.projection.face};
    if (over.gap.g > reach.gap && law.p_given == 0) return {};
  } else if (law.p_given == 0 && (law.impact || (law.unilateral && !master.heights.empty()))) {
    if (size_of_gap(master, w, slave.x, settings.offset) > reach.gap) return {};
  }
  const OpenPoint open = open_point(master, w, slave.x, settings.offset);
  return general_contact(
      master, open,
      {tracker.velocity(slave_side, node), [&](int n) { return tracker.velocity(1 - slave_side, n); },
       stuck_at(history[slave_side], node), friction_at(history[slave_side], node)},
      law);
}

// Do nodes in valleys of the master have a contact with each of the faces there? Those that stick have one
// history, and a penalty's force jumps by as much as the normals do.
bool Pair::Data::has_valleys() const {
  return settings.law == ContactLaw::unilateral && settings.points == SlavePoints::nodes && !sticks();
}

// Contact of a node with a face beside that of its projection.
std::optional<ContactPoint> Pair::Data::beside_contact(const MasterSide& master, const PlacedNode& slave,
                                                       const FaceOfValley& face) {
  const int node = slave.node,
            number = node + static_cast<int>(surface(slave.side).X.cols()) * (1 + face.place);
  Law law = this->law({slave.side, number, Eigen::Vector4i::Constant(node), Eigen::Vector4d::Unit(0)},
                      face.projection.face);
  law.c_p *= face.share;
  if (law.p_given == 0 && size_of_gap(master, face.projection, slave.x, settings.offset) > reach.gap)
    return {};
  const OpenPoint open = open_point(master, face.projection, slave.x, settings.offset);
  auto found = general_contact(master, open,
                               {tracker.velocity(slave.side, node),
                                [&](int n) { return tracker.velocity(1 - slave.side, n); }, nullptr},
                               law);
  if (found) found->slave_point = number;
  return found;
}

std::optional<ContactPoint> Pair::Data::contact(const MasterSide& master, int slave_side, const Minimum& m) {
  const Eigen::Vector4i nodes = surface(slave_side).face.col(m.point.face);
  const Eigen::Vector4d& N = m.geometry.N;
  const Law law = this->law({slave_side, m.point.number, nodes, N}, m.open.projection.face);
  LocalVectors v(3, 8);
  for (int i = 0; i < 4; ++i) v.col(i) = tracker.velocity(slave_side, nodes[i]);
  std::optional<ContactPoint> found = general_contact(
      master, m.open,
      {v.leftCols<4>() * N, [&](int n) { return tracker.velocity(1 - slave_side, n); }, nullptr}, law);
  if (!found) return {};
  ContactPoint& c = *found;
  v.rightCols<4>() = c.v.rightCols<4>();
  if (m.crossing && !law.impact)
    spread_crossing(m.geometry, *m.crossing, m.open, law.unilateral ? 0 : law.c_p, c);
  else
    spread_over_face(m.geometry, m.crossing ? 0 : m.point.n_dir, m.open.gap, c);
  c.v = v;
  c.slave_nodes = nodes;
  Eigen::Index nearest = 0;
  N.maxCoeff(&nearest);
  c.slave_node = nodes[nearest];
  c.slave_point = m.point.number;
  return found;
}

// Follows the minima of the last look. Returns whether all are surely there still, and no two have met.
bool Pair::Data::follow_minima(const GapField& field, std::vector<Minimum>& followed) const {
  for (auto m = followed.begin(); m != followed.end(); ++m) {
    const auto now = followed_minimum(field, *m);
    if (!now) return false;
    *m = *now;
    if (std::any_of(followed.begin(), m, [&](const Minimum& other) { return have_met(other, *m); }))
      return false;
  }
  return true;
}

// gaps: null where the minima of the last look are followed. Returns whether that can be done.
bool Pair::Data::add_minima(const MasterSide& master, int slave_side, const std::map<int, NodeGap>* gaps,
                            std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = tracker.view(slave_side, 0);
  const GapField field{master,     slave,           side[slave_side].heights, reach,
                       slave_side, settings.offset, is_whole(slave_side)};
  const History& last = history[slave_side];
  if (!gaps && !follow_minima(field, minima[slave_side])) return false;
  if (gaps)
    minima[slave_side] = last.in_step ? standing_minima(field, last.standing) : gap_minima(field, *gaps);
  add_kept(field, kept[slave_side], minima[slave_side]);
  for (const Minimum& m : minima[slave_side]) {
    auto found = contact(master, slave_side, m);
    if (!found) continue;
    found->slave_side = slave_side;
    contacts.push_back(std::move(*found));
  }
  return true;
}

// faces: of the master, that can be nearest.
std::optional<Projection> Pair::Data::project(const MasterSide& master, const SurfaceView& slave,
                                              const PlacedNode& placed, std::span<const int> faces) {
  const SlaveNode q{placed.x,
                    [this, &placed] { return node_normal(tracker.view(placed.side, 0), placed.node); },
                    [this, &placed] { return tracker.all_faces(placed.side, placed.node); },
                    tracker.undeformed_normal(placed.side, placed.node), tracker.bounds(1 - placed.side)};
  const Limits limits = limits_at(reach, placed.side, slave.topology.node_corners[placed.node]);
  int& last_face = history[placed.side].last_face[placed.node];
  int& nearest = history[placed.side].nearest_face[placed.node];
  double clearance = 0;
  auto projection = find_projection(master.surface, q, limits, faces, &nearest, &clearance);
  if (clearance > 0)
    tracker.set_clearance(placed.side, placed.node, clearance - (placed.x - slave.at(placed.node)).norm());
  if (projection && std::binary_search(faces.begin(), faces.end(), last_face))
    projection = kept_projection(master, *projection, placed.x, last_face);
  last_face = projection ? projection->face : -1;
  return projection;
}

// Tells whether a node of the master's edges lies over the slave's boundary: where both surfaces end, the
// nodes of the slave keep them apart.
bool Pair::Data::is_left_to_slave(int tried, const SurfaceView& other, const Projection& w) const {
  return !is_whole(tried) && settings.points == SlavePoints::nodes &&
         is_at_open_side(other, w.face, w.point.N);
}

// Adds the contacts of the i-th slave node near.
void Pair::Data::add_node(const MasterSide& master, const SurfaceView& slave, std::size_t i,
                          std::map<int, NodeGap>& gaps, std::vector<ContactPoint>& contacts) {
  const int slave_side = slave.side;
  const Neighbours& near = tracker.near(slave_side);
  const int node = near.slave[i];
  const PlacedNode placed{slave_side, node, slave.at(node) + node_height(slave_side, slave, node)};
  const auto projection = project(master, slave, placed, near.faces(i));
  if (!projection || is_left_to_slave(slave_side, master.surface, *projection)) return;
  const Valley valley = has_valleys() ? valley_at(master, *projection, placed.x) : Valley{};
  const auto add = [&](std::optional<ContactPoint>&& found) {
    if (!found) return;
    found->slave_side = found->stick.slave_side = slave_side;
    found->slave_node = found->stick.slave_node = node;
    found->slave_nodes[0] = node;
    if (sticks()) history[slave_side].open[node] = found->stick;
    contacts.push_back(std::move(*found));
  };
  auto found = node_contact(master, placed, *projection, valley.share, gaps);
  if (found) found->slave_point = node;
  add(std::move(found));
  for (const FaceOfValley& face : valley.beside) add(beside_contact(master, placed, face));
}

// follows: the contacts of the last look at all. Returns whether that can be done.
bool Pair::Data::run_pass(int slave_side, bool follows, std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = tracker.view(slave_side, 0),
                    surface = tracker.view(1 - slave_side, settings.extension);
  const bool at_minima = settings.points == SlavePoints::minima;
  const Heights& heights = side[1 - slave_side].heights;
  const MasterSide master{surface, heights, radians(settings.feature_angle), !at_minima,
                          at_minima && !heights.empty()};
  std::map<int, NodeGap> gaps;
  std::vector<std::size_t>& touch = touching[slave_side];
  history[slave_side].open.clear();
  if (follows) {
    for (std::size_t i : touch) add_node(master, slave, i, gaps, contacts);
    return add_minima(master, slave_side, nullptr, contacts);
  }
  touch.clear();
  for (std::size_t i = 0; i < tracker.near(slave_side).slave.size(); ++i) {
    const std::size_t before = contacts.size();
    if (tracker.is_clear(slave_side, tracker.near(slave_side).slave[i])) continue;
    add_node(master, slave, i, gaps, contacts);
    if (contacts.size() > before) touch.push_back(i);
  }
  return !at_minima || add_minima(master, slave_side, &gaps, contacts);
}

// The gaps at the slave nodes beside which one may lie within the reach.
std::map<int, NodeGap> Pair::Data::node_gaps(int slave_side, const MasterSide& master) {
  const SurfaceView slave = tracker.view(slave_side, 0);
  const Neighbours& near = tracker.near(slave_side);
  std::map<int, NodeGap> gaps;
  for (std::size_t i = 0; i < near.slave.size(); ++i) {
    const int node = near.slave[i];
    const std::span<const int> around = slave.topology.node_corners[node];
    const PlacedNode placed{slave_side, node, slave.at(node) + node_height(slave_side, slave, node)};
    const auto projection = project(master, slave, placed, near.faces(i));
    if (!projection) continue;
    const PointGap over = point_gap(master, *projection, placed.x, settings.offset);
    if (over.gap.g < largest_gap_at(reach, slave_side, around, over.projection.face))
      gaps[node] = {over.gap.g, over.gap.n, over.projection.face};
  }
  return gaps;
}

// Position of a node; where heights hold the undeformed shape, its displacement.
Eigen::Vector3d Pair::Data::curved(int i, int node) const {
  const Configuration& now = tracker.configuration();
  const Eigen::Vector3d x = now.x[i].col(node);
  if (side[i].heights.empty()) return x;
  const Eigen::Vector3d X = surface(i).X.col(node);
  return i == 0 ? Eigen::Vector3d(x - now.R * X - now.r) : Eigen::Vector3d(x - X);
}

std::vector<ContactPoint> Pair::Data::integrated_contacts() {
  const int slave_side = settings.slave;
  const Side &slaves = side[slave_side], &masters = side[1 - slave_side];
  const SurfaceView slave = tracker.view(slave_side, 0),
                    faces = tracker.view(1 - slave_side, settings.extension);
  const MasterSide master{faces, masters.heights, radians(settings.feature_angle), false};
  const SecondOrder second{surface(slave_side).side, surface(1 - slave_side).side,
                           [&](int i, int node) { return curved(i, node); }};
  std::vector<ContactPoint> found =
      face_contacts({master, slave, slaves.heights, reach, slave_side, settings.offset}, second,
                    {slaves.law, slaves.area, history[slave_side],
                     [&](int i, int node) { return tracker.velocity(i, node); },
                     [&](int i, int node) { return tracker.moved(i, node); }},
                    node_gaps(slave_side, master));
  history[slave_side].open.clear();
  if (sticks())
    for (const ContactPoint& contact : found) history[slave_side].open[contact.slave_node] = contact.stick;
  return found;
}

// An empty list with room for as many contacts as the last look at all found.
std::vector<ContactPoint> Pair::Data::room() const {
  std::vector<ContactPoint> contacts;
  contacts.reserve(minima[0].size() + minima[1].size() + touching[0].size() + touching[1].size());
  return contacts;
}

std::vector<ContactPoint> Pair::Data::contacts(const Eigen::Matrix3d& R) {
  R_WB = R;
  std::vector<ContactPoint> contacts = room();
  if (settings.points == SlavePoints::faces)
    contacts = integrated_contacts();
  else
    for (int slave : slave_sides(settings)) run_pass(slave, false, contacts);
  if (is_between_steps()) keep_gaps(history, contacts);
  for (ContactPoint& contact : contacts) rotate(contact, R_WB);
  return contacts;
}

// Can contacts be followed? Nodes that stick, points that stay and steps of impacts have a history of their
// own.
bool Pair::Data::may_follow() const {
  return settings.points == SlavePoints::minima && settings.law == ContactLaw::unilateral && !sticks() &&
         kept[0].empty() && kept[1].empty();
}

// The contacts of the last look at all where they are now; nothing if the bodies have moved too far since
// then, or some have vanished.
std::optional<std::vector<ContactPoint>> Pair::Data::followed_contacts(const Eigen::Matrix3d& R) {
  const double within = follows_far ? std::numeric_limits<double>::infinity() : follow_within;
  if (!(follow_within > 0) || !may_follow() || !tracker.stays_within(within)) return {};
  std::vector<ContactPoint> contacts = room();
  for (int slave : slave_sides(settings))
    if (!run_pass(slave, true, contacts)) return {};
  R_WB = R;
  for (ContactPoint& contact : contacts) rotate(contact, R_WB);
  return contacts;
}

}  // namespace elastogear::contact
