#pragma once
// Group /checks of a body file.

#include <vector>

#include "elastogear/model/check.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

void write_checks(const h5::File& file, const std::vector<model::Check>& checks);
/// Tables of the group /checks (numbers and rows of numbers beside them are io::ModeChecks); none when there
/// is no such group.
std::vector<model::Check> read_checks(const h5::File& file);

}  // namespace elastogear::io
