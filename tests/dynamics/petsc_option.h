#pragma once
// An option of PETSc that holds while it lives.

#include "elastogear/base/petsc.h"

namespace elastogear::test {

class Option {
 public:
  Option(const char* name, const char* value) : name_(name) {
    check(PetscOptionsSetValue(nullptr, name, value));
  }
  ~Option() { PetscOptionsClearValue(nullptr, name_); }
  Option(const Option&) = delete;

 private:
  const char* name_;
};

}  // namespace elastogear::test
