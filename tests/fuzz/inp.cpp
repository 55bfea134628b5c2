// The .inp reader on any bytes. What stands behind the first zero byte is the content of every other file.
#include "elastogear/mesh/inp.h"
#include "elastogear/base/error.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    elastogear::mesh::ReadReport report;
    elastogear::mesh::parse_inp("fuzz.inp", text, 1e-3, &report);
  } catch (const elastogear::Error&) {  // the only exception that bad input may cause
  }
  return 0;
}
