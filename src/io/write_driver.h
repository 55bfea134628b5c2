#pragma once
// HDF5's access to files that are written. A write that fails (a full disk) would leave the library with
// objects that it can neither write nor close, and a crash when the program ends. This driver remembers the
// failure, keeps what could not be written in memory and lets the library go on; whoever writes asks for the
// failure.

#include <hdf5.h>

#include <string>

namespace elastogear::io::h5 {

/// Makes the driver that of a file access property list.
void use_write_driver(hid_t access_properties);

/// What stopped the first write to an open file that failed: "no space left on the device"; empty: nothing
/// did.
std::string write_failure(hid_t file);

/// The same of files that were closed since the last call: the last writes and the closing itself.
std::string take_close_failure();

}  // namespace elastogear::io::h5
