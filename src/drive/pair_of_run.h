#pragma once
// Runs of a drive as evaluation takes them.

#include <array>

#include "elastogear/drive/drive_system.h"
#include "elastogear/evaluation/evaluate.h"

namespace elastogear::drive {

/// A gear that stands nowhere yet.
evaluation::Gear gear_of(const Member& member);

/// Where both gears of a pair are at one time, and what bears between them.
struct PairAtTime {
  std::array<Eigen::Vector3d, 2> r_WB;  ///< m, of the body frames in the world
  std::array<Eigen::Matrix3d, 2> R_WB;  ///< body to world
  Eigen::Vector3d force, torque;        ///< N, N m about the world origin, on the second gear, world
  std::vector<model::ContactRecord> contacts;
};

/// Sizes the arrays of a pair for n_t times.
void make_room(std::size_t n_t, evaluation::PairOfRun& pair);
/// Enters the next time of a pair with room for it, whose gears have these flanks.
void add_time(const PairAtTime& now, const std::array<evaluation::Flanks, 2>& flanks,
              evaluation::PairOfRun& pair);

/// A pair of the drive at the positions of a sweep of this system, run so. Throws Error where there are no
/// positions.
evaluation::PairOfRun pair_of_sweep(const Drive& drive, std::size_t pair, const Operation& operation,
                                    const dynamics::SystemModel& model,
                                    const std::vector<model::Snapshot>& positions);

}  // namespace elastogear::drive
