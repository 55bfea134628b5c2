#include "elastogear/base/collectively.h"

#include <string>

#include "elastogear/base/error.h"

namespace elastogear {

void collectively(MPI_Comm comm, const std::function<void()>& f) {
  std::string message;
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  int failed = size;
  try {
    f();
  } catch (const std::exception& error) {
    message = failure_text(error);
    failed = rank;
  }
  int first = size;
  MPI_Allreduce(&failed, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first == size) return;
  auto length = static_cast<int>(message.size());
  MPI_Bcast(&length, 1, MPI_INT, first, comm);
  message.resize(static_cast<std::size_t>(length));
  MPI_Bcast(message.data(), length, MPI_CHAR, first, comm);
  throw Error(message);
}

}  // namespace elastogear
