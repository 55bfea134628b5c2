// Runs a fuzz target once on each file given: the corpus and every input that once broke a reader.
#include <cstdio>
#include <string>

#include "elastogear/base/file.h"
#include "target.h"

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string bytes = elastogear::read_file(argv[i]);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::printf("%d files\n", argc - 1);
  return argc > 1 ? 0 : 1;
}
