#include "elastogear/contact/pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/faces/face_contacts.h"
#include "contact/forces/impacts.h"
#include "contact/pair_data.h"
#include "contact/projection/edges.h"
#include "contact/search/surface_checks.h"
#include "contact/settings.h"
#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

std::vector<int> untouched(const model::Surface& surface) {
  return std::vector<int>(static_cast<std::size_t>(surface.X.cols()), -1);
}

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

// Marks the nodes out of which the surface stands by more than roundoff.
std::vector<bool> standing_out(const Tracked& tracked, const Heights& heights) {
  constexpr double kRoundoff = 1e-12;  // m
  const Topology& topology = tracked.topology;
  std::vector<bool> result(static_cast<std::size_t>(topology.node_corners.size()), false);
  for (int node = 0; node < topology.node_corners.size() && !heights.empty(); ++node) {
    if (topology.node_corners[node].empty()) continue;
    const int corner = topology.node_corners[node][0], f = corner / 4;
    const int sides = side_count(tracked.surface->face, f);
    const Eigen::Vector2d at = on_side(sides, corner % 4, 0);
    result[static_cast<std::size_t>(node)] = std::abs(height(heights, sides, f, at[0], at[1]).f) > kRoundoff;
  }
  return result;
}

// The smooth surface behind facets, which are as curved as that where faces are held; none elsewhere.
Heights behind_facets(const Tracked& tracked, const Side& side, const Settings& settings) {
  if (settings.points != SlavePoints::faces || !side.heights.empty()) return {};
  const model::Surface& surface = *tracked.surface;
  return make_heights({surface.face, tracked.topology, surface.X, 0}, ContactSurface::smooth,
                      radians(settings.feature_angle), {});
}

}  // namespace

// The corners of the faces on which nodes stick must be placed as long as these nodes stick.
void Pair::Data::keep_stuck() {
  std::array<std::vector<int>, 2> corners;
  for (int slave : slave_sides(settings))
    for (const auto& [node, point] : history[slave].stuck)
      for (int corner : surface(1 - slave).face.col(point.face)) corners[1 - slave].push_back(corner);
  tracker.keep(std::move(corners));
}

// Keeps the local minimum-gap points of an accepted step for the next one, where the law is that of impacts.
void Pair::Data::stand() {
  for (int slave : {0, 1})
    if (history[slave].step)
      history[slave].standing = standing_points(minima[slave], history[slave].standing);
}

// N/m, of a node, or for points between nodes the mean of all.
double Pair::Data::stiffness(int slave_side, int point) const {
  const std::vector<Law>& law = side[slave_side].law;
  if (static_cast<std::size_t>(point) < law.size()) return law[point].c_p;
  double sum = 0;
  for (const Law& one : law) sum += one.c_p;
  return sum / static_cast<double>(law.size());
}

SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion) {
  SurfaceState state{surface.X, motion.r_WB, motion.R_WB};
  if ((motion.q.array() != 0).any())
    state.x_B += model::multiply(surface.Phi, motion.q).reshaped(3, surface.X.cols());
  return state;
}

Eigen::Vector3d Pair::position(int side, int node) const { return data_->tracker.position_B(side, node); }

double Pair::travel(int side, const SurfaceMotion& from, const SurfaceMotion& to) const {
  const Tracked& surface = data_->tracker.side(side);
  Ball ball = surface.ball;
  ball.radius += largest_displacement(surface.bound, from.q);
  return largest_displacement(surface.bound, to.q - from.q) +
         contact::travel(ball, {from.R_WB, from.r_WB}, {to.R_WB, to.r_WB});
}

void Pair::set_forces(const std::vector<ContactPoint>& contacts) {
  contact::set_forces(data_->history, contacts, data_->R_WB.transpose());
}

void Pair::keep_minima(const std::vector<ContactPoint>& contacts) {
  for (int side : {0, 1}) keep_loaded(contacts, side, data_->minima[side], data_->kept[side]);
}

void Pair::follow_points() {
  constexpr double kOfReach = 0.5;  // of open candidates: others stay open
  data_->follow_within = kOfReach * data_->reach.gap;
}

void Pair::follow_far(bool far) { data_->follows_far = far; }

void Pair::look_at_all() { data_->tracker.forget_near(); }

bool Pair::release_minima() {
  bool any = false;
  for (KeptMinima& kept : data_->kept)
    for (const auto& [number, point] : std::exchange(kept, {})) any |= point.stays;
  return any;
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
  data_->stand();
  data_->keep_stuck();
  if (data_->sticks() && data_->settings.points == SlavePoints::faces) data_->tracker.remember();
}

std::unique_ptr<Pair::Data> Pair::Data::make(const Settings& given, const Settings& settings,
                                             std::array<Tracked, 2> both, std::array<Side, 2> side) {
  for (int i : {0, 1}) soften_without_response(side[i], side[1 - i]);
  for (int i : {0, 1}) side[i].stands_out = standing_out(both[i], side[i].heights);
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

Pair::Pair(const Pair& other) : data_(std::make_unique<Data>(*other.data_)) {}
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
  data_->tracker.move_to(a, b, residual);
  if (auto contacts = data_->followed_contacts(b.R_WB)) return std::move(*contacts);
  data_->tracker.find_near();
  return data_->contacts(b.R_WB);
}

}  // namespace elastogear::contact
