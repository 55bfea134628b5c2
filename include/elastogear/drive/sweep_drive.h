#pragma once
// A drive over its roll angles, from body files to what evaluation takes.

#include <string>
#include <vector>

#include "elastogear/drive/drive_system.h"
#include "elastogear/evaluation/evaluate.h"

namespace elastogear::drive {

/// Sweeps a drive at roll 0 over roll angles (pitches, ascending), whose members have these body files with
/// stress nodes `root`. Writes a result file, and returns the drive's pairs with the stresses at their roots.
/// Throws Error naming the first position without an equilibrium.
std::vector<evaluation::PairOfRun> sweep_drive(const Drive& drive, const Operation& operation,
                                               const std::vector<std::string>& body_files,
                                               const std::vector<double>& positions,
                                               const std::string& result);

}  // namespace elastogear::drive
