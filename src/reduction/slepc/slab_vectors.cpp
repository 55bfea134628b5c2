#include "reduction/slepc/slab_vectors.h"

#include <slepc/private/bvimpl.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr PetscInt kChunk = 32;  // columns that are copied together

struct Slabs {
  std::optional<TallBasis> columns = {};
  PetscInt n_written = 0;  // columns from the first on that hold values
  bool handed_out = false;
};

Slabs& data(BV bv) { return *static_cast<Slabs*>(bv->data); }

TallBasis& columns(BV bv) {
  auto& store = data(bv).columns;
  if (!store) store.emplace(bv->n, static_cast<int>(bv->m));
  return *store;
}

MatrixXd read(BV bv, PetscInt first, PetscInt n) {
  MatrixXd X = MatrixXd::Zero(bv->n, n);
  const PetscInt known = std::clamp<PetscInt>(data(bv).n_written - first, 0, n);
  if (known > 0) X.leftCols(known) = columns(bv).get(static_cast<int>(first), static_cast<int>(known));
  return X;
}

void write(BV bv, PetscInt first, const MatrixXd& X) {
  PetscInt& n_written = data(bv).n_written;
  for (; n_written < first; ++n_written)
    columns(bv).set(static_cast<int>(n_written), MatrixXd::Zero(bv->n, 1));
  columns(bv).set(static_cast<int>(first), X);
  n_written = std::max(n_written, first + static_cast<PetscInt>(X.cols()));
}

// V' W of the columns l..k-1 on this rank.
MatrixXd own_products(BV V, const MatrixXd& W) {
  MatrixXd product = MatrixXd::Zero(V->k, W.cols());
  const PetscInt known = std::min(V->k, data(V).n_written);
  if (known > 0) product.topRows(known) = columns(V).dot(static_cast<int>(known), W);
  return product.bottomRows(V->k - V->l);
}

// Y += V C with the columns l..k-1.
void add_product(BV V, const MatrixXd& C, MatrixXd& Y) {
  const PetscInt known = std::min(V->k, data(V).n_written) - V->l;
  if (known > 0) columns(V).add_product(static_cast<int>(V->l), C.topRows(known), Y);
}

PetscErrorCode sum_over_ranks(BV bv, double* values, Index n) {
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(n), MPI_DOUBLE, MPI_SUM,
                             PetscObjectComm((PetscObject)bv)));
  return 0;
}

// rows x columns of the dense Q from (row, column) on.
PetscErrorCode block_of(Mat Q, Index row, Index rows, Index column, Index n_columns, MatrixXd& block) {
  const PetscScalar* q = nullptr;
  PetscInt stride = 0;
  PetscCall(MatDenseGetLDA(Q, &stride));
  PetscCall(MatDenseGetArrayRead(Q, &q));
  block = Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>(q + column * stride + row, rows, n_columns,
                                                              Eigen::OuterStride<>(stride));
  return MatDenseRestoreArrayRead(Q, &q);
}

PetscErrorCode mult(BV Y, PetscScalar alpha, PetscScalar beta, BV X, Mat Q) {
  const Index rows = X->k - X->l, n = Y->k - Y->l;
  MatrixXd C = MatrixXd::Identity(rows, n);
  if (Q) PetscCall(block_of(Q, X->l, rows, Y->l, n, C));
  C *= alpha;
  for (PetscInt j = 0; j < n; j += kChunk) {
    const PetscInt width = std::min<PetscInt>(kChunk, n - j);
    MatrixXd part = beta * read(Y, Y->l + j, width);
    add_product(X, C.middleCols(j, width), part);
    write(Y, Y->l + j, part);
  }
  return 0;
}

PetscErrorCode multvec(BV X, PetscScalar alpha, PetscScalar beta, Vec y, PetscScalar* q) {
  PetscScalar *values = nullptr, *weights = q;
  const Index n = X->k - X->l;
  if (!q) PetscCall(VecGetArray(X->buffer, &weights));
  PetscCall(VecGetArray(y, &values));
  MatrixXd result = beta * Eigen::Map<MatrixXd>(values, X->n, 1);
  add_product(X, alpha * Eigen::Map<MatrixXd>(weights, n, 1), result);
  std::copy_n(result.data(), X->n, values);
  PetscCall(VecRestoreArray(y, &values));
  if (!q) PetscCall(VecRestoreArray(X->buffer, &weights));
  return 0;
}

