#include "elastogear/base/petsc.h"

#include <slepcsys.h>

#include <cstdarg>
#include <cstdio>
#include <new>
#include <string_view>

#include "elastogear/base/error.h"

namespace elastogear {
namespace {

thread_local std::string last_message;
constexpr std::string_view kAllocation = "PetscMalloc";  // begins the names of its functions
std::string start_text;  // what PETSc says while it starts, before our handler is there

PetscErrorCode keep_text(const char format[], ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  start_text += text;
  return 0;
}

// Keeps PETSc's innermost message for check() instead of printing a traceback.
PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL)
    last_message = std::string(function ? function : "PETSc") + ": " + (message ? message : "");
  return code;
}

// The message of PETSc's traceback, which stands between its heading and its advice.
std::string message_in(const std::string& text) {
  const auto begin = text.find('\n') + 1, end = text.find("\nSee http", begin);
  return text.substr(begin, end == text.npos ? text.npos : end - begin);
}

}  // namespace

void check(PetscErrorCode code, const char* file, int line) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  const std::string detail = std::exchange(last_message, {});
  if (code == PETSC_ERR_MEM || detail.starts_with(kAllocation)) throw std::bad_alloc();
  fail("PETSc error ", static_cast<int>(code), " (", text ? text : "unknown", ")",
       detail.empty() ? "" : ": " + detail, " [", file, ":", line, "]");
}

void check(PetscErrorCode code, std::exception_ptr& pending, const char* file, int line) {
  if (pending) std::rethrow_exception(std::exchange(pending, nullptr));
  check(code, file, line);
}

void start_solvers(int& argc, char**& argv) {
  constexpr const char* kNoHandlers = "-no_signal_handler";  // signals keep what the system does with them
  const auto print = PetscErrorPrintf;
  PetscErrorPrintf = keep_text;
  PetscOptionsSetValue(nullptr, kNoHandlers, "true");
  const PetscErrorCode code = SlepcInitialize(&argc, &argv, nullptr, nullptr);
  if (PetscErrorPrintf == keep_text) PetscErrorPrintf = print;
  PetscOptionsClearValue(nullptr, kNoHandlers);
  require(code == 0, "PETSc cannot start. Its options are in PETSC_OPTIONS and in the files .petscrc, too. ",
          message_in(start_text));
}

SilentErrors::SilentErrors() { check(PetscPushErrorHandler(keep_message, nullptr)); }
SilentErrors::~SilentErrors() { PetscPopErrorHandler(); }

Session::Session(int& argc, char**& argv) {
  start_solvers(argc, argv);
  silent_.emplace();
}

Session::~Session() {
  silent_.reset();
  SlepcFinalize();
}

}  // namespace elastogear
