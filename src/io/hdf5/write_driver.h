#pragma once
// HDF5's access to files that are written. A write that fails (a full disk) would leave the library with
// objects that it can neither write nor close, and a crash when the program ends. This driver remembers the
// failure, keeps what could not be written in memory and lets the library go on; whoever writes asks for the
// failure.

#include <string>

#include "io/hdf5/hdf5_api.h"

namespace elastogear::io::h5 {

/// Makes the driver that of a file access property list.
void use_write_driver(hid_t access_properties);

/// Reason why the first write to an open file failed, such as "no space left on the device"; empty when none
/// failed.
std::string write_failure(hid_t file);

/// Reason why the last writes to files that were closed since the last call, or the closing itself, failed;
/// empty when none failed.
std::string take_close_failure();

}  // namespace elastogear::io::h5
