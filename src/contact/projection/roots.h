#pragma once

#include <vector>

namespace elastogear::contact {

/// Places in [lo, hi] where the polynomial sum_i p[i] u^i changes its sign, ascending, to roundoff.
std::vector<double> sign_changes(const std::vector<double>& p, double lo, double hi);

}  // namespace elastogear::contact
