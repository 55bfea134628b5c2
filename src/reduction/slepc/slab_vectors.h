#pragma once
// Basis vectors in slabs of rows as a BV type of SLEPc, "slabs".

#include <slepcbv.h>

#include "reduction/eigensolver/tall_basis.h"

namespace elastogear::reduction {

/// Columns lie in a TallBasis: products with some vectors at a time run near the speed of memory, whose size
/// no 32-bit index limits, and which is taken when a column is first written. BVGetColumn and BVGetArray hand
/// out copies and write changes back. Deflation by constraints and split BVs are not supported.
constexpr const char* kSlabsType = "slabs";

/// May be called more than once.
void register_slabs();

/// The columns of bv, which must be of the type "slabs".
TallBasis& slabs(BV bv);
/// Columns of bv cannot be read from now on: they were handed out when they were found, and take no memory.
void slabs_set_handed_out(BV bv, bool handed_out);

}  // namespace elastogear::reduction