PetscErrorCode replace_by_products(BV V, const MatrixXd& C, PetscInt first) {
  MatrixXd result = MatrixXd::Zero(V->n, C.cols());
  add_product(V, C, result);
  write(V, first, result);
  return 0;
}

PetscErrorCode multinplace(BV V, Mat Q, PetscInt s, PetscInt e) {
  MatrixXd C;
  PetscCall(block_of(Q, V->l, V->k - V->l, s, e - s, C));
  return replace_by_products(V, C, s);
}

PetscErrorCode multinplacetrans(BV V, Mat Q, PetscInt s, PetscInt e) {
  MatrixXd C;
  PetscCall(block_of(Q, s, e - s, V->l, V->k - V->l, C));
  return replace_by_products(V, C.transpose(), s);
}

// M := Y' X of the active columns.
PetscErrorCode dot(BV X, BV Y, Mat M) {
  const Index n_x = X->k - X->l, n_y = Y->k - Y->l;
  MatrixXd products(n_x, n_y);
  for (PetscInt j = 0; j < n_y; j += kChunk) {
    const PetscInt width = std::min<PetscInt>(kChunk, n_y - j);
    products.middleCols(j, width) = own_products(X, read(Y, Y->l + j, width));
  }
  PetscCall(sum_over_ranks(X, products.data(), products.size()));
  PetscScalar* m = nullptr;
  PetscInt stride = 0;
  PetscCall(MatDenseGetLDA(M, &stride));
  PetscCall(MatDenseGetArray(M, &m));
  for (Index i = 0; i < n_x; ++i)
    for (Index j = 0; j < n_y; ++j) m[(X->l + i) * stride + Y->l + j] = products(i, j);
  return MatDenseRestoreArray(M, &m);
}

PetscErrorCode dot_own(BV X, Vec y, PetscScalar* q, bool sum) {
  PetscScalar* target = q;
  const PetscScalar* values = nullptr;
  Vec z = y;
  if (X->matrix) {
    PetscCall(BV_IPMatMult(X, y));
    z = X->Bx;
  }
  PetscCall(VecGetArrayRead(z, &values));
  const MatrixXd products = own_products(X, Eigen::Map<const MatrixXd>(values, X->n, 1));
  PetscCall(VecRestoreArrayRead(z, &values));
  if (!q) PetscCall(VecGetArray(X->buffer, &target));
  std::copy_n(products.data(), products.size(), target);
  if (sum) PetscCall(sum_over_ranks(X, target, products.size()));
  if (!q) PetscCall(VecRestoreArray(X->buffer, &target));
  return 0;
}

PetscErrorCode dotvec(BV X, Vec y, PetscScalar* q) { return dot_own(X, y, q, true); }
PetscErrorCode dotvec_local(BV X, Vec y, PetscScalar* q) { return dot_own(X, y, q, false); }

// The columns that j stands for: one, or all active ones where it is negative.
std::pair<PetscInt, PetscInt> range(BV bv, PetscInt j) {
  return j < 0 ? std::pair{bv->l, bv->k} : std::pair{j, j + 1};
}

PetscErrorCode scale(BV bv, PetscInt j, PetscScalar alpha) {
  const auto [begin, end] = range(bv, j);
  for (PetscInt i = begin; i < end; ++i) write(bv, i, alpha * read(bv, i, 1));
  return 0;
}

PetscErrorCode norm_of(BV bv, PetscInt j, NormType type, PetscReal* value, bool all_ranks) {
  const auto [begin, end] = range(bv, j);
  const MPI_Comm comm = all_ranks ? PetscObjectComm((PetscObject)bv) : PETSC_COMM_SELF;
  const MatrixXd X = read(bv, begin, end - begin);
  double result = 0;
  if (type == NORM_INFINITY) {
    const double own = X.rows() > 0 ? X.cwiseAbs().rowwise().sum().maxCoeff() : 0;
    PetscCallMPI(MPI_Allreduce(&own, &result, 1, MPI_DOUBLE, MPI_MAX, comm));
  } else {
    Eigen::RowVectorXd sums = type == NORM_1 ? Eigen::RowVectorXd(X.cwiseAbs().colwise().sum())
                                             : Eigen::RowVectorXd(X.colwise().squaredNorm());
    PetscCallMPI(
        MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, comm));
    result = type == NORM_1 ? sums.maxCoeff() : std::sqrt(sums.sum());
  }
  *value = result;
  return 0;
}

