#include "elastogear/base/petsc.h"

#include <slepcsys.h>

#include "elastogear/base/error.h"

namespace elastogear {
namespace {

thread_local std::string last_message;

// Keeps PETSc's innermost message for check() instead of printing a traceback.
PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) last_message = std::string(function) + ": " + (message ? message : "");
  return code;
}

}  // namespace

void check(PetscErrorCode code, const char* file, int line) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  const std::string detail = std::exchange(last_message, {});
  fail("PETSc error ", static_cast<int>(code), " (", text ? text : "unknown", ")",
       detail.empty() ? "" : ": " + detail, " [", file, ":", line, "]");
}

void check(PetscErrorCode code, std::exception_ptr& pending, const char* file, int line) {
  if (pending) std::rethrow_exception(std::exchange(pending, nullptr));
  check(code, file, line);
}

Session::Session(int& argc, char**& argv) {
  check(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  check(PetscPushErrorHandler(keep_message, nullptr));
}

Session::~Session() {
  PetscPopErrorHandler();
  SlepcFinalize();
}

}  // namespace elastogear
