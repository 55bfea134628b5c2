#include "elastogear/contact/pair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "contact/faces/face_contacts.h"
#include "contact/forces/gap_minima.h"
#include "contact/history.h"
#include "contact/impacts.h"
#include "contact/kept_minima.h"
#include "contact/projection/edges.h"
#include "contact/projection/heights.h"
#include "contact/reach.h"
#include "contact/search/tracker.h"
#include "contact/settings.h"
#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

struct Side {
  std::vector<Law> law;        // of each node as slave
  Heights heights;             // over its faces
  std::vector<bool> responds;  // of each node: has it a static response? Empty: all have
  Eigen::VectorXd area;        // m^2, of each node, undeformed; of contact integrated over faces
};

// A point of the slave: its number, and its place between nodes, or at one.
struct OnSlave {
  int side, point;
  const Eigen::Vector4i& nodes;
  const Eigen::Vector4d& N;
};

std::vector<int> untouched(const model::Surface& surface) {
  return std::vector<int>(static_cast<std::size_t>(surface.X.cols()), -1);
}

// Functions that capture it and one thing more fit into std::function, which allocates nothing for them.
struct PlacedNode {
  int side, node;
  Eigen::Vector3d x;  // m
};

// Tells whether all points of a surface are tried as slaves, and not those of its edges alone.
bool is_whole(const Settings& settings, int slave_side) {
  return settings.two_pass || slave_side == settings.slave;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// The nodes of a surface that are tried as slaves; empty: all, which those are that its pass is for. A
// surface of which they are not may meet the slave's faces with its edges alone, between the nodes of these.
std::vector<bool> tried_nodes(const Tracked& tracked, const Settings& settings, bool is_whole) {
  if (is_whole) return {};
  const SurfaceView undeformed{tracked.surface->face, tracked.topology, tracked.surface->X, 0};
  return settings.points == SlavePoints::minima ? boundary_nodes(undeformed)
                                                : edge_nodes(undeformed, radians(settings.feature_angle));
}

Heights heights_of(const Tracked& tracked, const Settings& settings, const TrueSurface* known) {
  const model::Surface& surface = *tracked.surface;
  const SurfaceView undeformed{surface.face, tracked.topology, surface.X, 0};
  return make_heights(undeformed, settings.surface, radians(settings.feature_angle),
                      known ? *known : TrueSurface{});
}

Side make_side(const model::Surface& surface, const Settings& settings, Heights heights,
               std::vector<bool> responds) {
  return {node_laws(settings, surface), std::move(heights), std::move(responds),
          settings.points == SlavePoints::faces ? node_areas(surface.X, surface.face) : Eigen::VectorXd()};
}

Settings complete(Settings settings, const model::Surface& a, const model::Surface& b) {
  if (settings.law == ContactLaw::automatic) settings.law = chosen_law(settings, false);
  settings.points = chosen_points(settings, settings.slave == 0 ? a : b);
  validate(settings);
  validate(a, 0);
  validate(b, 1);
  return with_defaults(settings, a, b);
}

// Contact that is integrated over faces knows the law of its slave nodes alone: without any static response
// of the master, those that have none either keep the compliance of the penalty.
void soften_without_response(Side& slave, const Side& master) {
  const auto any = [](const std::vector<bool>& r) { return std::find(r.begin(), r.end(), true) != r.end(); };
  if (slave.responds.empty() || master.responds.empty() || any(master.responds)) return;
  for (std::size_t node = 0; node < slave.law.size(); ++node)
    if (!slave.responds[node]) slave.law[node].compliance = 1;
}

// The smooth surface behind facets, which are as curved as that where faces are held; none elsewhere.
Heights behind_facets(const Tracked& tracked, const Side& side, const Settings& settings) {
  if (settings.points != SlavePoints::faces || !side.heights.empty()) return {};
  const model::Surface& surface = *tracked.surface;
  return make_heights({surface.face, tracked.topology, surface.X, 0}, ContactSurface::smooth,
                      radians(settings.feature_angle), {});
}

// From the common frame to the world.
void rotate(ContactPoint& contact, const Eigen::Matrix3d& R) {
  contact.n = R * contact.n;
  contact.f = R * contact.f;
  for (LocalVectors* vectors : {&contact.F, &contact.F_p, &contact.g_x, &contact.v})
    for (auto vector : vectors->colwise()) vector = (R * vector).eval();
  contact.slip = R * contact.slip;
  contact.elastic_slip = R * contact.elastic_slip;
  if (contact.tangential) contact.tangential->T = R * contact.tangential->T;
  const auto rotate_rows = [&](auto& columns) {
    for (int i = 0; i < contact.n_local(); ++i)
      columns.template middleRows<3>(3 * i) = (R * columns.template middleRows<3>(3 * i)).eval();
  };
  for (LocalColumns* columns : {&contact.W, &contact.V, &contact.V_dot})
    if (!columns->isZero(0)) rotate_rows(*columns);
  if (!contact.tangential) return;
  rotate_rows(contact.tangential->F_t);
  rotate_rows(contact.tangential->u_x);
}

}  // namespace

