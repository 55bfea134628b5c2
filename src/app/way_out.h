#pragma once
// How the program ends: with one line and a code other than 0 when something went wrong, on all ranks.

#include <mpi.h>

#include <string>

namespace elastogear::app {

/// From now on the program says so in one line, and ends, when what reads its output has gone.
void report_closed_pipes(const std::string& verb);

/// The ranks of MPI_COMM_WORLD come together at their end. A rank that failed where others go on, and wait
/// for it, would hold them for ever: after some seconds it says why, and ends all of them.
class CommonEnd {
 public:
  CommonEnd();
  /// Collective. `failure`: what went wrong on this rank, and has been said if `said`; empty: nothing.
  void wait(const std::string& failure, bool said);

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
};

/// The code to end with, when standard output has taken all that was written; else 1, with an error.
int checked_output(int code, const std::string& verb);

}  // namespace elastogear::app
