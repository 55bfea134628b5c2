#pragma once
// Options of worm drives, "drive: worm".

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

OptionTable worm_table();
Drive worm_drive(const Options& options, const drive::Start& start);

/// Throws Error where the wheel of a worm drive is to drive a worm that friction locks.
void refuse_locked(const Options& options, const Drive& drive);

}  // namespace elastogear::app
