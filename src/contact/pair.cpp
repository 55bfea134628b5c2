#include "elastogear/contact/pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/contact/bulge.h"
#include "elastogear/contact/candidates.h"
#include "elastogear/contact/coarse_search.h"
#include "elastogear/contact/contact_point.h"
#include "elastogear/contact/deformation_bound.h"
#include "elastogear/contact/penalty.h"
#include "elastogear/contact/vicinity.h"

namespace elastogear::contact {
namespace {

struct Side {
  const model::Surface* surface;
  Topology topology;
  DeformationBound bound;
  Ball ball;
  std::vector<Law> law;             // of each node as slave
  std::vector<CornerSlopes> bulge;  // of each face as master; empty: facets
  std::vector<int> last_face;       // master face each node touched last; -1
  std::map<int, StickPoint> stuck;  // by slave node, after the last accepted step
};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Side make_side(const model::Surface& surface, const Settings& settings,
               const Eigen::SparseMatrix<double>* K_r) {
  const int n_s = static_cast<int>(surface.X.cols());
  const Topology map = topology(surface.face, n_s);
  const SurfaceView undeformed{surface.face, map, surface.X, 0};
  return {&surface,
          map,
          deformation_bound(surface.Phi, K_r ? *K_r : Eigen::SparseMatrix<double>()),
          enclosing_ball(surface.X),
          node_laws(settings, surface),
          settings.smooth ? corner_slopes(undeformed, radians(settings.crease)) : std::vector<CornerSlopes>(),
          std::vector<int>(n_s, -1),
          {}};
}

// The relative motion for which one measurement of clearance serves: at first this share of the skin, twice
// as much when it has served few stages only, half as much after many.
constexpr double kLimit = 0.125;
constexpr int kFewUses = 8, kManyUses = 64;
constexpr double kStretch = 1.1;  // of prolonged ends when the surface is deformed, generously

double largest_displacement(const SurfaceState& state, const model::Surface& surface) {
  return std::sqrt((state.x_B - surface.X).colwise().squaredNorm().maxCoeff());
}

// How far the prolonged open ends of a surface reach beyond its faces.
double extension_reach(const SurfaceView& surface) {
  double reach = 0;
  for (int f : surface.topology.open_faces) {
    const Face face = face_of(surface, f);
    for (int corner = 0; corner < face.sides; ++corner) {
      const Eigen::Vector2d at = extended_corner(face, corner);
      reach = std::max(reach, (combine(face, shape(face.sides, at[0], at[1]).N) - face.x[corner]).norm());
    }
  }
  return reach;
}

double next_limit(const Vicinity& vicinity, double skin) {
  if (vicinity.limit == 0) return kLimit * skin;
  if (vicinity.uses < kFewUses) return std::min(2 * vicinity.limit, skin);
  return vicinity.uses > kManyUses ? vicinity.limit / 2 : vicinity.limit;
}

// From the common frame to the world.
void rotate(ContactPoint& contact, const Eigen::Matrix3d& R) {
  contact.n = R * contact.n;
  contact.f = R * contact.f;
  contact.F = (R * contact.F).eval();
  contact.slip = R * contact.slip;
  contact.elastic_slip = R * contact.elastic_slip;
  contact.v = (R * contact.v).eval();
  for (LocalColumns* columns : {&contact.W, &contact.V, &contact.V_dot})
    for (int i = 0; i < 5; ++i) columns->middleRows<3>(3 * i) = (R * columns->middleRows<3>(3 * i)).eval();
}

Limits limits_of(const Settings& settings) {
  return {settings.depth, std::cos(radians(settings.normal_angle))};
}

}  // namespace

struct Pair::Data {
  Settings settings;
  Side side[2];
  CoarseSearch search;
  Limits limits;
  double reach;  // m, largest distance of a slave node from a master face's corners that can still matter
  Configuration configuration = {};
  std::optional<Vicinity> vicinity = {};
  const SurfaceMotion* now[2] = {};  // while contacts are detected by motions
  int n_searches = 0, n_displaced = 0;

