#pragma once
// What a file holds, for people.

#include <string>

namespace elastogear::io {

/// Readable summary of a mesh (.msh, .inp), a body, result or stress file, or the name of a field file (.vtu,
/// .pvd). Error for files that are none of these.
std::string describe(const std::string& path);

}  // namespace elastogear::io
