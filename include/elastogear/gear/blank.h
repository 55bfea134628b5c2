#pragma once
// The body of a cylindrical gear below its teeth.

namespace elastogear::gear {

/// A disc with a bore, symmetric about z = 0: rim (from its inner diameter to the teeth), ring (down to the
/// web or the bore), and, where there are diameters of them, web and hub. Around the teeth of an internal
/// gear: rim (to its outer diameter) and ring (to that of the body).
struct Blank {
  double face_width = 0;  ///< m, width of ring, rim and teeth
  double bore = 0;        ///< m, diameter
  double outer_diameter =
      0;  ///< m, of the body of an internal gear, which has neither bore nor hub nor web; 0 on others
  double rim_diameter =
      0;  ///< m, diameter of the rim away from the teeth; the bore's or outer one: there is no ring
  double hub_diameter = 0;  ///< m, outer diameter of the hub; 0: neither hub nor web
  double hub_width = 0;     ///< m
  double web_diameter = 0;  ///< m, outer diameter of the web, inner of the ring
  double web_width = 0;     ///< m

  /// m, diameter of the face away from the teeth.
  double end_diameter() const { return outer_diameter > 0 ? outer_diameter : bore; }
  bool has_web() const { return hub_diameter > 0; }
  bool operator==(const Blank&) const = default;
};

}  // namespace elastogear::gear
