#include "elastogear/dynamics/chatter.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace elastogear::dynamics {
namespace {

constexpr int kWindow = 50;               // states in which a force is looked at
constexpr double kChange = 0.7;           // of the force from state to state, in the mean
constexpr double kTurns = 0.2 * kWindow;  // a period of ten states has as many

}  // namespace

ChatterWatch::ChatterWatch(const System& system) : system_(&system), force_(system.pairs().size()) {
  for (std::size_t p = 0; p < force_.size(); ++p)
    force_[p].watched = system.contact_settings(p).law == contact::ContactLaw::unilateral;
}

// Enters the force of a state. Returns true at the end of a window in which it went to and fro.
bool ChatterWatch::chatters(Force& force, double now) {
  const double change = now - std::exchange(force.last, now);
  if (change != 0 && std::exchange(force.change, change) * change < 0) ++force.turns;
  force.sum += now;
  force.changes += std::abs(change);
  if (++force.states < kWindow) return false;
  const bool result = force.changes > kChange * force.sum && force.turns > kTurns;
  force = {force.watched, force.last, force.change};
  return result;
}

std::vector<std::string> ChatterWatch::warnings(const model::Snapshot& snapshot) {
  std::vector<std::string> said;
  for (std::size_t p = 0; p < force_.size(); ++p) {
    if (!force_[p].watched || !chatters(force_[p], snapshot.pairs[p].force.norm())) continue;
    force_[p].watched = false;
    std::ostringstream text;
    text.precision(3);
    text << "contact " << system_->pairs()[p].name << " at t = " << snapshot.time
         << " s: chatters, its force goes to and fro from output to output; neither it nor the energy is to "
            "be "
            "trusted. Take -contact_law penalty, bodies with damping_ratio or fewer modes, or outputs nearer "
            "to "
            "each other";
    said.push_back(text.str());
  }
  return said;
}

}  // namespace elastogear::dynamics
