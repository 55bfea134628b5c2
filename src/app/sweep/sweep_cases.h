#pragma once
// The cases of a sweep: torques times variants.

#include <string>
#include <vector>

#include "app/options/options.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable case_table();

/// A drive with other values of some keys, in the units of its options.
struct Variant {
  std::string name = {};  ///< empty: the drive as it is
  struct Key {
    std::string name, value, unit;
  };
  std::vector<Key> keys = {};
};

struct SweepCase {
  double torque = 0;  ///< N m
  int variant = 0;    ///< position in the list
};

struct SweepCases {
  std::vector<Variant> variants;
  std::vector<SweepCase> cases;  ///< variant by variant
  bool several = false;          ///< are there torques or variants? The results go to a folder then
};

/// Is there a case for each of torques? A torque of the command line goes before torques of a file. Throws
/// Error where both are given there.
bool sweeps_torques(const Options& options);

/// options: of a drive, with the names of its gears. Throws Error, naming value and remedy, for keys that
/// would change mesh or bodies, and tables that cannot be read.
SweepCases sweep_cases(const Options& options);

/// The options of one case.
Options of_case(const Options& options, const SweepCases& all, const SweepCase& one);

/// Writes the table of all cases: number, file, torque, variant and its keys, and the positions found.
void write_case_table(const std::string& path, const SweepCases& all, const std::vector<std::string>& files,
                      const std::vector<int>& found);

}  // namespace elastogear::app
