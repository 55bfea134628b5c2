// The .inp reader on any bytes. What stands behind the first zero byte is the file part.inp. Each text is
// read as a deck of one body, and as one whose instance A is chosen.
#include "mesh/inp/lines/inp.h"
#include <algorithm>

#include "elastogear/base/error.h"
#include "target.h"

using namespace elastogear;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\0'), size);
  const auto open = [&](const std::string& path) {
    require(path == "part.inp" && end < size, path, ": there is no such file");
    return text.substr(end + 1);
  };
  constexpr std::int64_t kMostGenerated = 10'000;  // so that a few bytes take no gigabytes
  for (const char* instance : {"", "A"}) {
    try {
      mesh::ReadReport report;
      mesh::parse_inp({"fuzz.inp", text.substr(0, end), open, instance, kMostGenerated}, 1e-3, &report);
    } catch (const Error&) {  // the only exception that bad input may cause
    }
  }
  return 0;
}