struct Pair::Data {
  Settings given, settings;
  Side side[2];
  Histories history;
  Reach reach;
  Tracker tracker;
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  // from the frame that contacts are found in
  std::vector<Minimum> minima[2] = {};                 // of the last look
  KeptMinima kept[2] = {};                             // that bore a force since the last release

  static std::unique_ptr<Data> make(const Settings& given, const Settings& settings,
                                    std::array<Tracked, 2> both, std::array<Side, 2> side);
  bool sticks() const { return settings.friction.mu > 0 && settings.friction.law == FrictionLaw::stick; }
  const model::Surface& surface(int i) const { return *tracker.side(i).surface; }
  bool is_between_steps() const { return history[0].step && !history[0].in_step; }
  bool is_whole(int slave_side) const { return contact::is_whole(settings, slave_side); }
  void keep_stuck();
  Law law(const OnSlave& at, int master_face) const;
  Eigen::Vector3d node_height(int slave_side, const SurfaceView& slave, int node) const;
  std::optional<ContactPoint> node_contact(const MasterSide& master, const PlacedNode& slave,
                                           const Projection& w, std::map<int, NodeGap>& gaps) const;
  std::optional<ContactPoint> contact(const MasterSide& master, int slave_side, const Minimum& m) const;
  double stiffness(int slave_side, int point) const;
  std::optional<Projection> project(const MasterSide& master, const SurfaceView& slave,
                                    const PlacedNode& placed, std::span<const int> faces);
  bool is_left_to_slave(int tried, const SurfaceView& other, const Projection& w) const;
  void run_pass(int slave_side, std::vector<ContactPoint>& contacts);
  void add_minima(const MasterSide& master, int slave_side, const std::map<int, NodeGap>& gaps,
                  std::vector<ContactPoint>& contacts);
  std::map<int, NodeGap> node_gaps(int slave_side, const MasterSide& master);
  Eigen::Vector3d curved(int i, int node) const;
  std::vector<ContactPoint> integrated_contacts();
  std::vector<ContactPoint> contacts(const Eigen::Matrix3d& R);
};

// The corners of the faces on which nodes stick must be placed as long as these nodes stick.
void Pair::Data::keep_stuck() {
  std::array<std::vector<int>, 2> corners;
  for (int slave : slave_sides(settings))
    for (const auto& [node, point] : history[slave].stuck)
      for (int corner : surface(1 - slave).face.col(point.face)) corners[1 - slave].push_back(corner);
  tracker.keep(std::move(corners));
}

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
  if (settings.points == SlavePoints::nodes) return Eigen::Vector3d::Zero();
  const int corner = slave.topology.node_corners[node][0];
  SlavePoint point;
  point.face = corner / 4;
  point.at = on_side(side_count(slave.face, point.face), corner % 4, 0);
  return slave_geometry(slave, side[slave_side].heights, point).e;
}