PetscErrorCode norm(BV bv, PetscInt j, NormType type, PetscReal* value) {
  return norm_of(bv, j, type, value, true);
}
PetscErrorCode norm_local(BV bv, PetscInt j, NormType type, PetscReal* value) {
  return norm_of(bv, j, type, value, false);
}

PetscErrorCode matmult(BV V, Mat A, BV W) {
  for (PetscInt j = 0; j < V->k - V->l; ++j) {
    Vec v = nullptr, w = nullptr;
    PetscCall(BVGetColumn(V, V->l + j, &v));
    PetscCall(BVGetColumn(W, W->l + j, &w));
    PetscCall(MatMult(A, v, w));
    PetscCall(BVRestoreColumn(V, V->l + j, &v));
    PetscCall(BVRestoreColumn(W, W->l + j, &w));
  }
  return 0;
}

PetscErrorCode copy(BV V, BV W) {
  for (PetscInt j = 0; j < V->k - V->l; ++j) write(W, W->l + j, read(V, V->l + j, 1));
  return 0;
}

PetscErrorCode copycolumn(BV V, PetscInt j, PetscInt i) {
  write(V, i, read(V, j, 1));
  return 0;
}

PetscErrorCode resize(BV bv, PetscInt m, PetscBool keep) {
  Slabs& s = data(bv);
  if (!s.columns) return 0;
  const PetscInt kept = keep ? std::min(m, s.n_written) : 0;
  TallBasis larger(bv->n, static_cast<int>(m));
  for (PetscInt j = 0; j < kept; j += kChunk)
    larger.set(static_cast<int>(j),
               s.columns->get(static_cast<int>(j), static_cast<int>(std::min(kChunk, kept - j))));
  s.columns = std::move(larger);
  s.n_written = kept;
  return 0;
}

PetscErrorCode getcolumn(BV bv, PetscInt j, Vec*) {
  const PetscInt l = BVAvailableVec;
  PetscScalar* values = nullptr;
  PetscCheck(!data(bv).handed_out, PetscObjectComm((PetscObject)bv), PETSC_ERR_ARG_WRONGSTATE,
             "Vector %" PetscInt_FMT " was handed out when it was found, and is not kept", j);
  PetscCall(VecGetArrayWrite(bv->cv[l], &values));
  const MatrixXd column = read(bv, j, 1);
  std::copy_n(column.data(), bv->n, values);
  return VecRestoreArrayWrite(bv->cv[l], &values);
}

PetscErrorCode restorecolumn(BV bv, PetscInt j, Vec* v) {
  const PetscInt l = j == bv->ci[0] ? 0 : 1;
  PetscObjectState now = 0;
  const PetscScalar* values = nullptr;
  PetscCall(PetscObjectStateGet((PetscObject)*v, &now));
  if (now == bv->st[l]) return 0;
  PetscCall(VecGetArrayRead(*v, &values));
  write(bv, j, Eigen::Map<const MatrixXd>(values, bv->n, 1));
  return VecRestoreArrayRead(*v, &values);
}

PetscErrorCode getarray(BV bv, PetscScalar** values) {
  const auto n = static_cast<std::size_t>(bv->n), m = static_cast<std::size_t>(bv->m);
  PetscCall(PetscMalloc1(n * m, values));
  for (PetscInt j = 0; j < bv->m; ++j) {
    const MatrixXd column = read(bv, j, 1);
    std::copy_n(column.data(), bv->n, *values + n * static_cast<std::size_t>(j));
  }
  return 0;
}

PetscErrorCode restorearray(BV bv, PetscScalar** values) {
  const auto n = static_cast<std::size_t>(bv->n);
  for (PetscInt j = 0; j < bv->m; ++j)
    write(bv, j, Eigen::Map<const MatrixXd>(*values + n * static_cast<std::size_t>(j), bv->n, 1));
  return PetscFree(*values);
}

