// The .msh reader on any bytes, ASCII and binary.
#include "mesh/msh/msh.h"
#include "elastogear/base/error.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    elastogear::mesh::ReadReport report;
    elastogear::mesh::parse_msh("fuzz.msh", std::string(reinterpret_cast<const char*>(data), size), 1e-3,
                                &report);
  } catch (const elastogear::Error&) {  // the only exception that bad input may cause
  }
  return 0;
}
