#pragma once
// Largest principal values of symmetric tensors in closed form, several tensors at a time (docs/theory,
// Eq. (4.2a)).

#include <Eigen/Core>

namespace elastogear::recovery {

/// The largest principal value of each of n tensors, exact to roundoff of the tensor's norm also where
/// principal values coincide. tensors: 6 n numbers, xx yy zz xy yz xz of one after the other.
void largest_principal(const double* tensors, Eigen::Index n, double* values);

}  // namespace elastogear::recovery
