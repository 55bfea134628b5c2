#pragma once
// A measured master curve from a table of comma-separated values.

#include <string>

#include "elastogear/model/master_curve.h"

namespace elastogear::app {

/// Columns "time [s],modulus [Pa]" or "frequency [Hz],storage [Pa],loss [Pa]" in any order, moduli in any
/// unit of pressure, times of time; others are left out. Throws Error that names the file, and the line.
model::MasterCurve read_master_curve(const std::string& path);

}  // namespace elastogear::app
