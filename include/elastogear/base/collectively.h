#pragma once
// One failure, one message: errors that only some ranks meet become the same Error on all of them.

#include <mpi.h>

#include <functional>

namespace elastogear {

/// Runs `f` on every rank and then compares: if it threw anywhere, every rank throws Error with the message
/// of the lowest such rank. Collective; `f` itself must not call anything collective.
void collectively(MPI_Comm comm, const std::function<void()>& f);

}  // namespace elastogear
