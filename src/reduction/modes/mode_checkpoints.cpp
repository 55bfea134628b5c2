#include "reduction/modes/mode_checkpoints.h"

#include <cstdio>

#include "elastogear/base/collectively.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string checkpoint_name(std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "window_%06zu", number);
  return name;
}

// Numbers of the state: lower, shift, below_shift, orthogonality, iterations.
VectorXd numbers(const SearchState& state) {
  VectorXd v(5);
  v << state.lower, state.shift, state.below_shift, state.orthogonality, state.iterations;
  return v;
}

void set_numbers(SearchState& state, const VectorXd& v) {
  state.lower = v(0);
  state.shift = v(1);
  state.below_shift = static_cast<int>(v(2));
  state.orthogonality = v(3);
  state.iterations = static_cast<int>(v(4));
}

void share(MPI_Comm comm, VectorXd& v) {
  int length = static_cast<int>(v.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  v.resize(length);
  MPI_Bcast(v.data(), length, MPI_DOUBLE, 0, comm);
}

struct Layout {
  std::vector<int> count, offset;
  int total = 0;
};

// Distribution of the rows over the ranks, known on all ranks.
Layout row_layout(MPI_Comm comm, int n_own) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  Layout layout{std::vector<int>(size), std::vector<int>(size), 0};
  MPI_Allgather(&n_own, 1, MPI_INT, layout.count.data(), 1, MPI_INT, comm);
  for (int r = 0; r < size; ++r) {
    layout.offset[r] = layout.total;
    layout.total += layout.count[r];
  }
  return layout;
}

// All rows on rank 0, empty elsewhere.
MatrixXd gather_rows(MPI_Comm comm, const MatrixXd& own) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const int n_own = static_cast<int>(own.rows());
  const Layout layout = row_layout(comm, n_own);
  MatrixXd all(rank == 0 ? layout.total : 0, own.cols());
  for (Index j = 0; j < own.cols(); ++j)
    MPI_Gatherv(own.data() + j * n_own, n_own, MPI_DOUBLE, all.data() + j * all.rows(), layout.count.data(),
                layout.offset.data(), MPI_DOUBLE, 0, comm);
  return all;
}

MatrixXd scatter_rows(MPI_Comm comm, const MatrixXd& all, int n_own) {
  const Layout layout = row_layout(comm, n_own);
  int columns = static_cast<int>(all.cols());
  MPI_Bcast(&columns, 1, MPI_INT, 0, comm);
  MatrixXd own(n_own, columns);
  for (Index j = 0; j < columns; ++j)
    MPI_Scatterv(all.data() + j * all.rows(), layout.count.data(), layout.offset.data(), MPI_DOUBLE,
                 own.data() + j * n_own, n_own, MPI_DOUBLE, 0, comm);
  return own;
}

}  // namespace

ModeCheckpoints::ModeCheckpoints(MPI_Comm comm, const std::string& folder, const std::string& fingerprint,
                                 io::Precision precision)
    : comm_(comm), precision_(precision) {
  MPI_Comm_rank(comm, &rank_);
  collectively(comm, [&] {
    if (rank_ == 0) store_.emplace(folder, fingerprint);
  });
}

SearchState ModeCheckpoints::resume(int n_own) const {
  SearchState state;
  VectorXd values;
  MatrixXd edge;
  collectively(comm_, [&] {
    if (rank_ != 0 || store_->names().empty()) return;
    const io::CheckpointReader checkpoint(*store_, store_->names().back());
    values = checkpoint.read("state");
    state.eigenvalue = checkpoint.read("eigenvalue");
    state.residual = checkpoint.read("residual");
    edge = checkpoint.read("edge");
  });
  share(comm_, values);
  if (values.size() == 0) return state;
  set_numbers(state, values);
  share(comm_, state.eigenvalue);
  share(comm_, state.residual);
  state.edge = scatter_rows(comm_, edge, n_own);
  return state;
}

void ModeCheckpoints::add(int index, const ModeRecord& mode) {
  if (!current_) {
    current_.emplace(*store_, checkpoint_name(store_->names().size()));
    first_ = index;
  }
  current_->append("column", mode.column);
  if (mode.phi.size() > 0) current_->append("phi", mode.phi, precision_);
}

void ModeCheckpoints::commit(const SearchState& state) {
  const MatrixXd edge = gather_rows(comm_, state.edge);
  collectively(comm_, [&] {
    if (rank_ != 0) return;
    current_->write("first", VectorXd::Constant(1, first_));
    current_->write("state", numbers(state));
    current_->write("eigenvalue", state.eigenvalue);
    current_->write("residual", state.residual);
    current_->write("edge", edge);
    current_->commit();
    current_.reset();
  });
}

void ModeCheckpoints::visit(const std::function<void(int, const ModeRecord&)>& f) const {
  for (const std::string& name : store_->names()) {
    const io::CheckpointReader checkpoint(*store_, name);
    const int first = static_cast<int>(checkpoint.read("first")(0)), n = checkpoint.n_rows("column");
    const bool full = checkpoint.has("phi");
    for (int i = 0; i < n; ++i)
      f(first + i, {checkpoint.read_row("column", i), full ? checkpoint.read_row("phi", i) : VectorXd{}});
  }
}

void ModeCheckpoints::clear() {
  collectively(comm_, [&] {
    if (rank_ == 0) store_->clear();
  });
}

}  // namespace elastogear::reduction
