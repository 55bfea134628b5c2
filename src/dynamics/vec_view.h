#pragma once
// Eigen views of sequential PETSc vectors.

#include <Eigen/Core>

#include "elastogear/base/petsc.h"

namespace elastogear::dynamics {

/// Read-only while it lives.
class ReadView {
 public:
  explicit ReadView(Vec vec) : vec_(vec) {
    check(VecGetLocalSize(vec, &size_));
    check(VecGetArrayRead(vec, &array_));
  }
  ~ReadView() { VecRestoreArrayRead(vec_, &array_); }
  ReadView(const ReadView&) = delete;
  ReadView& operator=(const ReadView&) = delete;
  Eigen::Map<const Eigen::VectorXd> operator*() const { return {array_, size_}; }

 private:
  Vec vec_;
  PetscInt size_ = 0;
  const PetscScalar* array_ = nullptr;
};

inline void assign(Vec vec, const Eigen::VectorXd& values) {
  PetscScalar* array = nullptr;
  check(VecGetArrayWrite(vec, &array));
  Eigen::Map<Eigen::VectorXd>(array, values.size()) = values;
  check(VecRestoreArrayWrite(vec, &array));
}

}  // namespace elastogear::dynamics
