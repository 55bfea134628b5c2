#pragma once
// Eigen views of sequential PETSc vectors, and PETSc vectors of Eigen's.

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

/// A new sequential vector of these values.
inline UniqueVec vector(const Eigen::VectorXd& values) {
  UniqueVec vec;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), vec.out()));
  assign(vec, values);
  return vec;
}

}  // namespace elastogear::dynamics
