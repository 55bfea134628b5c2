#pragma once
// Options of worm drives, "drive: worm".

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

OptionTable worm_table();
Drive worm_drive(const Options& options);

}  // namespace elastogear::app
