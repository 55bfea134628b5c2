#pragma once
// What our own .inp files begin and end with.

#include <string_view>

namespace elastogear::mesh::inp_format {

constexpr std::string_view kFirstLine =
    "** elastogear mesh, in m; complete with the last line '** end of mesh'\n";
constexpr std::string_view kLastLine = "** end of mesh\n";

}  // namespace elastogear::mesh::inp_format