  SurfaceView view(int i, double extension) const {
    return {side[i].surface->face, side[i].topology, configuration.x[i], extension};
  }
  std::vector<int> passes() const;
  bool sticks() const { return settings.friction.mu > 0 && settings.friction.law == FrictionLaw::stick; }
  void place(const SurfaceState& a, const SurfaceState& b);
  void place(const SurfaceMotion* motion[2], bool deformed);
  void place_nodes(int i, const std::vector<int>& nodes);
  double way(const SurfaceMotion then[2]) const;
  bool update_vicinity(const SurfaceMotion* motion[2]);
  void list_nodes();
  void measure_clearance(double limit);
  void find_vicinity(double margin);
  void find_vicinity(const SurfaceMotion* motion[2]);
  Eigen::Vector3d velocity(int i, int node) const;
  std::optional<ContactPoint> contact(const MasterSide& master, int slave_side, int node,
                                      const Winner& w) const;
  void run_pass(int slave_side, std::vector<ContactPoint>& contacts);
  std::vector<ContactPoint> contacts(const Eigen::Matrix3d& R_WB);
  void visit_vicinity(Tape& tape);
};

std::vector<int> Pair::Data::passes() const {
  return settings.two_pass ? std::vector{settings.slave, 1 - settings.slave} : std::vector{settings.slave};
}

// Common frame: the BRF of b.
void Pair::Data::place(const SurfaceState& a, const SurfaceState& b) {
  const RelativeMotion motion = relative_motion({{}, a.r_WB, a.R_WB}, {{}, b.r_WB, b.R_WB});
  configuration.R = motion.R;
  configuration.r = motion.r;
  configuration.x[0].noalias() = motion.R * a.x_B;
  configuration.x[0].colwise() += motion.r;
  configuration.x[1] = b.x_B;
}

void Pair::Data::place(const SurfaceMotion* motion[2], bool deformed) {
  SurfaceState state[2];
  for (int i : {0, 1})
    state[i] = deformed ? surface_state(*side[i].surface, *motion[i])
                        : SurfaceState{side[i].surface->X, motion[i]->r_WB, motion[i]->R_WB};
  place(state[0], state[1]);
}

// In the common frame, where the motion puts them now.
void Pair::Data::place_nodes(int i, const std::vector<int>& nodes) {
  const RelativeMotion relative = relative_motion(*now[0], *now[1]);
  const model::Surface& surface = *side[i].surface;
  configuration.R = relative.R;
  configuration.r = relative.r;
  for (int node : nodes) {
    const Eigen::Vector3d x_B = surface.X.col(node) + model::displacement(surface.Phi, node, now[i]->q);
    require(x_B.allFinite(), "contact: position of node ", node, " of surface ", i == 0 ? "a" : "b",
            " is not finite");
    configuration.x[i].col(node) = i == 0 ? Eigen::Vector3d(relative.R * x_B + relative.r) : x_B;
  }
  n_displaced += static_cast<int>(nodes.size());
}

// Bound of the relative motion since.
double Pair::Data::way(const SurfaceMotion then[2]) const {
  double way = 0;
  for (int i : {0, 1}) way += largest_displacement(side[i].bound, now[i]->q - then[i].q);
  Ball ball = side[0].ball;
  ball.radius += largest_displacement(side[0].bound, then[0].q);
  return way + travel(ball, relative_motion(then[0], then[1]), relative_motion(*now[0], *now[1]));
}

// Whose positions the fine search of the candidates at hand reads.
void Pair::Data::list_nodes() {
  std::array<std::vector<int>, 2>& lists = vicinity->node;
  for (auto& list : lists) list.clear();
  for (int slave : passes())
    for (int i : {0, 1}) {
      const Topology& t = side[i].topology;
      const Eigen::Matrix4Xi& face = side[i].surface->face;
      const Nearby& near = vicinity->near[slave];
      const auto nodes =
          i == slave ? nodes_around_nodes(near.slave, t, face) : nodes_around(near.face, t, face);
      lists[i].insert(lists[i].end(), nodes.begin(), nodes.end());
    }
  for (int slave : passes())
    for (const auto& [node, point] : side[slave].stuck)
      for (int corner : side[1 - slave].surface->face.col(point.face)) lists[1 - slave].push_back(corner);
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

// Of all candidates: those that cannot touch soon are left out, and faces that cannot be nearest.
void Pair::Data::measure_clearance(double limit) {
  for (int slave : passes()) vicinity->near[slave] = everything(vicinity->candidates[slave]);
  list_nodes();
  for (int i : {0, 1}) place_nodes(i, vicinity->node[i]);
  vicinity->limit = limit;
  vicinity->uses = 0;
  const std::array reach_and_limit{std::max(limits.depth, limits.outside) + settings.skin,
                                   vicinity->limit + limits.outside};
  for (int slave : passes()) {
    Nearby& near = vicinity->near[slave] = {};
    const SurfaceView master = view(1 - slave, settings.extension);
    const Candidates& candidates = vicinity->candidates[slave];
    for (int node : candidates.nodes()) {
      const auto [clearance, faces] =
          approach(master, configuration.x[slave].col(node), reach_and_limit, candidates[node]);
      if (clearance > vicinity->limit + limits.outside) continue;
      near.slave.push_back(node);
      near.face.insert(near.face.end(), faces.begin(), faces.end());
      near.end.push_back(static_cast<int>(near.face.size()));
    }
  }
  list_nodes();
  for (int i : {0, 1}) vicinity->measured_at[i] = *now[i];
}

// Whether it had to be measured again, which places all its nodes.
bool Pair::Data::update_vicinity(const SurfaceMotion* motion[2]) {
  const bool search_is_due = !vicinity || !(way(vicinity->found_at) <= settings.skin);
  if (search_is_due) find_vicinity(motion);
  const bool is_used_up = search_is_due || !(way(vicinity->measured_at) <= vicinity->limit);
  if (is_used_up) measure_clearance(next_limit(*vicinity, settings.skin));
  ++vicinity->uses;
  return is_used_up;
}

// Candidates within `margin` of each other where the nodes are placed now.
void Pair::Data::find_vicinity(double margin) {
  const auto& face_pairs = search.face_pairs(configuration, margin);
  if (!vicinity) vicinity.emplace();
  for (int slave : passes()) {
    Candidates& candidates = vicinity->candidates[slave];
    candidates.collect(face_pairs, slave, view(slave, 0), view(1 - slave, settings.extension), margin);
    vicinity->near[slave] = everything(candidates);
  }
  ++n_searches;
}

void Pair::Data::find_vicinity(const SurfaceMotion* motion[2]) {
  const bool deformed = settings.update == Update::refit;
  double margin = reach + settings.skin;
  for (int i : {0, 1})
    if (!deformed) margin += largest_displacement(side[i].bound, motion[i]->q);
  place(motion, deformed);
  find_vicinity(margin);
  for (int i : {0, 1}) vicinity->found_at[i] = {motion[i]->q, motion[i]->r_WB, motion[i]->R_WB};
}

// Components in the common frame.
Eigen::Vector3d Pair::Data::velocity(int i, int node) const {
  if (!now[i]) return Eigen::Vector3d::Zero();
  const SurfaceMotion& m = *now[i];
  const model::Surface& surface = *side[i].surface;
  const Eigen::Vector3d x = configuration.x[i].col(node);
  const Eigen::Vector3d x_B =
      i == 0 ? Eigen::Vector3d(configuration.R.transpose() * (x - configuration.r)) : x;
  Eigen::Vector3d v = m.v_WB_B + m.w_WB_B.cross(x_B);
  if (m.q_dot.size() > 0) v += model::displacement(surface.Phi, node, m.q_dot);
  return i == 0 ? Eigen::Vector3d(configuration.R * v) : v;
}

std::optional<ContactPoint> Pair::Data::contact(const MasterSide& master, int slave_side, int node,
                                                const Winner& w) const {
  const Side& slaves = side[slave_side];
  const Law& law = slaves.law[node];
  if (has_potential(settings)) return potential_contact(master, w, law.c_p, settings.full_tangent);
  const auto rate = [&](int i, int n) { return velocity(i == 0 ? slave_side : 1 - slave_side, n); };
  const auto stuck = slaves.stuck.find(node);
  const Eigen::Vector3d x = configuration.x[slave_side].col(node);
  return general_contact(master, {w, node, x, rate, stuck == slaves.stuck.end() ? nullptr : &stuck->second},
                         law);
}

void Pair::Data::run_pass(int slave_side, std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = view(slave_side, 0), surface = view(1 - slave_side, settings.extension);
  const MasterSide master{surface, side[1 - slave_side].bulge, radians(settings.crease)};
  const Candidates& candidates = vicinity->candidates[slave_side];
  const auto around = [&](std::span<const int> faces) {
    return nodes_around(faces, side[1 - slave_side].topology, surface.face);
  };
  Side& slaves = side[slave_side];
  const Nearby& near = vicinity->near[slave_side];
  for (std::size_t i = 0; i < near.slave.size(); ++i) {
    const int node = near.slave[i];
    const auto all_faces = [&] {
      if (now[0]) place_nodes(1 - slave_side, around(candidates[node]));
      return candidates[node];
    };
    const SlaveNode q{slave.x.col(node), [&] { return node_normal(slave, node); }, all_faces};
    const auto winner = find_winner(surface, q, limits, near.faces(i), slaves.last_face[node]);
    slaves.last_face[node] = winner ? winner->face : -1;
    if (!winner) continue;
    auto found = contact(master, slave_side, node, *winner);
    if (!found) continue;
    found->slave_side = found->stick.slave_side = slave_side;
    found->slave_node = found->stick.slave_node = node;
    contacts.push_back(std::move(*found));
  }
}

std::vector<ContactPoint> Pair::Data::contacts(const Eigen::Matrix3d& R_WB) {
  std::vector<ContactPoint> contacts;
  for (int slave : passes()) run_pass(slave, contacts);
  for (ContactPoint& contact : contacts) rotate(contact, R_WB);
  return contacts;
}

void visit_motion(SurfaceMotion (&motion)[2], const Side (&side)[2], Tape& tape) {
  for (int i : {0, 1}) {
    tape(motion[i].q);
    tape(motion[i].r_WB);
    tape(motion[i].R_WB);
    validate(motion[i], *side[i].surface, i);
  }
}

// Candidates and their clearance follow from where they were found.
void Pair::Data::visit_vicinity(Tape& tape) {
  bool found = vicinity.has_value();
  tape(found);
  if (!found) return vicinity.reset();
  Vicinity then = vicinity.value_or(Vicinity{});
  visit_motion(then.found_at, side, tape);
  visit_motion(then.measured_at, side, tape);
  tape(then.limit);
  tape(then.uses);
  if (!tape.plays()) return;
  const SurfaceMotion* motion[2] = {&then.found_at[0], &then.found_at[1]};
  find_vicinity(motion);
  for (int i : {0, 1}) now[i] = &then.measured_at[i];
  measure_clearance(then.limit);
  vicinity->uses = then.uses;
  std::fill_n(now, 2, nullptr);
}

SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion) {
  SurfaceState state{surface.X, motion.r_WB, motion.R_WB};
  if (motion.q.size() > 0) state.x_B += model::multiply(surface.Phi, motion.q).reshaped(3, surface.X.cols());
  return state;
}

void Pair::accept(const std::vector<ContactPoint>& contacts) {
  for (Side& side : data_->side) side.stuck.clear();
  if (!data_->sticks()) return;
  for (const ContactPoint& contact : contacts)
    data_->side[contact.slave_side].stuck[contact.slave_node] = contact.stick;
}

std::vector<StickPoint> Pair::history() const {
  std::vector<StickPoint> all;
  for (const Side& side : data_->side)
    for (const auto& [node, point] : side.stuck) all.push_back(point);
  return all;
}

void Pair::restore(const std::vector<StickPoint>& history) {
  for (Side& side : data_->side) side.stuck.clear();
  for (const StickPoint& point : history) {
    require(point.slave_side == 0 || point.slave_side == 1, "contact history: slave side ", point.slave_side,
            ", allowed are 0 and 1");
    Side& slave = data_->side[point.slave_side];
    const auto n_nodes = slave.surface->X.cols(),
               n_faces = data_->side[1 - point.slave_side].surface->face.cols();
    require(point.slave_node >= 0 && point.slave_node < n_nodes && point.face >= 0 && point.face < n_faces,
            "contact history: node ", point.slave_node, " on face ", point.face, ", there are ", n_nodes,
            " nodes and ", n_faces, " faces");
    slave.stuck[point.slave_node] = point;
  }
  data_->vicinity.reset();  // must hold the nodes of all faces remembered
}

Pair::Pair(const model::Surface& a, const model::Surface& b, const Settings& given,
           const std::array<const Eigen::SparseMatrix<double>*, 2>& K_r) {
  validate(given);
  validate(a, 0);
  validate(b, 1);
  const Settings settings = with_defaults(given, a, b);
  data_.reset(new Data{settings,
                       {make_side(a, settings, K_r[0]), make_side(b, settings, K_r[1])},
                       CoarseSearch(a, b, settings.k, settings.update),
                       limits_of(settings),
                       0});
  for (int i : {0, 1}) data_->configuration.x[i] = data_->side[i].surface->X;
  const double reach[2] = {extension_reach(data_->view(0, settings.extension)),
                           extension_reach(data_->view(1, settings.extension))};
  Limits& limits = data_->limits;
  const double height = std::max(largest_height(data_->side[0].bulge), largest_height(data_->side[1].bulge));
  limits.outside = height + std::max(0.0, -settings.offset);
  limits.depth += height + std::max(0.0, settings.offset);
  data_->reach = limits.depth + kStretch * std::max(reach[0], reach[1]);
}

Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;

const Settings& Pair::settings() const { return data_->settings; }
int Pair::n_searches() const { return data_->n_searches; }
int Pair::n_displaced() const { return data_->n_displaced; }

void Pair::visit_memory(Tape& tape) {
  std::vector<StickPoint> stuck = history();
  tape.each(stuck, [&](StickPoint& point) {
    for (int* n : {&point.slave_side, &point.slave_node, &point.face}) tape(*n);
    for (double* x : {&point.u, &point.v, &point.e_u, &point.e_v}) tape(*x);
    tape(point.slides);
  });
  if (tape.plays()) restore(stuck);  // before the vicinity, which it resets
  data_->visit_vicinity(tape);
  for (Side& side : data_->side) {
    const std::size_t n_nodes = side.last_face.size();
    tape(side.last_face);
    require(side.last_face.size() == n_nodes, "the stored contacts are of other surfaces");
  }
}

std::vector<ContactPoint> Pair::detect(const SurfaceState& a, const SurfaceState& b) {
  Data& d = *data_;
  const SurfaceState* state[2] = {&a, &b};
  std::fill_n(d.now, 2, nullptr);
  double margin = d.reach;
  for (int i : {0, 1}) {
    validate(*state[i], *d.side[i].surface, i);
    if (d.settings.update == Update::realign) margin += largest_displacement(*state[i], *d.side[i].surface);
  }
  d.place(a, b);
  d.find_vicinity(margin);
  std::vector<ContactPoint> contacts = d.contacts(b.R_WB);
  d.vicinity.reset();  // of no use for a surface whose motion is not known
  return contacts;
}

std::vector<ContactPoint> Pair::detect(const SurfaceMotion& a, const SurfaceMotion& b) {
  const SurfaceMotion* motion[2] = {&a, &b};
  for (int i : {0, 1}) validate(*motion[i], *data_->side[i].surface, i);
  Data& d = *data_;
  std::copy(motion, motion + 2, d.now);
  d.n_displaced = 0;
  if (!d.update_vicinity(motion))
    for (int i : {0, 1}) d.place_nodes(i, d.vicinity->node[i]);
  return d.contacts(b.R_WB);
}

}  // namespace elastogear::contact
