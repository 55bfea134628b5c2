#pragma once
// Records that a long run keeps for itself: texts and numbers, such as snapshots of a piece of a result.

#include <map>
#include <string>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/model/result.h"

namespace elastogear::io {

struct StoredRecord {
  std::map<std::string, std::string> text = {};
  std::vector<double> numbers = {};
};

/// Writes a file (HDF5, with checksums) that appears under its name only when whole. WriteFailure when it
/// cannot.
void write_record(const std::string& path, const StoredRecord& record);
/// Error when the file is missing, damaged or something else.
StoredRecord read_record(const std::string& path);

/// Records a snapshot or takes it from the archive, to the bit.
void serialize(model::Snapshot& snapshot, Archive& archive);

}  // namespace elastogear::io
