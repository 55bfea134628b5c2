#pragma once
// Options of spur and helical gears, "drive: cylindrical".

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

OptionTable cylindrical_table();
Drive cylindrical_drive(const Options& options, const drive::Start& start);

}  // namespace elastogear::app
