#pragma once
// Arrays that a file holds, a line each: name, shape, unit. Private to module io.

#include "io/describe/describe_text.h"

namespace elastogear::io {

/// Datasets of an HDF5 file of this program.
void describe_datasets(Out& out, const std::string& path);
/// Extension ".vtu" or ".vtp": points, cells and data arrays. ".pvd": times, bodies and files.
void describe_vtk(Out& out, const std::string& path, const std::string& extension);
/// Columns and the number of rows of a CSV table.
void describe_table(Out& out, const std::string& path);

}  // namespace elastogear::io
