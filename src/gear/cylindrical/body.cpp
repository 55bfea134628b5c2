#include <algorithm>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"

namespace elastogear::gear {
namespace {

constexpr double kBore = 0.4;                // root diameters
constexpr double kBody = 3, kLeastBody = 1;  // modules around the root of an internal gear
constexpr double kRim = 2.5, kLeastRim = 1;  // modules, of a rim without a choice, and of any

Blank completed_around(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t) {
  Blank b = gear.blank;
  const double root = 2 * t.r_f, least = root + 2 * kLeastBody * d.m_n;
  require(
      b.bore == 0 && b.hub_diameter == 0 && b.hub_width == 0 && b.web_diameter == 0 && b.web_width == 0,
      gear.name,
      ": an internal gear has neither bore nor hub nor web; outer_diameter and rim_diameter are its body's");
  if (b.outer_diameter == 0) b.outer_diameter = root + 2 * kBody * d.m_n;
  require(b.outer_diameter >= least, gear.name, ": outer_diameter = ", mm(b.outer_diameter),
          " mm: must be at least ", mm(least), " mm, a module beyond the root diameter ", mm(root),
          " mm on each side");
  if (b.rim_diameter == 0) {
    b.rim_diameter = root + 2 * kRim * d.m_n;
    if (b.rim_diameter > b.outer_diameter - kRim * d.m_n) b.rim_diameter = b.outer_diameter;
  }
  require(b.rim_diameter >= root + 2 * kLeastRim * d.m_n && b.rim_diameter <= b.outer_diameter, gear.name,
          ": rim_diameter = ", mm(b.rim_diameter), " mm: must be between ", mm(root + 2 * kLeastRim * d.m_n),
          " mm and outer_diameter, ", mm(b.outer_diameter), " mm");
  return b;
}

}  // namespace

Blank completed(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t) {
  if (gear.internal) return completed_around(d, gear, t);
  Blank b = gear.blank;
  require(b.outer_diameter == 0, gear.name, ": outer_diameter = ", mm(b.outer_diameter),
          " mm: only internal gears have one; tip_diameter is that of the teeth");
  const double root = 2 * t.r_f, most = root - 2 * kLeastRim * d.m_n;
  if (b.bore == 0) b.bore = std::min(kBore * root, most);
  if (b.rim_diameter == 0) {
    b.rim_diameter = root - 2 * kRim * d.m_n;
    if (b.rim_diameter < b.bore + kRim * d.m_n) b.rim_diameter = b.bore;
    if (b.has_web()) b.rim_diameter = std::max(b.rim_diameter, b.web_diameter + kLeastRim * d.m_n);
  }
  require(b.bore > 0 && b.bore <= most, gear.name, ": bore = ", mm(b.bore),
          " mm: must be positive and at most ", mm(most), " mm, a module below the root diameter ", mm(root),
          " mm on each side");
  require(b.rim_diameter >= b.bore && b.rim_diameter <= most, gear.name,
          ": rim_diameter = ", mm(b.rim_diameter), " mm: must be between the bore, ", mm(b.bore), " mm, and ",
          mm(most), " mm");
  require(b.has_web() || (b.web_diameter == 0 && b.web_width == 0 && b.hub_width == 0), gear.name,
          ": web_diameter = ", mm(b.web_diameter), " mm, web_width = ", mm(b.web_width),
          " mm, hub_width = ", mm(b.hub_width), " mm: a web and its hub need hub_diameter, too");
  if (!b.has_web()) return b;
  require(b.bore < b.hub_diameter && b.hub_diameter < b.web_diameter && b.web_diameter < b.rim_diameter,
          gear.name, ": bore ", mm(b.bore), ", hub_diameter ", mm(b.hub_diameter), ", web_diameter ",
          mm(b.web_diameter), " and rim_diameter ", mm(b.rim_diameter), " mm must increase in this order");
  if (b.hub_width == 0) b.hub_width = b.face_width;
  require(b.web_width > 0 && b.web_width <= std::min(b.hub_width, b.face_width), gear.name,
          ": web_width = ", mm(b.web_width), " mm: must be positive, at most hub_width ", mm(b.hub_width),
          " mm and face_width ", mm(b.face_width), " mm");
  return b;
}

}  // namespace elastogear::gear
