#include "elastogear/gear/wheel.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "gear/gear_mesh.h"
#include "gear/second_order.h"
#include "gear/worm/hobbed_wheel.h"
#include "gear/worm/profiles.h"

namespace elastogear::gear {
namespace {

// Counts of a mesh of 8-node hexahedra.
WheelCounts equal_counts(Size size) {
  switch (size) {
    case Size::tiny:
      return {};
    case Size::small:
      return {.tooth = 4,
              .space = 2,
              .flank = 4,
              .fillet = 2,
              .rim = 2,
              .ring = 2,
              .web = 3,
              .hub = 2,
              .web_layers = 4,
              .face_layers = 2,
              .hub_layers = 1};
    case Size::medium:
      return {.tooth = 6,
              .space = 3,
              .flank = 6,
              .fillet = 3,
              .rim = 3,
              .ring = 2,
              .web = 6,
              .hub = 3,
              .web_layers = 6,
              .face_layers = 3,
              .hub_layers = 1};
    case Size::paper:
      return {.tooth = 8,
              .space = 5,
              .flank = 9,
              .fillet = 4,
              .rim = 8,
              .ring = 6,
              .web = 14,
              .hub = 6,
              .web_layers = 8,
              .face_layers = 4,
              .hub_layers = 3};
  }
  fail("unknown mesh size ", static_cast<int>(size));
}

// Counts of a mesh of 20-node hexahedra, which below the fillet are as deep as they are long and grow
// inwards. Rows of hub, web and ring get thinner towards the corners of the web, which have no fillets, for
// the frequencies.
WheelCounts graded_counts(Size size) {
  WheelCounts n{.tooth = 4,
                .space = 2,
                .flank = 3,
                .fillet = 2,
                .rim = 4,
                .ring = 2,
                .web = 5,
                .hub = 3,
                .web_layers = 4,
                .face_layers = 2,
                .order = 2,
                .growth = 3,
                .tooth_growth = 4,
                .web_growth = 3};
  if (size == Size::tiny) {
    n.space = n.ring = n.web = n.hub = n.face_layers = 1;
    n.flank = n.rim = n.web_layers = 2;
    n.growth = 4;
  }
  if (size >= Size::medium) {
    n.tooth = 6;
    n.tooth_growth = 3;
  }
  if (size == Size::paper) {
    n.space = n.face_layers = 3;
    n.fillet = 4;
    n.web_layers = 6;
    n.hub = 2;
    n.growth = 2;
  }
  return n;
}

}  // namespace

WheelCounts wheel_counts(Size size, int order) {
  check_order("wheel", order);
  return order == 2 ? graded_counts(size) : equal_counts(size);
}

WheelCounts refined(WheelCounts n, double times) {
  if (times == 1) return n;
  const double behind = std::sqrt(times);
  n.tooth = 2 * refined(n.tooth / 2, times);
  for (int* count : {&n.space, &n.flank, &n.fillet, &n.rim}) *count = refined(*count, times);
  for (int* count : {&n.ring, &n.web, &n.hub, &n.web_layers, &n.face_layers, &n.hub_layers})
    *count = refined(*count, behind);
  for (double* growth : {&n.growth, &n.tooth_growth}) *growth = refined_growth(*growth, times);
  n.web_growth = refined_growth(n.web_growth, behind);
  return n;
}

namespace {

// Seen from the other side, a left-handed wheel is a right-handed one.
mesh::Mesh hobbed_mesh(const Design& design, const Geometry& geometry, const WheelCounts& counts) {
  Geometry right = geometry;
  right.wheel.p = std::abs(right.wheel.p);
  const Hob tool = hob(design, right);
  const double side = design.hand == Hand::left ? -1 : 1, end = design.face_width / 2;
  const auto profile = [&](double z) {
    return hobbed_profile(tool, design.z2, design.rim_diameter / 2, side * std::clamp(z, -end, end));
  };
  return gear_mesh("wheel", geometry.wheel, profile, wheel_blank(design), counts);
}

}  // namespace

mesh::Mesh wheel_mesh(const Design& design, const WheelCounts& counts) {
  const Geometry geometry = derive(design);
  if (design.wheel_form != WheelForm::helical) return hobbed_mesh(design, geometry, counts);
  const Profile profile =
      generated_profile(wheel_rack(design, geometry), geometry.wheel, design.rim_diameter / 2);
  return gear_mesh("wheel", geometry.wheel, profile, wheel_blank(design), counts);
}

}  // namespace elastogear::gear
