#pragma once
// Internal pairs that several tests are about.

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "elastogear/gear/cylindrical.h"

namespace elastogear::gear {

constexpr double kRadPerDegree = std::numbers::pi / 180, kMillimetre = 1e-3;

inline CylindricalGear external_gear(const std::string& name, int z, double x, double width) {
  CylindricalGear g;
  g.name = name, g.z = z, g.x = x;
  g.blank.face_width = width;
  return g;
}

inline CylindricalGear internal_gear(const std::string& name, int z, double x, double width) {
  CylindricalGear g = external_gear(name, z, x, width);
  g.internal = true;
  return g;
}

// direction: from the pinion's axis to that of the ring.
inline CylindricalDrive internal_pair(double m_n, double beta, CylindricalGear first, CylindricalGear second,
                                      double direction = 0.7) {
  CylindricalDrive d;
  d.m_n = m_n, d.beta = beta;
  d.gears = {std::move(first), std::move(second)};
  d.pairs = {GearPair{.direction = direction}};
  return d;
}

inline CylindricalDrive spur_ring() {
  return internal_pair(2 * kMillimetre, 0, external_gear("pinion", 21, 0.1, 16 * kMillimetre),
                       internal_gear("ring", 72, -0.2, 16 * kMillimetre));
}

inline CylindricalDrive helical_ring() {
  return internal_pair(3 * kMillimetre, 20 * kRadPerDegree,
                       external_gear("pinion", 18, 0.3, 24 * kMillimetre),
                       internal_gear("ring", 49, -0.1, 24 * kMillimetre));
}

// The ring drives.
inline CylindricalDrive driving_ring() {
  return internal_pair(1.5 * kMillimetre, -12 * kRadPerDegree, internal_gear("ring", 60, 0, 10 * kMillimetre),
                       external_gear("planet", 25, 0.2, 10 * kMillimetre));
}

}  // namespace elastogear::gear
