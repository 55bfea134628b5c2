#pragma once
// Bases beside eigenmodes: which, and their choices.

#include <vector>

namespace elastogear::reduction {

/// docs/theory, section 2.7.
enum class RitzKind { modal_attachment, krylov, craig_bampton };

struct RitzOptions {
  RitzKind kind = RitzKind::modal_attachment;
  int interface_modes = 0;          ///< craig_bampton: so many of all; 0: half of them where that is possible
  std::vector<double> shift = {0};  ///< Hz, krylov: each takes an equal part of the columns
};

}  // namespace elastogear::reduction