// Contact of a node; its gap goes to `gaps` where minima are sought.
std::optional<ContactPoint> Pair::Data::node_contact(const MasterSide& master, const PlacedNode& slave,
                                                     const Projection& w,
                                                     std::map<int, NodeGap>& gaps) const {
  const int slave_side = slave.side, node = slave.node;
  const Law law =
      this->law({slave_side, node, Eigen::Vector4i::Constant(node), Eigen::Vector4d::Unit(0)}, w.face);
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

std::optional<ContactPoint> Pair::Data::contact(const MasterSide& master, int slave_side,
                                                const Minimum& m) const {
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

void Pair::Data::add_minima(const MasterSide& master, int slave_side, const std::map<int, NodeGap>& gaps,
                            std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = tracker.view(slave_side, 0);
  const GapField field{master,     slave,           side[slave_side].heights, reach,
                       slave_side, settings.offset, is_whole(slave_side)};
  minima[slave_side] = gap_minima(field, gaps);
  add_kept(field, kept[slave_side], minima[slave_side]);
  for (const Minimum& m : minima[slave_side]) {
    auto found = contact(master, slave_side, m);
    if (!found) continue;
    found->slave_side = slave_side;
    contacts.push_back(std::move(*found));
  }
}

// faces: of the master, that can be nearest.
std::optional<Projection> Pair::Data::project(const MasterSide& master, const SurfaceView& slave,
                                              const PlacedNode& placed, std::span<const int> faces) {
  const SlaveNode q{placed.x,
                    [this, &placed] {
                      tracker.place_around(placed.side, placed.node);
                      return node_normal(tracker.view(placed.side, 0), placed.node);
                    },
                    [this, &placed] { return tracker.all_faces(placed.side, placed.node); }};
  const Limits limits = limits_at(reach, placed.side, slave.topology.node_corners[placed.node]);
  int& last_face = history[placed.side].last_face[placed.node];
  int& nearest = history[placed.side].nearest_face[placed.node];
  auto projection = find_projection(master.surface, q, limits, faces, &nearest);
  if (projection && std::binary_search(faces.begin(), faces.end(), last_face))
    projection = kept_projection(master, *projection, placed.x, last_face);
  last_face = projection ? projection->face : -1;
  return projection;
}

// Tells whether a node of the master's edges lies over an open side of the slave: where both surfaces end,
// the nodes of the slave keep them apart.
bool Pair::Data::is_left_to_slave(int tried, const SurfaceView& other, const Projection& w) const {
  return !is_whole(tried) && settings.points == SlavePoints::nodes &&
         is_at_open_side(other, w.face, w.point.N);
}

void Pair::Data::run_pass(int slave_side, std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = tracker.view(slave_side, 0),
                    surface = tracker.view(1 - slave_side, settings.extension);
  const bool at_minima = settings.points == SlavePoints::minima;
  const Heights& heights = side[1 - slave_side].heights;
  const MasterSide master{surface, heights, radians(settings.feature_angle), !at_minima,
                          at_minima && !heights.empty()};
  const Neighbours& near = tracker.near(slave_side);
  std::map<int, NodeGap> gaps;
  history[slave_side].open.clear();
  for (std::size_t i = 0; i < near.slave.size(); ++i) {
    const int node = near.slave[i];
    const PlacedNode placed{slave_side, node, slave.x.col(node) + node_height(slave_side, slave, node)};
    const auto projection = project(master, slave, placed, near.faces(i));
    if (!projection || is_left_to_slave(slave_side, surface, *projection)) continue;
    auto found = node_contact(master, placed, *projection, gaps);
    if (!found) continue;
    found->slave_side = found->stick.slave_side = slave_side;
    found->slave_point = found->slave_node = found->stick.slave_node = node;
    found->slave_nodes[0] = node;
    if (sticks()) history[slave_side].open[node] = found->stick;
    contacts.push_back(std::move(*found));
  }
  if (settings.points == SlavePoints::minima) add_minima(master, slave_side, gaps, contacts);
}

// The gaps at the slave nodes beside which one may lie within the reach.
std::map<int, NodeGap> Pair::Data::node_gaps(int slave_side, const MasterSide& master) {
  const SurfaceView slave = tracker.view(slave_side, 0);
  const Neighbours& near = tracker.near(slave_side);
  std::map<int, NodeGap> gaps;
  for (std::size_t i = 0; i < near.slave.size(); ++i) {
    const int node = near.slave[i];
    const std::span<const int> around = slave.topology.node_corners[node];
    const PlacedNode placed{slave_side, node, slave.x.col(node) + node_height(slave_side, slave, node)};
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

std::vector<ContactPoint> Pair::Data::contacts(const Eigen::Matrix3d& R) {
  R_WB = R;
  std::vector<ContactPoint> contacts;
  if (settings.points == SlavePoints::faces)
    contacts = integrated_contacts();
  else
    for (int slave : slave_sides(settings)) run_pass(slave, contacts);
  if (is_between_steps()) keep_gaps(history, contacts);
  for (ContactPoint& contact : contacts) rotate(contact, R_WB);
  return contacts;
}

SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion) {
  SurfaceState state{surface.X, motion.r_WB, motion.R_WB};
  if (motion.q.size() > 0) state.x_B += model::multiply(surface.Phi, motion.q).reshaped(3, surface.X.cols());
  return state;
}

Eigen::Vector3d Pair::position(int side, int node) const { return data_->tracker.position_B(side, node); }

void Pair::set_forces(const std::vector<ContactPoint>& contacts) {
  contact::set_forces(data_->history, contacts, data_->R_WB.transpose());
}

void Pair::keep_minima(const std::vector<ContactPoint>& contacts) {
  for (int side : {0, 1}) keep_loaded(contacts, side, data_->minima[side], data_->kept[side]);
}

void Pair::release_minima() {
  for (KeptMinima& kept : data_->kept) kept.clear();
}

// N/m, of a node, or for points between nodes the mean of all.
double Pair::Data::stiffness(int slave_side, int point) const {
  const std::vector<Law>& law = side[slave_side].law;
  if (static_cast<std::size_t>(point) < law.size()) return law[point].c_p;
  double sum = 0;
  for (const Law& one : law) sum += one.c_p;
  return sum / static_cast<double>(law.size());
}

double Pair::unclosed(const std::vector<ContactPoint>& contacts) const {
  return contact::unclosed(data_->history, contacts,
                           [this](int side, int point) { return data_->stiffness(side, point); });
}

void Pair::stiffen(double factor) {
  for (Side& side : data_->side)
    for (Law& law : side.law) {
      law.stiffened *= factor;
      law.c_p *= factor;
      law.c_t *= factor;
    }
}

void Pair::set_masses(int side, const Eigen::VectorXd& mass) {
  for (Eigen::Index i = 0; Law & law : data_->side[side].law) law.mass = mass[i++];
}

void Pair::begin_step(const ImpactStep& step) {
  for (History& history : data_->history) contact::begin_step(history, step);
}

bool Pair::change_closed(const std::vector<ContactPoint>& contacts) {
  return contact::change_closed(data_->history, contacts);
}

bool Pair::end_step(const std::vector<ContactPoint>* contacts, double delivered) {
  for (History& history : data_->history) history.in_step = false;
  if (!contacts) return false;
  set_forces(*contacts);
  return take_impulse(data_->history, delivered);
}

void Pair::accept(const std::vector<ContactPoint>& contacts) {
  contact::accept(data_->history, contacts, data_->sticks());
  data_->keep_stuck();
  if (data_->sticks() && data_->settings.points == SlavePoints::faces) data_->tracker.remember();
}

std::unique_ptr<Pair::Data> Pair::Data::make(const Settings& given, const Settings& settings,
                                             std::array<Tracked, 2> both, std::array<Side, 2> side) {
  for (int i : {0, 1}) soften_without_response(side[i], side[1 - i]);
  std::array<Heights, 2> curved;
  for (int i : {0, 1}) curved[i] = behind_facets(both[i], side[i], settings);
  const auto heights = [&](int i) { return curved[i].empty() ? &side[i].heights : &curved[i]; };
  const Reach reach = reach_of(settings, {&both[0], &both[1]}, {heights(0), heights(1)});
  std::array<SlaveNodes, 2> slaves;
  for (int i : {0, 1})
    slaves[i] = {tried_nodes(both[i], settings, contact::is_whole(settings, i)),
                 spare(reach, i, both[i].topology)};
  const model::Surface &a = *both[0].surface, &b = *both[1].surface;
  return std::unique_ptr<Data>(
      new Data{given,
               settings,
               {std::move(side[0]), std::move(side[1])},
               {History{untouched(a), untouched(a)}, History{untouched(b), untouched(b)}},
               reach,
               Tracker(std::move(both), settings, reach.limits, std::move(slaves))});
}

Pair::Pair(const model::Surface& a, const model::Surface& b, const Settings& given,
           const std::array<const Eigen::SparseMatrix<double>*, 2>& K_r,
           const std::array<const TrueSurface*, 2>& known, const std::array<std::vector<bool>, 2>& responds) {
  const Settings settings = complete(given, a, b);
  std::array<Tracked, 2> both{tracked(a, K_r[0]), tracked(b, K_r[1])};
  const auto side = [&](int i) {
    return make_side(*both[i].surface, settings, heights_of(both[i], settings, known[i]), responds[i]);
  };
  std::array<Side, 2> sides{side(0), side(1)};
  data_ = Data::make(given, settings, std::move(both), std::move(sides));
}

Pair::Pair(const Pair& like, const Settings& given) {
  const Tracker& tracker = like.data_->tracker;
  const Settings settings = complete(given, like.data_->surface(0), like.data_->surface(1));
  const auto side = [&](int i) {
    return make_side(like.data_->surface(i), settings, like.data_->side[i].heights, {});
  };
  data_ = Data::make(given, settings, {tracker.side(0), tracker.side(1)}, {side(0), side(1)});
}

Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;

const Settings& Pair::given() const { return data_->given; }
const Settings& Pair::settings() const { return data_->settings; }
const model::Surface& Pair::surface(int side) const { return data_->surface(side); }
int Pair::n_searches() const { return data_->tracker.n_searches(); }
int Pair::n_displaced() const { return data_->tracker.n_displaced(); }

void Pair::serialize(Archive& archive) {
  for (int i : {0, 1})
    contact::serialize(data_->history[i], data_->surface(i), data_->surface(1 - i), archive);
  if (archive.is_loading()) {
    data_->keep_stuck();
    data_->tracker.forget();  // the nodes kept are placed from the next search on
  }
  data_->tracker.serialize(archive);
}

std::vector<ContactPoint> Pair::detect(const SurfaceState& a, const SurfaceState& b) {
  data_->tracker.find(a, b);
  std::vector<ContactPoint> contacts = data_->contacts(b.R_WB);
  data_->tracker.forget();  // of no use for a surface whose motion is not known
  return contacts;
}

std::vector<ContactPoint> Pair::detect(const SurfaceMotion& a, const SurfaceMotion& b,
                                       const std::array<ResidualDisplacement, 2>& residual) {
  data_->tracker.follow(a, b, residual);
  return data_->contacts(b.R_WB);
}

}  // namespace elastogear::contact
