#pragma once
// The verbs of the program as functions of Python.

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "app/console/embedding.h"
#include "app/options/options.h"
#include "python/runtime.h"

namespace elastogear::python {

/// Names and texts that a verb has said, in order.
using Items = std::vector<std::pair<std::string, std::string>>;

/// Where options come from, as Python gives them: a file or a text of YAML, and chosen ones as YAML.
struct Given {
  std::vector<std::string> files;
  std::string text, name;  ///< of the text; both may be empty
  std::string chosen;
};

app::OptionSources sources(const Given& given);

/// Receives what verbs report. told: called with stage and fraction, or none.
class Listener {
 public:
  Listener(Work& work, py::object told, bool progress_ends);
  app::Embedding embedding();
  Items items;

 private:
  Work& work_;
  py::object told_;
  bool progress_ends_;  // an interrupt ends the work where it reports
};

void bind_verbs(py::module_& module);

}  // namespace elastogear::python
