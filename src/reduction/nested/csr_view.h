#pragma once
// Entries of a sequential matrix of PETSc.

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// Rows of a sequential matrix without copies; the matrix is borrowed.
class CsrView {
 public:
  explicit CsrView(Mat A) : A_(A) {
    PetscBool done = PETSC_FALSE;
    check(MatGetRowIJ(A_, 0, PETSC_FALSE, PETSC_FALSE, &n_, &offset_, &column_, &done));
    check(MatSeqAIJGetArrayRead(A_, &value_));
  }
  CsrView(const CsrView&) = delete;
  CsrView& operator=(const CsrView&) = delete;
  ~CsrView() {
    PetscBool done = PETSC_FALSE;
    MatRestoreRowIJ(A_, 0, PETSC_FALSE, PETSC_FALSE, &n_, &offset_, &column_, &done);
    MatSeqAIJRestoreArrayRead(A_, &value_);
  }

  int n() const { return n_; }
  template <class F>
  void visit_row(int i, F&& f) const {
    for (PetscInt k = offset_[i]; k < offset_[i + 1]; ++k) f(column_[k], value_[k]);
  }

 private:
  Mat A_;
  PetscInt n_ = 0;
  const PetscInt *offset_ = nullptr, *column_ = nullptr;
  const PetscScalar* value_ = nullptr;
};

}  // namespace elastogear::reduction
