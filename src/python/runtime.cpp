#include "python/runtime.h"

#include <slepcsys.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/base/version.h"

namespace elastogear::python {
namespace {

constexpr double kLookEvery = 0.02;  // s
constexpr std::chrono::milliseconds kAwaitEvery{5};

/// The state of the library in this process. It is never destroyed.
struct Process {
  pid_t owner = getpid();  // of what the module was imported in, later of what started PETSc
  bool started = false;
  std::atomic<bool> ended = false, busy = false;
  std::set<Resource*> resources;
  std::vector<std::shared_ptr<void>> waiting;  // to be destroyed
};

Process& process() {
  static auto* const state = new Process;
  return *state;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Where MPI runs it is that of the process that the module was imported in.
bool is_forked() {
  int runs = 0;
  if (getpid() == process().owner) return false;
  MPI_Initialized(&runs);
  return process().started || runs;
}

// Signals are Python's, PETSc gets none.
void start() {
  Process& state = process();
  if (state.started) return;
  static std::string words[] = {"elastogear", "-no_signal_handler"};
  static char* argv[] = {words[0].data(), words[1].data(), nullptr};
  int argc = 2;
  char** arguments = argv;
  start_solvers(argc, arguments);
  state.owner = getpid();
  state.started = true;
}

// Threads that the interpreter does not wait for may be at work. What they do stops as by an interrupt.
void await_work(const Process& state) {
  while (state.busy) {
    const py::gil_scoped_release released;
    std::this_thread::sleep_for(kAwaitEvery);
  }
}

// Called by atexit, before the interpreter and mpi4py end.
void end() {
  Process& state = process();
  if (!state.started || state.ended || is_forked()) return;
  state.ended = true;
  await_work(state);
  for (Resource* resource : std::set<Resource*>(state.resources)) resource->close();
  state.waiting.clear();
  PetscBool finalized = PETSC_FALSE;
  int mpi_finalized = 0;
  PetscFinalized(&finalized);
  MPI_Finalized(&mpi_finalized);
  if (!finalized && !mpi_finalized) SlepcFinalize();
}

void begin_work() {
  Process& state = process();
  require(!is_forked(),
          "this process was forked from one that had started MPI, which it cannot share: start processes by "
          "multiprocessing's 'spawn', or by subprocess, or fork before the first use of elastogear");
  require(!state.ended, "the interpreter is ending, and PETSc has ended");
  require(!state.busy.exchange(true),
          "elastogear is at work: it was called from a callback, or from another thread, of a run that goes "
          "on. It does one thing at a time");
}

}  // namespace

OptionDatabase::OptionDatabase() { check(PetscOptionsCreate(&options_)); }
OptionDatabase::~OptionDatabase() { PetscOptionsDestroy(&options_); }

bool Interrupts::pending() {
  if (kept_) return true;
  const double time = now();
  if (time - looked_ < kLookEvery) return false;
  looked_ = time;
  const py::gil_scoped_acquire gil;
  if (process().ended)
    PyErr_SetString(PyExc_SystemExit, "the interpreter is ending");  // ends a thread silently
  if (process().ended || PyErr_CheckSignals() != 0) kept_.emplace();
  return kept_.has_value();
}

void Interrupts::keep(const py::error_already_set& error) {
  if (!kept_) kept_.emplace(error);
}

void Interrupts::raise() {
  if (pending()) throw *kept_;
}

Work::Work(Ranks ranks, const OptionDatabase* options) : options_(options), world_(MPI_COMM_NULL) {
  begin_work();
  try {
    start();
    silent_.emplace();
    if (options_) check(PetscOptionsPush(options_->get()));
  } catch (...) {
    process().busy = false;
    throw;
  }
  world_ = PETSC_COMM_WORLD;
  if (ranks == Ranks::this_one) PETSC_COMM_WORLD = PETSC_COMM_SELF;
}

Work::~Work() {
  PETSC_COMM_WORLD = world_;
  if (options_) PetscOptionsPop();
  std::exchange(process().waiting, {}).clear();
  silent_.reset();
  process().busy = false;
}

void Work::raise_kept() {
  if (interrupts_.kept_) throw *std::exchange(interrupts_.kept_, std::nullopt);
}

Resource::Resource() { process().resources.insert(this); }
Resource::~Resource() { process().resources.erase(this); }

void destroy_safely(std::shared_ptr<void> object) {
  Process& state = process();
  if (is_forked())
    new std::shared_ptr<void>(std::move(object));  // MPI is not there to free its parts
  else if (state.busy)
    state.waiting.push_back(std::move(object));
}

void bind_runtime(py::module_& module) {
  module.attr("__version__") = version();
  module.attr("git_hash") = git_hash();
  module.def(
      "is_started", [] { return process().started && !process().ended; },
      "Have MPI and PETSc been started by elastogear, and not ended yet?");
  py::module_::import("atexit").attr("register")(py::cpp_function(end));
}

}  // namespace elastogear::python
