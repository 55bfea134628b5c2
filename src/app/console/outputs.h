#pragma once
// Outputs of a run are checked here: none may be one of its inputs, and none may be written by another run at
// the same time.

#include <petscsys.h>

#include <string>
#include <vector>

#include "app/options/options.h"

namespace elastogear::app {

/// Files that the value of an option makes the run write.
struct Outputs {
  std::string option;  ///< without '-'
  std::vector<std::string> files;
};

/// Before the work starts: throws Error when one of the outputs cannot be written where it is to be, when two
/// of them are one file, and when one is a file that the run reads, also by another spelling or a link: those
/// the options were read from, those that the verb's other options name, and `data`.
void protect_inputs(const Options& options, const std::vector<Outputs>& outputs,
                    const std::vector<std::string>& data = {});

/// Throws Error when two of the outputs are one file, also by different paths: the second would take the
/// place of the first.
void require_different(const Options& options, const std::vector<Outputs>& outputs);

/// While it lives no other run can hold the lock of the same output. The lock is on the file `path`.lock,
/// which is removed at the end; left by a run that was killed, it is free. A link or a file of the user's
/// that has this name is left alone, with an Error. Where the file system has no locks there is none.
class OutputLock {
 public:
  /// Throws Error, on all ranks, when another run has it, and when nothing can be written there. Collective
  /// over the ranks, of which the first takes the lock.
  explicit OutputLock(const std::string& path, MPI_Comm comm = PETSC_COMM_WORLD);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void take(const std::string& output);

  std::string path_;
  int file_ = -1;
};

}  // namespace elastogear::app