PetscErrorCode getarrayread(BV bv, const PetscScalar** values) {
  return getarray(bv, const_cast<PetscScalar**>(values));
}

PetscErrorCode restorearrayread(BV, const PetscScalar** values) { return PetscFree(*values); }

PetscErrorCode getmat(BV bv, Mat* A) {
  PetscScalar* values = nullptr;
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)bv), bv->n, PETSC_DECIDE, bv->N, bv->k - bv->l,
                           nullptr, A));
  PetscCall(MatDenseGetArrayWrite(*A, &values));
  const MatrixXd X = read(bv, bv->l, bv->k - bv->l);
  std::copy_n(X.data(), X.size(), values);
  PetscCall(MatDenseRestoreArrayWrite(*A, &values));
  bv->Aget = *A;
  return 0;
}

PetscErrorCode restoremat(BV bv, Mat* A) {
  const PetscScalar* values = nullptr;
  PetscCall(MatDenseGetArrayRead(*A, &values));
  write(bv, bv->l, Eigen::Map<const MatrixXd>(values, bv->n, bv->k - bv->l));
  PetscCall(MatDenseRestoreArrayRead(*A, &values));
  bv->Aget = nullptr;
  return MatDestroy(A);
}

PetscErrorCode view(BV bv, PetscViewer viewer) {
  PetscViewerFormat format = PETSC_VIEWER_DEFAULT;
  PetscCall(PetscViewerGetFormat(viewer, &format));
  if (format == PETSC_VIEWER_ASCII_INFO || format == PETSC_VIEWER_ASCII_INFO_DETAIL) return 0;
  for (PetscInt j = bv->l; j < bv->k; ++j) {
    Vec v = nullptr;
    PetscCall(BVGetColumn(bv, j, &v));
    PetscCall(VecView(v, viewer));
    PetscCall(BVRestoreColumn(bv, j, &v));
  }
  return 0;
}

PetscErrorCode destroy(BV bv) {
  PetscCall(VecDestroy(&bv->cv[0]));
  PetscCall(VecDestroy(&bv->cv[1]));
  delete static_cast<Slabs*>(bv->data);
  bv->data = nullptr;
  return 0;
}

void set_operations(BVOps ops) {
  ops->mult = mult;
  ops->multvec = multvec;
  ops->multinplace = multinplace;
  ops->multinplacetrans = multinplacetrans;
  ops->dot = dot;
  ops->dotvec = dotvec;
  ops->dotvec_local = dotvec_local;
  ops->scale = scale;
  ops->norm = norm;
  ops->norm_local = norm_local;
  ops->matmult = matmult;
  ops->copy = copy;
  ops->copycolumn = copycolumn;
  ops->resize = resize;
  ops->getcolumn = getcolumn;
  ops->restorecolumn = restorecolumn;
  ops->getarray = getarray;
  ops->restorearray = restorearray;
  ops->getarrayread = getarrayread;
  ops->restorearrayread = restorearrayread;
  ops->getmat = getmat;
  ops->restoremat = restoremat;
  ops->view = view;
  ops->destroy = destroy;
}

PetscErrorCode create(BV bv) {
  PetscCheck(!bv->issplit && bv->nc == 0, PetscObjectComm((PetscObject)bv), PETSC_ERR_SUP,
             "BV type %s has neither constraints nor splits", kSlabsType);
  PetscCheck(!bv->Acreate, PetscObjectComm((PetscObject)bv), PETSC_ERR_SUP,
             "BV type %s is not made of a matrix", kSlabsType);
  bv->data = new Slabs{};
#if SLEPC_VERSION_GE(3, 20, 0)
  bv->ld = bv->n;  // of getarray: columns follow one another
#endif
  PetscCall(BVCreateVec(bv, &bv->cv[0]));
  PetscCall(BVCreateVec(bv, &bv->cv[1]));
  set_operations(bv->ops);
  return 0;
}

}  // namespace

void register_slabs() { check(BVRegister(kSlabsType, create)); }

TallBasis& slabs(BV bv) { return columns(bv); }

void slabs_set_handed_out(BV bv, bool handed_out) { data(bv).handed_out = handed_out; }

}  // namespace elastogear::reduction
