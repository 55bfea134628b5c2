#pragma once
// One piece of work of the library inside a Python interpreter: PETSc is started at the first one and ended
// with the interpreter, one is done at a time, options hold for one alone, and interrupts end it.

#include <petscsys.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "elastogear/base/petsc.h"

namespace elastogear::python {

namespace py = pybind11;

/// A database of PETSc's options of its own, beside that of other users of PETSc in the process.
class OptionDatabase {
 public:
  OptionDatabase();
  ~OptionDatabase();
  OptionDatabase(const OptionDatabase&) = delete;
  OptionDatabase& operator=(const OptionDatabase&) = delete;
  PetscOptions get() const { return options_; }

 private:
  PetscOptions options_ = nullptr;
};

/// Ranks that take part in a piece of work.
enum class Ranks { this_one, all };

/// Looks for signals, at most every 20 ms, may be called without the GIL. What a handler of Python raises is
/// kept for Work::raise_kept.
class Interrupts {
 public:
  /// True from the first exception on.
  bool pending();
  /// Throws that exception when there is one.
  void raise();
  /// Keeps what a function of the user raised, as if a signal had; with the GIL.
  void keep(const py::error_already_set& error);

 private:
  friend class Work;
  std::optional<py::error_already_set> kept_;
  double looked_ = 0;  // s, when last
};

/// While it lives no other work begins: Error when one is under way, in a forked child and after the end.
/// Made and destroyed with the GIL.
class Work {
 public:
  explicit Work(Ranks ranks = Ranks::this_one, const OptionDatabase* options = nullptr);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  Interrupts& interrupts() { return interrupts_; }
  /// Runs `f` without the GIL. What a signal or a function of the user raised goes before exceptions of `f`.
  template <class F>
  auto without_gil(F&& f) {
    try {
      const py::gil_scoped_release released;
      return f();
    } catch (...) {
      raise_kept();
      throw;
    }
  }
  /// Throws what was kept, if anything.
  void raise_kept();

 private:
  Interrupts interrupts_;
  const OptionDatabase* options_;
  MPI_Comm world_;
  std::optional<SilentErrors> silent_;
};

/// Something that holds objects of PETSc: they must go before PETSc does, and in the thread at work.
class Resource {
 public:
  Resource();
  virtual ~Resource();
  Resource(const Resource&) = delete;
  Resource& operator=(const Resource&) = delete;
  /// Frees the objects; called once PETSc ends.
  virtual void close() = 0;
};

/// Destroys `object` now, or when the present work has ended; leaves it alone in a forked child.
void destroy_safely(std::shared_ptr<void> object);

void bind_runtime(py::module_& module);

}  // namespace elastogear::python
