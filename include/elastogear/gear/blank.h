#pragma once
// The body of a cylindrical gear below its teeth.

namespace elastogear::gear {

/// A disc with a bore, symmetric about z = 0: rim (from its inner diameter to the teeth), ring (down to the
/// web or the bore), and, where there are diameters of them, web and hub.
struct Blank {
  double face_width = 0;    ///< m, width of ring, rim and teeth
  double bore = 0;          ///< m, diameter
  double rim_diameter = 0;  ///< m, inner diameter of the rim; the bore's: there is no ring
  double hub_diameter = 0;  ///< m, outer diameter of the hub; 0: neither hub nor web
  double hub_width = 0;     ///< m
  double web_diameter = 0;  ///< m, outer diameter of the web, inner of the ring
  double web_width = 0;     ///< m

  bool has_web() const { return hub_diameter > 0; }
};

}  // namespace elastogear::gear
