#pragma once
// A simulation that a program in Python advances step by step.

#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <string>

#include "elastogear/dynamics/simulate.h"
#include "python/runtime.h"
#include "python/state.h"
#include "python/verbs.h"

namespace elastogear::python {

class SteppedRun : public Resource {
 public:
  struct Parts;

  /// forces: functions by the axis ("worm", "worm.rotation") or load that they act on. output: result file,
  /// or empty.
  SteppedRun(const Given& given, const std::map<std::string, py::object>& forces, const std::string& output);
  ~SteppedRun() override;

  bool step();
  void run();
  bool ended();
  StateView state();
  Items take_items();
  const dynamics::RunSummary& finish();
  bool is_open() const { return parts_ != nullptr; }
  void close() override;

 private:
  Parts& parts();
  Parts& unfailed_parts();
  static void begin(Parts& parts);

  std::shared_ptr<Parts> parts_;
};

void bind_simulation(py::module_& module);

}  // namespace elastogear::python
