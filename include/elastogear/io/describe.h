#pragma once
// Description of the contents of a file, for users.

#include <map>
#include <string>

namespace elastogear::io {

/// Readable summary of a mesh (.msh, .inp), a body, result or stress file, a field file (.vtu, .vtp, .pvd) or
/// a table (.csv), with the arrays that it holds. Error for files that are none of these.
std::string describe(const std::string& path);

/// Root attribute `format` of an HDF5 file of the program, "elastogear result"; Error for other files.
std::string file_format(const std::string& path);

/// What a body, a result or what was made of one comes from: options, versions of the program.
std::map<std::string, std::string> read_provenance(const std::string& path);

}  // namespace elastogear::io
