#pragma once
// The program's verbs: each a table of options and a plain function over the library.

#include <string>
#include <vector>

#include "app/options/options.h"

namespace elastogear::app {

struct Verb {
  std::string name;
  std::string usage;    ///< "simulate impact.yaml [-option value ...]"
  std::string summary;  ///< one line
  OptionTable table;
  void (*run)(const Options& options, const std::vector<std::string>& arguments);
  const char* solvers = "";  ///< options of PETSc and SLEPc that it asks for: "-eps_*, -st_*, "
  bool parallel = false;     ///< may run on more than one rank
  bool configured = true;    ///< the arguments are YAML files, not data
};

Verb run_verb();
Verb mesh_verb();
Verb reduce_verb();
Verb simulate_verb();
Verb recover_verb();
Verb evaluate_verb();
Verb compare_verb();
Verb info_verb();
Verb life_verb();
Verb wear_verb();

}  // namespace elastogear::app
