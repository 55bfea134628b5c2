#pragma once
// The unit of length of a file that has none of its own.

#include <string>

#include "app/options/options.h"

namespace elastogear::app {

/// The unit of length of the mesh file or node table in m.
double unit_in_m(const Options& options);
/// The same of a gear of a drive whose mesh is its user's.
double unit_in_m(const Options& options, const std::string& gear);

/// Throws Error unless numbers of the mesh file, such as its materials, have a unit that follows from that of
/// its lengths. what: their name in the message.
void require_consistent_unit(const Options& options, const std::string& what);

}  // namespace elastogear::app
