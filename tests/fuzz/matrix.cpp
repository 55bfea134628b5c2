// The readers of other programs' matrices, node tables and tables of displacements on any bytes; the first
// byte chooses.
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/io/matrix_text.h"
#include "target.h"

using namespace elastogear;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::istringstream in(std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  const std::string source = "fuzz";
  try {
    if (data[0] == 'n') {
      io::read_node_table(in, source);
    } else if (data[0] == 'd') {
      io::read_dof_table(in, source);
    } else {
      constexpr int kFormats = 4;
      io::MatrixReader reader(in, source, static_cast<io::MatrixFormat>(data[0] % kFormats));
      constexpr std::size_t kPiece = 10;
      while (!reader.read(kPiece).empty()) continue;
    }
  } catch (const Error&) {  // the only exception that bad input may cause
  }
  return 0;
}
