#pragma once
// PETSc and SLEPc held, not wrapped: RAII handles, a throwing check, and the session that starts and ends
// MPI.

#include <petscts.h>

#include <exception>
#include <optional>
#include <utility>

namespace elastogear {

/// Throws Error naming the call site and PETSc's own message when `code` is not 0.
void check(PetscErrorCode code, const char* file = __builtin_FILE(), int line = __builtin_LINE());

/// Move-only owner of one PETSc object. Functions borrow the raw object and return the handle.
/// Destroying is collective: scopes end in the same order on all ranks.
template <class T, PetscErrorCode (*Destroy)(T*)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (object_) Destroy(&object_);
  }

  operator T() const { return object_; }
  T get() const { return object_; }
  /// For creation: `MatCreate(comm, A.out())`. Destroys what was held.
  T* out() {
    if (object_) Destroy(&object_);
    object_ = nullptr;
    return &object_;
  }

 private:
  T object_ = nullptr;
};

using UniqueVec = Handle<Vec, VecDestroy>;
using UniqueMat = Handle<Mat, MatDestroy>;
using UniqueIS = Handle<IS, ISDestroy>;
using UniqueKSP = Handle<KSP, KSPDestroy>;
using UniqueSNES = Handle<SNES, SNESDestroy>;
using UniqueTS = Handle<TS, TSDestroy>;
using UniqueScatter = Handle<VecScatter, VecScatterDestroy>;
using UniqueViewer = Handle<PetscViewer, PetscViewerDestroy>;

inline MPI_Comm comm_of(Mat A) { return PetscObjectComm(reinterpret_cast<PetscObject>(A)); }

/// Initialises MPI, PETSc and SLEPc unless they run; Error when they cannot start.
void start_solvers(int& argc, char**& argv);

/// While it lives PETSc's errors return codes silently (check() turns them into exceptions).
class SilentErrors {
 public:
  SilentErrors();
  ~SilentErrors();
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;
};

/// First object in `main`: initialises MPI, PETSc and SLEPc; finalises them last. PETSc errors are silent.
class Session {
 public:
  Session(int& argc, char**& argv);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::optional<SilentErrors> silent_;
};

/// Body of every PETSc callback: runs `f`, keeps an exception in `pending` for rethrow after the solve, and
/// returns a PETSc error code in that case.
template <class F>
PetscErrorCode guard(std::exception_ptr& pending, F&& f) noexcept {
  try {
    f();
    return 0;
  } catch (...) {
    pending = std::current_exception();
    return PETSC_ERR_USER;
  }
}

/// After a solve with guarded callbacks: rethrows what a callback threw, else checks `code`.
void check(PetscErrorCode code, std::exception_ptr& pending, const char* file = __builtin_FILE(),
           int line = __builtin_LINE());

}  // namespace elastogear
