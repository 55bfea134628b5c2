#include "elastogear/contact/pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/contact/candidates.h"
#include "elastogear/contact/coarse_search.h"
#include "elastogear/contact/deformation_bound.h"
#include "elastogear/contact/penalty.h"
#include "elastogear/contact/tangent.h"
#include "elastogear/contact/vicinity.h"

namespace elastogear::contact {
namespace {

struct Side {
  const model::Surface* surface;
  Topology topology;
  DeformationBound bound;
  Ball ball;
  Eigen::VectorXd c_p;         // N/m, of each node as slave
  std::vector<int> last_face;  // master face each node touched last; -1
};

Side make_side(const model::Surface& surface, const Settings& settings,
               const Eigen::SparseMatrix<double>* K_r) {
  const int n_s = static_cast<int>(surface.X.cols());
  return {&surface,
          topology(surface.face, n_s),
          deformation_bound(surface.Phi, K_r ? *K_r : Eigen::SparseMatrix<double>()),
          enclosing_ball(surface.X),
          node_stiffness(settings, surface),
          std::vector<int>(n_s, -1)};
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
  for (int i = 0; i < 5; ++i) contact.W.middleRows<3>(3 * i) = (R * contact.W.middleRows<3>(3 * i)).eval();
}

ContactPoint make_contact(const SurfaceView& master, const Winner& w, double c_p, bool full_tangent) {
  const Face face = face_of(master, w.face);
  const Eigen::Vector2d natural = natural_coordinates(face.sides, w.point.u, w.point.v);
  ContactPoint contact;
  contact.face = w.face;
  contact.master_node = master.face.col(w.face);
  contact.N = w.point.N;
  contact.xi = natural[0];
  contact.eta = natural[1];
  contact.n = w.n;
  contact.g_n = w.g_n;
  contact.f = -c_p * w.g_n * w.n;
  contact.energy = 0.5 * c_p * w.g_n * w.g_n;
  Tangent tangent = contact_tangent(face, w, c_p, full_tangent);
  contact.W = std::move(tangent.W);
  contact.k = std::move(tangent.k);
  return contact;
}

}  // namespace

struct Pair::Data {
  Settings settings;
  Side side[2];
  CoarseSearch search;
  double reach;  // m, largest distance of a slave node from a master face's corners that can still matter
  Configuration configuration = {};
  std::optional<Vicinity> vicinity = {};
  const SurfaceMotion* now[2] = {};  // while contacts are detected by motions
  int n_searches = 0, n_displaced = 0;

  SurfaceView view(int i, double extension) const {
    return {side[i].surface->face, side[i].topology, configuration.x[i], extension};
  }
  std::vector<int> passes() const;
  void place(const SurfaceState& a, const SurfaceState& b);
  void place(const SurfaceMotion* motion[2], bool deformed);
  void place_nodes(int i, const std::vector<int>& nodes);
  double way(const SurfaceMotion then[2]) const;
  bool update_vicinity(const SurfaceMotion* motion[2]);
  void list_nodes();
  void measure_clearance();
  void find_vicinity(double margin);
  void find_vicinity(const SurfaceMotion* motion[2]);
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
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

// Of all candidates: those that cannot touch soon are left out, and faces that cannot be nearest.
void Pair::Data::measure_clearance() {
  for (int slave : passes()) vicinity->near[slave] = everything(vicinity->candidates[slave]);
  list_nodes();
  for (int i : {0, 1}) place_nodes(i, vicinity->node[i]);
  vicinity->limit = next_limit(*vicinity, settings.skin);
  vicinity->uses = 0;
  const std::array reach_and_limit{settings.depth + settings.skin, vicinity->limit};
  for (int slave : passes()) {
    Nearby& near = vicinity->near[slave] = {};
    const SurfaceView master = view(1 - slave, settings.extension);
    const Candidates& candidates = vicinity->candidates[slave];
    for (int node : candidates.nodes()) {
      const auto [clearance, faces] =
          approach(master, configuration.x[slave].col(node), reach_and_limit, candidates[node]);
      if (clearance > vicinity->limit) continue;
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
  if (is_used_up) measure_clearance();
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
  for (int i : {0, 1}) vicinity->found_at[i] = *motion[i];
}

void Pair::Data::run_pass(int slave_side, std::vector<ContactPoint>& contacts) {
  const SurfaceView slave = view(slave_side, 0), master = view(1 - slave_side, settings.extension);
  const Limits limits{settings.depth, std::cos(settings.normal_angle * std::numbers::pi / 180)};
  const Candidates& candidates = vicinity->candidates[slave_side];
  const auto around = [&](std::span<const int> faces) {
    return nodes_around(faces, side[1 - slave_side].topology, master.face);
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
    const auto winner = find_winner(master, q, limits, near.faces(i), slaves.last_face[node]);
    slaves.last_face[node] = winner ? winner->face : -1;
    if (!winner) continue;
    contacts.push_back(make_contact(master, *winner, slaves.c_p[node], settings.full_tangent));
    contacts.back().slave_side = slave_side;
    contacts.back().slave_node = node;
  }
}

std::vector<ContactPoint> Pair::Data::contacts(const Eigen::Matrix3d& R_WB) {
  std::vector<ContactPoint> contacts;
  for (int slave : passes()) run_pass(slave, contacts);
  for (ContactPoint& contact : contacts) rotate(contact, R_WB);
  return contacts;
}

// The candidates follow from where they were found.
void Pair::Data::visit_vicinity(Tape& tape) {
  bool found = vicinity.has_value();
  tape(found);
  if (!found) return vicinity.reset();
  SurfaceMotion at[2];
  for (int i : {0, 1}) {
    if (!tape.plays()) at[i] = vicinity->found_at[i];
    tape(at[i].q);
    tape(at[i].r_WB);
    tape(at[i].R_WB);
    validate(at[i], *side[i].surface, i);
  }
  const SurfaceMotion* motion[2] = {&at[0], &at[1]};
  if (tape.plays()) find_vicinity(motion);
}

SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion) {
  SurfaceState state{surface.X, motion.r_WB, motion.R_WB};
  if (motion.q.size() > 0) state.x_B += model::multiply(surface.Phi, motion.q).reshaped(3, surface.X.cols());
  return state;
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
                       settings.depth});
  for (int i : {0, 1}) data_->configuration.x[i] = data_->side[i].surface->X;
  const double reach[2] = {extension_reach(data_->view(0, settings.extension)),
                           extension_reach(data_->view(1, settings.extension))};
  data_->reach += kStretch * std::max(reach[0], reach[1]);
}

Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;

const Settings& Pair::settings() const { return data_->settings; }
int Pair::n_searches() const { return data_->n_searches; }
int Pair::n_displaced() const { return data_->n_displaced; }

void Pair::visit_memory(Tape& tape) {
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
