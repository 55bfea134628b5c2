#pragma once
// Description of result and stress files. Private to module io.

#include <string>

#include "io/describe/describe_text.h"

namespace elastogear::io {

void describe_result(Out& out, const std::string& path);
void describe_evaluation(Out& out, const std::string& path);
void describe_stress(Out& out, const std::string& path);
void describe_life(Out& out, const std::string& path);
void describe_wear(Out& out, const std::string& path);

}  // namespace elastogear::io
