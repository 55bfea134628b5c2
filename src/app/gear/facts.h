#pragma once
// The table of a drive's numbers, printed and drawn.

#include <string>

#include "elastogear/drive/facts.h"

namespace elastogear::app {

/// The figures of a fact in mm and degrees: "51 mm / 57 mm".
std::string text(const drive::Fact& fact);

}  // namespace elastogear::app
