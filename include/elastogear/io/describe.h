#pragma once
// Description of the contents of a file, for users.

#include <string>

namespace elastogear::io {

/// Readable summary of a mesh (.msh, .inp), a body, result or stress file, a field file (.vtu, .vtp, .pvd) or
/// a table (.csv), with the arrays that it holds. Error for files that are none of these.
std::string describe(const std::string& path);

/// Root attribute `format` of an HDF5 file of the program, "elastogear result"; Error for other files.
std::string file_format(const std::string& path);

}  // namespace elastogear::io
