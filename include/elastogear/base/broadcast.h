#pragma once
// Lists of plain numbers or structs from rank 0 to all ranks.

#include <mpi.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace elastogear {

/// T is copied byte by byte. Collective.
template <class T>
void broadcast(MPI_Comm comm, std::vector<T>& values) {
  auto n = static_cast<long long>(values.size());
  MPI_Bcast(&n, 1, MPI_LONG_LONG, 0, comm);
  values.resize(static_cast<std::size_t>(n));
  auto* data = reinterpret_cast<char*>(values.data());
  for (auto left = n * static_cast<long long>(sizeof(T)); left > 0;) {
    const auto count = static_cast<int>(std::min<long long>(left, std::numeric_limits<int>::max()));
    MPI_Bcast(data, count, MPI_BYTE, 0, comm);
    data += count;
    left -= count;
  }
}

}  // namespace elastogear
