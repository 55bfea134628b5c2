#pragma once
// Groups /relaxed_state and /relaxed_start of a result file (docs/file_format.md): what the viscoelastic
// bodies remember of their loads in its last state, and in the first.

#include <map>
#include <string>

#include "elastogear/model/relaxed_state.h"

namespace elastogear::io {

inline constexpr const char *kRelaxedEnd = "/relaxed_state", *kRelaxedStart = "/relaxed_start";

/// Adds the states of these bodies to a finished result file.
void add_relaxed_states(const std::string& path, const std::map<std::string, model::RelaxedState>& states,
                        const std::string& group = kRelaxedEnd);

/// That of a body; empty where the file has none.
model::RelaxedState read_relaxed_state(const std::string& path, const std::string& body,
                                       const std::string& group = kRelaxedEnd);

}  // namespace elastogear::io
