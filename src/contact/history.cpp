#include "contact/history.h"

#include <algorithm>
#include <utility>

namespace elastogear::contact {
namespace {

// The entries of a map, each with its number.
template <class Value, class Visit>
void serialize_map(Archive& archive, std::map<int, Value>& map, const Visit& visit) {
  std::vector<std::pair<int, Value>> entries(map.begin(), map.end());
  archive.each(entries, [&](auto& entry) {
    archive(entry.first);
    visit(entry.second);
  });
  map = {entries.begin(), entries.end()};
}

void require_on(const StickPoint& point, int node, const model::Surface& slave,
                const model::Surface& master) {
  const auto n_nodes = slave.X.cols(), n_faces = master.face.cols();
  require(node >= 0 && node < n_nodes && point.face >= 0 && point.face < n_faces, "contact history: node ",
          node, " on face ", point.face, ", there are ", n_nodes, " nodes and ", n_faces, " faces");
}

}  // namespace

double given_force(const History& history, int point) {
  const auto given = history.p.find(point);
  return given == history.p.end() ? 0 : given->second;
}

namespace {

// Does a gap close within a step? The rate is then held from its start on: gaps of half of the way in a step
// are left, open ones as often as entered ones.
bool may_close(const GapRate& start, double dt) { return start.gap + dt * start.rate <= 0; }

Impact impact_of(const History& history, int point, const Law& law) {
  constexpr double kReturn =
      1e-3;  // of the rest of its way, in each step, of a point pressed back to the surface
  constexpr double kBound = 1e4;     // change of a rate over what is left of it
  constexpr double kPressed = 1e-3;  // of the force of the step before: what is left of an impulse is less
  constexpr double kFadeSteps = 10;  // in which forces fall by half at half the force on an extension
  const ImpactStep& step = *history.step;
  const auto start = history.start.find(point);
  Impact impact;
  impact.in_step = history.in_step;
  impact.dt = step.dt;
  if (start != history.start.end()) {
    impact.gap = start->second.gap;
    impact.rate = start->second.rate;
  }
  if (!impact.in_step) return impact;
  impact.closed = history.closed.contains(point);
  impact.may_close =
      impact.closed || law.p_given > 0 || (start != history.start.end() && may_close(start->second, step.dt));
  impact.d = kBound * law.mass / step.dt;
  impact.d_fade = kFadeSteps * step.dt * law.c_p;
  impact.alpha_f = step.alpha_f;
  const auto before = history.p_before.find(point);
  const bool pressed = before != history.p_before.end() && law.p_given > kPressed * before->second;
  impact.least_rate = -law.restitution * std::min(0.0, impact.rate);
  if (pressed && impact.gap < 0)  // as an oscillator of critical damping
    impact.least_rate = (1 - 2 * kReturn) * impact.rate - kReturn * kReturn * impact.gap / step.dt;
  return impact;
}

double rate(const ContactPoint& c) { return c.g_x.reshaped().dot(c.v.reshaped()); }

}  // namespace

void set_given(const History& history, int point, Law& law) {
  law.p_given = given_force(history, point);
  if (history.step) law.impact = impact_of(history, point, law);
}

void begin_step(History& history, const ImpactStep& step) {
  history.step = step;
  history.in_step = step.dt > 0;
  history.closed.clear();
  if (!history.in_step) return;
  for (const auto& [point, p] : history.p) history.closed.insert(point);
  for (const auto& [point, start] : history.start)
    if (start.rate < 0 && may_close(start, step.dt)) history.closed.insert(point);
}

bool change_closed(Histories& histories, const std::vector<ContactPoint>& contacts) {
  constexpr double kRoundoff = 1e-8;  // of forces and velocities
  double largest = 0;
  for (const ContactPoint& c : contacts) largest = std::max(largest, c.p);
  bool changed = false;
  for (const ContactPoint& c : contacts) {
    History& history = histories[c.slave_side];
    const bool closed = history.closed.contains(c.slave_point);
    if (closed ? c.p >= -kRoundoff * largest : c.excess_rate >= -kRoundoff * c.v.cwiseAbs().maxCoeff())
      continue;
    changed = true;
    if (closed)
      history.closed.erase(c.slave_point);
    else
      history.closed.insert(c.slave_point);
  }
  return changed;
}

void keep_gaps(Histories& histories, std::vector<ContactPoint>& contacts) {
  for (History& history : histories) history.near.clear();
  for (const ContactPoint& c : contacts) histories[c.slave_side].near[c.slave_point] = {c.g_n, rate(c)};
  std::erase_if(contacts, [](const ContactPoint& c) { return !(c.p > 0); });
}

const StickPoint* stuck_at(const History& history, int node) {
  const auto stuck = history.stuck.find(node);
  return stuck == history.stuck.end() ? nullptr : &stuck->second;
}

GivenFriction friction_at(const History& history, int node) {
  const auto given = history.t.find(node);
  return given == history.t.end() ? GivenFriction{} : given->second;
}

void set_forces(Histories& histories, const std::vector<ContactPoint>& contacts, const Eigen::Matrix3d& R) {
  for (History& history : histories) {
    history.p_before = std::exchange(history.p, {});
    history.t.clear();
  }
  for (const ContactPoint& contact : contacts) {
    if (!(contact.p > 0)) continue;
    History& history = histories[contact.slave_side];
    history.p[contact.slave_point] = contact.p;
    if (const auto& f = contact.tangential) history.t[contact.slave_node] = {R * (f->T * f->t), f->slides};
  }
}

bool take_impulse(Histories& histories, double delivered) {
  constexpr double kCounts = 0.1;  // of the forces
  double all = 0, anew = 0;
  for (const History& history : histories)
    for (const auto& [point, p] : history.p) {
      all += p;
      if (!history.p_before.contains(point)) anew += p;
    }
  if (!(anew > kCounts * all)) return false;
  for (History& history : histories)
    for (auto& [point, p] : history.p)
      if (!history.p_before.contains(point)) p *= delivered;
  return true;
}

double unclosed(const Histories& histories, const std::vector<ContactPoint>& contacts,
                const std::function<double(int side, int point)>& stiffness) {
  std::array<std::map<int, double>, 2> before{histories[0].p, histories[1].p};
  double most = 0;
  const auto enter = [&](int side, int point, double change) {
    most = std::max(most, std::abs(change) / stiffness(side, point));
  };
  for (const ContactPoint& contact : contacts) {
    double& p = before[contact.slave_side][contact.slave_point];
    enter(contact.slave_side, contact.slave_point, contact.p - std::exchange(p, 0));
  }
  for (int side : {0, 1})
    for (const auto& [point, p] : before[side]) enter(side, point, p);
  return most;
}

void accept(Histories& histories, const std::vector<ContactPoint>& contacts, bool sticks) {
  for (History& history : histories) {
    history.stuck = std::exchange(history.open, {});
    history.start = std::exchange(history.near, {});
  }
  if (!sticks) return;
  for (const ContactPoint& contact : contacts)
    histories[contact.slave_side].stuck[contact.slave_node] = contact.stick;
}

void serialize(History& history, const model::Surface& slave, const model::Surface& master,
               Archive& archive) {
  serialize_map(archive, history.stuck, [&](StickPoint& point) {
    for (int* n : {&point.slave_side, &point.slave_node, &point.face}) archive(*n);
    for (double* x : {&point.u, &point.v, &point.e_u, &point.e_v}) archive(*x);
    archive(point.slides);
  });
  for (const auto& [node, point] : history.stuck) require_on(point, node, slave, master);
  for (std::map<int, double>* p : {&history.p, &history.p_before})
    serialize_map(archive, *p, [&](double& force) { archive(force); });
  serialize_map(archive, history.t, [&](GivenFriction& given) {
    archive(given.t);
    archive(given.slides);
  });
  serialize_map(archive, history.start, [&](GapRate& at) {
    archive(at.gap);
    archive(at.rate);
  });
  const std::size_t n_nodes = history.last_face.size();
  archive(history.last_face);
  require(history.last_face.size() == n_nodes, "the stored contacts are of other surfaces");
}

}  // namespace elastogear::contact
