#pragma once
// Figures of a run in time pitch by pitch, as over the speed of a run-up (docs/theory.md, section 10.5).

#include <vector>

#include "elastogear/evaluation/evaluate.h"
#include "evaluation/items.h"

namespace elastogear::evaluation {

/// Times i of one whole pitch: begin <= i <= end, the end of a pitch is the begin of the next.
struct PitchOfRun {
  Eigen::Index begin = 0, end = 0;
};
/// The whole pitches of a run in which the drive's first gear turns on in one sense, each with at least four
/// times; roll: pitches.
std::vector<PitchOfRun> whole_pitches(const Eigen::VectorXd& roll);

/// error: m, transmission error at all times.
void add_pitches(const PairOfRun& pair, const Eigen::VectorXd& error, Items& items);

}  // namespace elastogear::evaluation
