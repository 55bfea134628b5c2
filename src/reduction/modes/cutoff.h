#pragma once
// A limit in the spectrum with a wanted number of eigenvalues below it, found by counting.

#include <functional>
#include <vector>

#include "elastogear/fem/sector.h"
#include "elastogear/model/material.h"

namespace elastogear::reduction {

struct CountRange {
  int least, most;
};

/// Eigenvalues of the whole body below sigma (rad^2/s^2).
using Count = std::function<int(double sigma)>;

/// A sigma with wanted.least <= count(sigma) <= wanted.most; with more when so many eigenvalues are equal
/// that there is none. count must rise from 0 at 0 to at least wanted.least.
double find_cutoff(const Count& count, CountRange wanted, double start);

/// The sigma below which an elastic body of the sector's volume and surface has n modes if it is large: H.
/// Weyl's law for compression, shear and surface waves. docs/theory, Eq. (2.15).
double weyl_cutoff(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions, double n);

}  // namespace elastogear::reduction
