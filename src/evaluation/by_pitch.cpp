#include "evaluation/by_pitch.h"

#include <cmath>
#include <numbers>

#include "evaluation/sections.h"
#include "evaluation/signal.h"

namespace elastogear::evaluation {

std::vector<PitchOfRun> whole_pitches(const Eigen::VectorXd& roll) {
  constexpr Eigen::Index kLeast = 4;
  std::vector<PitchOfRun> pitches;
  Eigen::Index begin = -1;  // first time of the pitch, none before one begins
  for (Eigen::Index i = 1; i < roll.size(); ++i) {
    if (std::floor(roll[i]) == std::floor(roll[i - 1])) continue;
    if (begin >= 0 && i - begin >= kLeast) pitches.push_back({begin, i});
    begin = i;
  }
  return pitches;
}

void add_pitches(const PairOfRun& pair, const Eigen::VectorXd& error, Items& items) {
  const std::vector<PitchOfRun> pitches = whole_pitches(pair.roll);
  const auto n = static_cast<Eigen::Index>(pitches.size());
  const Eigen::VectorXd force = pair.force.colwise().norm().transpose();
  Eigen::VectorXd roll(n), speed(n), mean(n), range(n), largest(n), load(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [begin, end] = pitches[static_cast<std::size_t>(k)];
    const Eigen::VectorXd e = error.segment(begin, end - begin + 1),
                          f = force.segment(begin, end - begin + 1);
    roll[k] = (pair.roll[begin] + pair.roll[end]) / 2;
    speed[k] = 2 * std::numbers::pi / pair.first_teeth * (pair.roll[end] - pair.roll[begin]) /
               (pair.time[end] - pair.time[begin]);
    mean[k] = e.mean(), range[k] = peak_to_peak(e), largest[k] = f.maxCoeff(), load[k] = f.mean();
  }
  const std::string path = "by_pitch";
  items.curve(path + "/roll", "1", "middle of each whole pitch, pitches", roll);
  items.curve(path + "/speed", "rad/s", "mean speed of the drive's first gear over each pitch", speed);
  items.curve(path + "/error_mean", "m", "mean transmission error over each pitch", mean);
  items.curve(path + "/error_peak_to_peak", "m", "largest less smallest transmission error of each pitch",
              range);
  items.curve(path + "/force_mean", "N", "mean contact force over each pitch", load);
  items.curve(path + "/force_largest", "N", "largest contact force of each pitch", largest);
  if (n == 0) return;
  Eigen::Index peak = 0;
  items.number(path + "/largest_peak_to_peak", "m", "largest of error_peak_to_peak", range.maxCoeff(&peak));
  items.number(path + "/largest_at_speed", "rad/s", "speed at that pitch", speed[peak]);
}

}  // namespace elastogear::evaluation
