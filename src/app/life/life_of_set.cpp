#include "app/life/life_of_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

// The tooth whose middle is nearest, from 1.
int nearest_tooth(const gear::Toothing& toothing, const Eigen::Vector3d& x) {
  const double pitch = 2 * std::numbers::pi / toothing.z;
  const double turns = (std::atan2(x[1], x[0]) - x[2] / toothing.p - toothing.theta_1) / pitch;
  const int tooth = static_cast<int>(std::lround(turns)) % toothing.z;
  return (tooth + toothing.z) % toothing.z + 1;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// passes: of the history in one revolution of the first gear.
io::CycleTable cycle_table(const Eigen::MatrixXd& history, const std::vector<life::Block>& blocks,
                           const Strength& strength, double passes) {
  const life::SnCurve curve = life::fully_reversed(strength.curve, strength.mean_stress);
  io::CycleTable table;
  std::vector<double> range, mean, amplitude, count, damage;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (life::Cycle c : life::rainflow(history.col(static_cast<Eigen::Index>(b)), life::Ends::repeated)) {
      c.count *= passes * blocks[b].revolutions;
      table.block.push_back(static_cast<int>(b));
      range.push_back(c.range);
      mean.push_back(c.mean);
      amplitude.push_back(life::equivalent_amplitude(strength.mean_stress, c.range / 2, c.mean));
      count.push_back(c.count);
      damage.push_back(life::damage({c}, curve, strength.mean_stress));
    }
  table.range = vector_of(range);
  table.mean = vector_of(mean);
  table.amplitude = vector_of(amplitude);
  table.count = vector_of(count);
  table.damage = vector_of(damage);
  return table;
}

// Spreads what was computed for one node of each kind to all nodes for which it stands.
void spread(const life::Damage& damage, const life::Revolutions& r, io::LifeSet& set) {
  const auto n = static_cast<Eigen::Index>(set.node.size());
  set.damage.resize(n);
  set.amplitude.resize(n);
  set.block_damage.resize(n, damage.of_block.cols());
  for (std::size_t i = 0; i < r.of.size(); ++i)
    for (int node : r.of[i]) {
      const auto at = static_cast<Eigen::Index>(i);
      set.damage[node] = damage.total[at];
      set.amplitude[node] = damage.amplitude[at];
      set.block_damage.row(node) = damage.of_block.row(at);
    }
}

// The most damaged of the computed nodes; where none is damaged, that of the largest amplitude.
Eigen::Index worst(const life::Damage& damage) {
  Eigen::Index at = 0;
  (damage.total.maxCoeff(&at) > 0 ? damage.total : damage.amplitude).maxCoeff(&at);
  return at;
}

// Damage of each node of a set by stress histories that are enlarged by their estimated error; empty where
// that is not known.
Eigen::VectorXd damage_with_error(const SetHistory& history, const Strength& strength,
                                  const std::vector<double>& torques, const std::vector<life::Block>& blocks,
                                  bool proportional) {
  if (history.with_error.size() != history.at.size()) return {};
  const life::Damage damage =
      life::duty_cycle_damage(history.with_error, torques, blocks, std::abs(history.member->ratio),
                              strength.curve, strength.mean_stress, proportional);
  io::LifeSet set;
  set.node = history.place.node;
  spread(damage, history.with_error.front(), set);
  return set.damage;
}

void require_static_strength(const life::Damage& damage, const life::Revolutions& r,
                             const SetHistory& history) {
  for (Eigen::Index i = 0; i < damage.total.size(); ++i)
    require(std::isfinite(damage.total[i]), history.member->name, " ", history.place.set,
            ": the mean stress of node ",
            history.place.node[static_cast<std::size_t>(r.node[static_cast<std::size_t>(i)])],
            " reaches the tensile strength: it breaks in the first cycles, and a life has no meaning; lower "
            "the torque, or check tensile_strength");
}

}  // namespace

LifeOfSet life_of_set(const SetHistory& history, const Strength& strength, const std::vector<double>& torques,
                      const std::vector<life::Block>& blocks, bool proportional) {
  const life::Revolutions& r = history.at.front();
  LifeOfSet one;
  one.ratio = std::abs(history.member->ratio);
  one.laid = r.laid;
  one.pitches = history.sweep.pitches;
  one.body_file = history.body_file;
  for (const life::Revolutions& each : history.at) one.difference = std::max(one.difference, each.difference);
  const life::Damage damage = life::duty_cycle_damage(history.at, torques, blocks, one.ratio, strength.curve,
                                                      strength.mean_stress, proportional);
  require_static_strength(damage, r, history);
  io::LifeSet& set = one.set;
  set.body = history.place.body;
  set.set = history.place.set;
  set.node = history.place.node;
  set.X = history.place.X;
  for (const auto& x : set.X.colwise()) set.tooth.push_back(nearest_tooth(history.member->toothing, x));
  spread(damage, r, set);
  set.damage_with_error = damage_with_error(history, strength, torques, blocks, proportional);
  const Eigen::Index critical = worst(damage), n_t = r.stress.rows();
  set.critical = r.node[static_cast<std::size_t>(critical)];
  set.roll = Eigen::VectorXd::LinSpaced(n_t, 0, static_cast<double>(n_t - 1)) / history.sweep.per_pitch;
  set.history.resize(n_t, static_cast<Eigen::Index>(blocks.size()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const life::Between at = life::between(torques, blocks[b].torque, proportional);
    set.history.col(static_cast<Eigen::Index>(b)) = life::history_at(history.at, at, critical);
  }
  set.cycles = cycle_table(set.history, blocks, strength, one.ratio / r.count);
  one.largest = set.history.cwiseAbs().maxCoeff();
  return one;
}

}  // namespace elastogear::app
