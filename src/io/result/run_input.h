#pragma once
// Group /provenance/run of result and stress files: model::RunInput.

#include <optional>

#include "elastogear/model/run_input.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

/// Beside the provenance, which must be there. Nothing is written where nothing is known.
void write_run_input(const h5::File& file, const std::optional<model::RunInput>& input);
/// Nothing where the file does not say it. Error for what no run can be asked.
std::optional<model::RunInput> read_run_input(const h5::File& file);

}  // namespace elastogear::io
