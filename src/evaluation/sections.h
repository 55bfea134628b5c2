#pragma once
// Sections of an evaluation: each adds its items.

#include "elastogear/evaluation/evaluate.h"
#include "evaluation/items.h"

namespace elastogear::evaluation {

/// Both gears of a pair.
inline std::array<const Gear*, 2> both(const PairOfRun& pair) { return {&pair.gear[0], &pair.gear[1]}; }

void add_teeth(const PairOfRun& pair, Items& items);
void add_line_load(const PairOfRun& pair, Items& items);
/// Pressures by Hertz, where they can be told.
void add_hertz(const PairOfRun& pair, Items& items);
void add_pressure(const PairOfRun& pair, Items& items);
void add_roots(const PairOfRun& pair, Items& items);
/// Of a run in time; error: m, transmission error at all times.
void add_pitches(const PairOfRun& pair, const Eigen::VectorXd& error, Items& items);

}  // namespace elastogear::evaluation
