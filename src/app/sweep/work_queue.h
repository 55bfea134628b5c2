#pragma once
// Pieces of work that the ranks take one after the other.

#include <mpi.h>

namespace elastogear::app {

/// The numbers 0 .. n - 1, each given to one rank. Collective to make and to destroy.
class WorkQueue {
 public:
  WorkQueue(MPI_Comm comm, long n);
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// The next number that no rank has taken; n when there is none.
  long next();
  /// Nothing is left for any rank.
  void close();

 private:
  long n_;
  long* taken_ = nullptr;  // of rank 0
  MPI_Win window_ = MPI_WIN_NULL;
};

}  // namespace elastogear::app
