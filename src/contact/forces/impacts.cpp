#include "contact/forces/impacts.h"

#include <algorithm>

namespace elastogear::contact {
namespace {

// Does a gap close within a step? The rate is then held from its start on: gaps of half of the way in a step
// are left, open ones as often as entered ones.
bool may_close(const GapRate& start, double dt) { return start.gap + dt * start.rate <= 0; }

Impact impact_of(const History& history, int point, const Law& law) {
  constexpr double kReturn = 1e-3;   // of its way to the surface, in each step, of a point that is pressed
  constexpr double kBound = 1e4;     // change of a rate over what is left of it
  constexpr double kPressed = 1e-3;  // of the force of the step before: what is left of an impulse is less
  const ImpactStep& step = *history.step;
  const auto start = history.start.find(point);
  Impact impact;
  impact.in_step = history.in_step;
  impact.dt = step.dt;
  if (start != history.start.end()) impact.rate = start->second.rate;
  if (!impact.in_step) return impact;
  impact.closed = history.closed.contains(point);
  impact.may_close =
      impact.closed || law.p_given > 0 || (start != history.start.end() && may_close(start->second, step.dt));
  impact.d = kBound * law.mass / step.dt;
  impact.stiffened = impact.d / (step.dt * law.c_p);
  impact.p_held = law.p_given;
  if (start !=
      history.start.end())  // over a free boundary points may come from the side, with an entered gap
    impact.p_held +=
        impact.stiffened * (1 - start->second.fade) * (law.p_given - law.c_p * start->second.gap);
  impact.alpha_f = step.alpha_f;
  const auto before = history.p_before.find(point);
  const bool pressed = start != history.start.end() && before != history.p_before.end() &&
                       law.p_given > kPressed * before->second;
  impact.least_rate = -law.restitution * std::min(0.0, impact.rate);
  if (pressed && start->second.gap < 0)  // as an oscillator of critical damping
    impact.least_rate = (1 - 2 * kReturn) * impact.rate - kReturn * kReturn * start->second.gap / step.dt;
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
  for (const ContactPoint& c : contacts)
    histories[c.slave_side].near[c.slave_point] = {c.g_n, rate(c), c.fade};
  std::erase_if(contacts, [](const ContactPoint& c) { return !(c.p > 0); });
}

bool take_impulse(Histories& histories, double delivered) {
  constexpr double kLeastChange = 0.1;  // of the forces
  double all = 0, anew = 0;
  for (const History& history : histories)
    for (const auto& [point, p] : history.p) {
      all += p;
      if (!history.p_before.contains(point)) anew += p;
    }
  if (!(anew > kLeastChange * all)) return false;
  for (History& history : histories)
    for (auto& [point, p] : history.p)
      if (!history.p_before.contains(point)) p *= delivered;
  return true;
}

}  // namespace elastogear::contact
