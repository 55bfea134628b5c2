#include "reduction/slepc/slab_vectors.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "elastogear/base/petsc.h"

namespace elastogear::slab_vectors_test {
namespace {

using UniqueBV = Handle<BV, BVDestroy>;

constexpr int kRows = 301, kColumns = 9;  // rows: odd, which SLEPc pads in types of its own
constexpr double kRoundoff = 1e-12;

// Equal random columns in a BV of any type.
UniqueBV create(const char* type, int n_columns, int seed) {
  reduction::register_slabs();
  UniqueBV V;
  UniqueVec v;
  check(VecCreateMPI(PETSC_COMM_WORLD, PETSC_DECIDE, kRows, v.out()));
  check(BVCreate(PETSC_COMM_WORLD, V.out()));
  check(BVSetType(V, type));
  check(BVSetSizesFromVec(V, v, n_columns));
  PetscInt begin = 0, end = 0;
  check(VecGetOwnershipRange(v, &begin, &end));
  for (int j = 0; j < n_columns; ++j) {
    for (PetscInt i = begin; i < end; ++i)
      check(VecSetValue(v, i, std::sin(seed + i * (j + 1)), INSERT_VALUES));
    check(VecAssemblyBegin(v));
    check(VecAssemblyEnd(v));
    check(BVInsertVec(V, j, v));
  }
  return V;
}

UniqueMat dense(int rows, int columns) {
  UniqueMat A;
  PetscScalar* values = nullptr;
  check(MatCreateSeqDense(PETSC_COMM_SELF, rows, columns, nullptr, A.out()));
  check(MatDenseGetArray(A, &values));
  for (int i = 0; i < rows * columns; ++i) values[i] = std::cos(i);
  check(MatDenseRestoreArray(A, &values));
  return A;
}

void expect_equal(BV a, BV b) {
  UniqueVec x, y;
  PetscInt n = 0;
  check(BVCreateVec(a, x.out()));
  check(BVCreateVec(b, y.out()));
  check(BVGetSizes(a, nullptr, nullptr, &n));
  for (PetscInt j = 0; j < n; ++j) {
    PetscReal norm = 0;
    check(BVCopyVec(a, j, x));
    check(BVCopyVec(b, j, y));
    check(VecAXPY(x, -1, y));
    check(VecNorm(x, NORM_2, &norm));
    EXPECT_LT(norm, kRoundoff * kRows) << j;
  }
}

// Applies f to BVs of this type and of SLEPc's, which must do the same.
void expect_like_vecs(const std::function<void(BV V, BV W)>& f) {
  const UniqueBV V = create(reduction::kSlabsType, kColumns, 1),
                 W = create(reduction::kSlabsType, kColumns, 7);
  const UniqueBV V_2 = create(BVVECS, kColumns, 1), W_2 = create(BVVECS, kColumns, 7);
  f(V, W);
  f(V_2, W_2);
  expect_equal(V, V_2);
  expect_equal(W, W_2);
}

TEST(Slabs, multiply_like_vectors) {
  const UniqueMat Q = dense(kColumns, kColumns);
  expect_like_vecs([&](BV V, BV W) { check(BVMult(W, 2, 0.5, V, Q)); });
  expect_like_vecs([&](BV V, BV) { check(BVMultInPlace(V, Q, 2, 6)); });
  expect_like_vecs([&](BV V, BV W) {
    check(BVSetActiveColumns(V, 2, 7));
    check(BVSetActiveColumns(W, 1, 4));
    check(BVMult(W, 1, 1, V, Q));
  });
}

TEST(Slabs, copy_scale_and_orthogonalise_like_vectors) {
  expect_like_vecs([](BV V, BV W) { check(BVCopy(V, W)); });
  expect_like_vecs([](BV V, BV) { check(BVCopyColumn(V, 1, 5)); });
  expect_like_vecs([](BV V, BV) { check(BVScale(V, 3)); });
  expect_like_vecs([](BV V, BV) { check(BVScaleColumn(V, 2, 3)); });
  expect_like_vecs([](BV V, BV) { check(BVOrthogonalize(V, nullptr)); });
}

TEST(Slabs, keep_their_columns_when_resized) {
  expect_like_vecs([](BV V, BV W) {
    check(BVResize(V, kColumns + 4, PETSC_TRUE));
    check(BVResize(W, kColumns - 4, PETSC_TRUE));
  });
}

TEST(Slabs, give_products_and_norms_of_vectors) {
  const UniqueBV V = create(reduction::kSlabsType, kColumns, 1), V_2 = create(BVMAT, kColumns, 1);
  const UniqueMat M = dense(kColumns, kColumns), M_2 = dense(kColumns, kColumns);
  check(BVDot(V, V, M));
  check(BVDot(V_2, V_2, M_2));
  check(MatAXPY(M, -1, M_2, SAME_NONZERO_PATTERN));
  PetscReal difference = 0, norm = 0, norm_2 = 0;
  check(MatNorm(M, NORM_FROBENIUS, &difference));
  EXPECT_LT(difference, kRoundoff * kRows);
  for (const NormType type : {NORM_1, NORM_FROBENIUS, NORM_INFINITY}) {
    check(BVNorm(V, type, &norm));
    check(BVNorm(V_2, type, &norm_2));
    EXPECT_NEAR(norm, norm_2, kRoundoff * kRows);
  }
  check(BVNormColumn(V, 3, NORM_2, &norm));
  check(BVNormColumn(V_2, 3, NORM_2, &norm_2));
  EXPECT_NEAR(norm, norm_2, kRoundoff * kRows);
}

}  // namespace
}  // namespace elastogear::slab_vectors_test
