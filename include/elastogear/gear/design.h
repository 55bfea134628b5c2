#pragma once
// The worm drive: a worm with flanks of one of the forms of ISO 10828 and its wheel, at a shaft angle of 90
// degrees. A helical involute wheel and a ZI worm are crossed helical gears, exactly conjugate in point
// contact. Any other wheel is what the hob leaves: conjugate in line contact where the hob has the shape of
// the worm.
//
// Frames. World: wheel axis +Z through the origin, worm axis +X through (0, a, 0). Wheel frame = world. Worm
// frame: axis z, and worm local (x, y, z) = world (Y, Z, X). At zero angles a wheel tooth (tooth_01) stands
// on +Y, in the middle of a worm space, so that both flanks have the gap jn/2. The pair runs with phi_2 =
// phi_1 z1/z2.

#include "elastogear/gear/blank.h"
#include "elastogear/gear/toothing.h"

namespace elastogear::gear {

/// Flank forms of a worm (ISO 10828). The pressure angle alpha_n is that of the tool, for ZA and ZI that of
/// the normal section at the pitch cylinder.
enum class FlankForm {
  ZA,  ///< straight in the axial section
  ZN,  ///< straight in the normal section through the middle of the space, at the pitch cylinder
  ZI,  ///< involute helicoid
  ZK   ///< made by a cutter with straight cones whose axis is swivelled by the lead angle
};

enum class Hand { right, left };

/// What makes the wheel.
enum class WheelForm {
  helical,      ///< a rack: an involute helical gear, for form ZI alone
  cylindrical,  ///< the hob, on a cylindrical blank
  throated      ///< the hob, on a blank whose tip follows the worm's root up to the outside diameter
};

/// All numbers of the drive; the defaults are the reference design (electric power steering, 20.5 : 1).
struct Design {
  // Toothing, common to worm and wheel
  double m_n = 2.0e-3;                 ///< m, normal module, at the worm's reference cylinder
  double x2 = 0;                       ///< -, profile shift of the wheel, in axial modules
  double alpha_n = 0.261799387799149;  ///< rad, normal pressure angle (15 deg)
  int z1 = 2;                          ///< -, starts of the worm
  int z2 = 41;                         ///< -, teeth of the wheel
  double a = 50.0e-3;                  ///< m, centre distance
  FlankForm flank = FlankForm::ZI;     ///< of the worm
  double cutter_diameter = 0;          ///< m, of form ZK, where it reaches the root; 0: 40 modules
  Hand hand = Hand::right;             ///< of worm and wheel
  WheelForm wheel_form = WheelForm::helical;
  double outside_diameter = 0;   ///< m, of a throated wheel; 0: a module above the throat's tip diameter
  double hob_oversize = 0;       ///< m, pitch diameter of the hob over the worm's: > 0 point contact
  double j_n = 0.040e-3;         ///< m, normal backlash, taken half from each body's tooth thickness
  double addendum = 2.0e-3;      ///< m, tip over pitch radius, both bodies
  double dedendum = 2.5e-3;      ///< m, pitch over root radius, both bodies
  double worm_fillet = 0.70e-3;  ///< m, root fillet radius of the worm, axial section
  double wheel_rack_tip =
      0.60e-3;  ///< m, tip radius of the wheel's rack, normal, or of its hob, axial section

  // Worm shaft; z along the axis, the thread's middle at z = 0
  double thread_length = 39.2e-3;  ///< m, between the thread's ends, rounded to whole sections of the mesh
  double worm_bore = 2.5e-3;       ///< m, diameter of the axial bore
  double seat_1_begin = -45.6e-3, seat_1_end = -36.6e-3, seat_1_diameter = 10.0e-3;  ///< m, bearing at -z
  double seat_2_begin = 36.8e-3, seat_2_end = 45.0e-3, seat_2_diameter = 8.0e-3;     ///< m, bearing at +z
  double shaft_1_end = -60.0e-3, shaft_1_diameter = 9.0e-3;  ///< m, stub beyond bearing 1
  double shaft_2_end = 47.0e-3, shaft_2_diameter = 7.0e-3;   ///< m, stub beyond bearing 2
  double shoulder = 0.8e-3;                                  ///< m, length of the cone between two diameters

  // Wheel, symmetric about z = 0: hub (bore to hub diameter), web, ring, rim (from the rim diameter to the
  // teeth)
  double face_width = 16.0e-3;    ///< m, width of ring, rim and teeth
  double wheel_bore = 24.0e-3;    ///< m, diameter
  double hub_diameter = 36.0e-3;  ///< m, outer diameter of the hub
  double hub_width = 22.0e-3;     ///< m
  double web_diameter = 61.0e-3;  ///< m, outer diameter of the web, inner of the ring
  double web_width = 8.0e-3;      ///< m
  double rim_diameter = 70.0e-3;  ///< m, inner diameter of the rim

  bool operator==(const Design&) const = default;
};

/// Radii, angles and lengths that follow from a Design.
struct Geometry {
  double gamma = 0;  ///< rad, lead angle of the worm at its reference cylinder; > 0 for either hand
  double shift = 0;  ///< m, pitch over reference radius of the worm: the wheel's profile shift x2 m_x
  double gamma_w = 0, alpha_w = 0, m_w = 0;  ///< rad, rad, m: lead angle = helix angle of the wheel, normal
                                             ///< pressure angle and module at the pitch cylinders
  double s_n = 0;               ///< m, normal tooth thickness of the worm at its reference cylinder
  double s_n2 = 0;              ///< m, that of the wheel at its pitch cylinder
  double p_bn = 0;              ///< m, normal base pitch, common to both bodies
  double p_x = 0;               ///< m, axial pitch of the worm
  double epsilon = 0;           ///< -, contact ratio
  double j_n = 0;               ///< m, normal backlash
  double ratio = 0;             ///< -, z2/z1
  double cutter_diameter = 0;   ///< m, of form ZK
  double outside_diameter = 0;  ///< m, of the wheel
  double throat_radius = 0;     ///< m, of a throated wheel's tip in its axial section; 0: none
  double hob_swivel = 0;        ///< rad, between the axes of hob and worm
  Toothing worm, wheel;         ///< radii of a throated wheel are those of its middle plane, z = 0
};

/// Solves the lead angle from the centre distance (the smaller of the two solutions) and checks the whole
/// design. Throws Error naming the value and what is allowed for designs that do not exist: no lead angle,
/// undercut, pointed teeth, fillets that do not fit or reach into the path of contact, contact ratio below 1,
/// shafts and rings out of order.
Geometry derive(const Design& design);

/// A design in proportion to its module: tooth heights of the basic rack, six axial pitches of thread, a
/// shaft that steps down from the worm's root to both seats and their stubs, a wheel with hub and web. a:
/// centre distance, m. x2: profile shift of the wheel. Throws Error where there is no lead angle.
Design proportioned(double m_n, double alpha_n, int z1, int z2, double a, double x2 = 0);

/// The wheel's body.
Blank wheel_blank(const Design& design);

}  // namespace elastogear::gear
