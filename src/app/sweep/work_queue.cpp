#include "app/sweep/work_queue.h"

#include <algorithm>

namespace elastogear::app {
namespace {

long exchange(MPI_Win window, long value, MPI_Op op) {
  long before = 0;
  MPI_Fetch_and_op(&value, &before, MPI_LONG, 0, 0, op, window);
  MPI_Win_flush(0, window);
  return before;
}

}  // namespace

WorkQueue::WorkQueue(MPI_Comm comm, long n) : n_(n) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const MPI_Aint bytes = rank == 0 ? sizeof(long) : 0;
  MPI_Win_allocate(bytes, sizeof(long), MPI_INFO_NULL, comm, &taken_, &window_);
  MPI_Win_lock_all(0, window_);
  if (rank == 0) exchange(window_, 0, MPI_REPLACE);
  MPI_Barrier(comm);
}

WorkQueue::~WorkQueue() {
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
}

long WorkQueue::next() { return std::min(n_, exchange(window_, 1, MPI_SUM)); }

void WorkQueue::close() { exchange(window_, n_, MPI_REPLACE); }

}  // namespace elastogear::app
