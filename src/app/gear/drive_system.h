#pragma once
// The system that a drive's options make of it. What options say of single bodies, pairs, loads and bushings
// departs from that.

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "elastogear/drive/drive_system.h"

namespace elastogear::app {

/// How the options run a drive. Throws Error where nothing loads gears at rest.
drive::Operation operation(const Options& options, const Drive& drive);

/// The system of the drive, run so. A gear whose motion is prescribed takes no load and begins with its own
/// speed.
drive::DriveSystem drive_system(const Options& options, const Drive& drive);

/// Options with the names of the drive's bodies, pairs, bearings and loads, its contact and its files where
/// nothing is given.
Options with_system(Options options, const Drive& drive);

}  // namespace elastogear::app
