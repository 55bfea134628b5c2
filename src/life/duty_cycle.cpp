#include "elastogear/life/duty_cycle.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/base/text.h"

namespace elastogear::life {
namespace {

constexpr double kSameTorque = 1e-9;  // relative

double largest_amplitude(const std::vector<Cycle>& cycles, const MeanStress& mean_stress) {
  double largest = 0;
  for (const Cycle& c : cycles)
    largest = std::max(largest, equivalent_amplitude(mean_stress, c.range / 2, c.mean));
  return largest;
}

[[noreturn]] void refuse_torque(const std::vector<double>& known, double torque) {
  fail("duty cycle: the torque ", torque, " N m lies outside those whose stresses are known, ",
       join(known, ", ",
            [](double t) {
              std::string text;
              print(text, t);
              return text;
            }),
       " N m: add it to the torques of the sweep, or scale stresses in proportion by life_proportional");
}

}  // namespace

Between between(const std::vector<double>& known, double torque, bool proportional) {
  int below = -1, above = -1;  // nearest of the same sense, by size
  const double size = std::abs(torque), slack = kSameTorque * size;
  for (int i = 0; i < static_cast<int>(known.size()); ++i) {
    if (known[i] * torque <= 0) continue;
    const double t = std::abs(known[i]);
    if (t <= size + slack && (below < 0 || t > std::abs(known[below]))) below = i;
    if (t >= size - slack && (above < 0 || t < std::abs(known[above]))) above = i;
  }
  if (below >= 0 && above >= 0) {
    const double from = std::abs(known[below]), to = std::abs(known[above]);
    if (to - from <= slack) return {below, below, 0, 1};
    return {below, above, (size - from) / (to - from), 1};
  }
  const int nearest = std::max(below, above);
  if (nearest < 0 || !proportional) refuse_torque(known, torque);
  return {nearest, nearest, 0, torque / known[nearest]};
}

Eigen::VectorXd history_at(const std::vector<Revolutions>& histories, const Between& at, Eigen::Index node) {
  return at.factor * ((1 - at.share) * histories[at.below].stress.col(node) +
                      at.share * histories[at.above].stress.col(node));
}

Damage duty_cycle_damage(const std::vector<Revolutions>& histories, const std::vector<double>& known,
                         const std::vector<Block>& blocks, double ratio, const SnCurve& curve,
                         const MeanStress& mean_stress, bool proportional) {
  require(!histories.empty() && histories.size() == known.size() && !blocks.empty(),
          "duty cycle: needs stresses at one torque at least, and one block");
  const SnCurve reversed = fully_reversed(curve, mean_stress);
  const Eigen::Index m = histories[0].stress.cols();
  Damage damage;
  damage.of_block.resize(m, static_cast<Eigen::Index>(blocks.size()));
  damage.amplitude.setZero(m);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Between at = between(known, blocks[b].torque, proportional);
    const double passes = blocks[b].revolutions * ratio / histories[at.below].count;
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto cycles = rainflow(history_at(histories, at, i), Ends::repeated);
      damage.of_block(i, static_cast<Eigen::Index>(b)) = passes * life::damage(cycles, reversed, mean_stress);
      damage.amplitude[i] = std::max(damage.amplitude[i], largest_amplitude(cycles, mean_stress));
    }
  }
  damage.total = damage.of_block.rowwise().sum();
  return damage;
}

}  // namespace elastogear::life
