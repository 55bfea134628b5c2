// The line by which tests and studies state a figure; scripts/figures.py reads it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace elastogear::test {

// bound: "< 0.01" and its like, or empty.
inline void state_figure(const std::string& of, const std::string& quantity, const std::string& unit,
                         double value, const std::string& bound) {
  static bool is_first = true;
  std::ostringstream line;
  line.precision(9);
  line << "FIGURE " << of << " | " << quantity << " | " << value << " | " << bound << " | " << unit << "\n";
  std::cout << line.str() << std::flush;
  if (const char* path = std::getenv("ELASTOGEAR_FIGURES"))
    std::ofstream(path, is_first ? std::ios::trunc : std::ios::app) << line.str();
  is_first = false;
}

}  // namespace elastogear::test
