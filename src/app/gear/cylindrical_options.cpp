#include "app/gear/cylindrical_options.h"

#include <cmath>
#include <numbers>

#include "app/console/console.h"
#include "app/gear/drive_options.h"
#include "app/input/length_unit.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/own_mesh.h"
#include "elastogear/mesh/file.h"

namespace elastogear::app {
namespace {

using gear::CylindricalDrive, gear::CylindricalGear, gear::CylindricalGeometry;

constexpr double kRadPerDegree = std::numbers::pi / 180;

struct Choices {
  std::string rack = "A";
  double helix_angle = 0, transverse_module = 0, axial_module = 0;
  double addendum = 0, dedendum = 0, fillet = 0;
  double protuberance = 0, protuberance_angle = -1;
};

const Rows<Choices> kRackRows = {
    {"helix_angle", &Choices::helix_angle, "deg",
     "cylindrical: helix angle of the first gear at its pitch cylinder, > 0 right-handed; mates alternate"},
    {"transverse_module", &Choices::transverse_module, "m", "cylindrical: in place of module", kDependent},
    {"axial_module", &Choices::axial_module, "m", "cylindrical: in place of module", kDependent},
    {"rack", &Choices::rack, "-", "cylindrical: basic rack of ISO 53: A, B, C or D"},
    {"rack_addendum", &Choices::addendum, "-",
     "cylindrical: addendum of the basic rack, in modules (default: its own)", kDependent | kPositive},
    {"rack_dedendum", &Choices::dedendum, "-",
     "cylindrical: dedendum of the basic rack, in modules (default: its own)", kDependent | kPositive},
    {"rack_fillet", &Choices::fillet, "-",
     "cylindrical: root fillet radius of the basic rack, in modules (default: its own)",
     kDependent | kPositive},
    {"rack_protuberance", &Choices::protuberance, "-",
     "cylindrical: by which the tip of the tool of external gears stands out beyond the finished flanks, "
     "along "
     "their normal, in modules"},
    {"rack_protuberance_angle", &Choices::protuberance_angle, "deg",
     "cylindrical: pressure angle of the tool there (default: half the pressure angle)", kDependent},
};

// Lengths of the gear's body; a diameter that is not given is chosen.
struct GearChoices {
  CylindricalGear gear;
  std::vector<std::string> mate;
  double tip_diameter = 0, centre_distance = 0, direction = 0;
};

template <class Member>
auto of_blank(Member member) {
  return [=](auto& s) -> auto& { return s.gear.blank.*member; };
}

template <class Member>
auto of_cutter(Member member) {
  return [=](auto& s) -> auto& { return s.gear.cutter.*member; };
}

const Rows<GearChoices> kGearRows = {
    {"<gear>_teeth", in(&GearChoices::gear, &CylindricalGear::z), "-", "number of teeth", kDependent},
    {"<gear>_profile_shift", in(&GearChoices::gear, &CylindricalGear::x), "-",
     "cylindrical: profile shift coefficient x, in modules"},
    {"<gear>_internal", in(&GearChoices::gear, &CylindricalGear::internal), "-",
     "cylindrical: whether the teeth stand inwards, in a ring that is held at its outside"},
    {"<gear>_cutter_teeth", of_cutter(&gear::PinionCutter::z_0), "-",
     "cylindrical: of the pinion-type cutter of an internal gear (default: near 25, where it spares the "
     "flanks)",
     kDependent | kPositive},
    {"<gear>_cutter_tip_radius", of_cutter(&gear::PinionCutter::rho_a0), "-",
     "cylindrical: of that cutter, in modules (default: the basic rack's fillet radius, or less where it "
     "does not "
     "fit)",
     kDependent | kPositive},
    {"<gear>_tip_diameter", &GearChoices::tip_diameter, "m",
     "cylindrical: (default: the basic rack's, less what keeps 0.2 modules to the mates' roots and, of "
     "internal "
     "pairs, spares their fillets and tips)",
     kDependent},
    {"<gear>_face_width", of_blank(&gear::Blank::face_width), "m",
     "cylindrical: (default: option face_width)", kDependent},
    {"<gear>_bore", of_blank(&gear::Blank::bore), "m",
     "cylindrical: diameter of the bore, which is held (default: 0.4 root diameters)", kDependent},
    {"<gear>_outer_diameter", of_blank(&gear::Blank::outer_diameter), "m",
     "cylindrical: of the body of an internal gear, which is held there (default: 3 modules around the root)",
     kDependent},
    {"<gear>_rim_diameter", of_blank(&gear::Blank::rim_diameter), "m",
     "cylindrical: inner diameter of the rim, of internal gears the outer one; a cell set of its own "
     "(default: 2.5 "
     "modules off the root)",
     kDependent},
    {"<gear>_hub_diameter", of_blank(&gear::Blank::hub_diameter), "m",
     "cylindrical: of a gear with a web: outer diameter of the hub", kDependent},
    {"<gear>_hub_width", of_blank(&gear::Blank::hub_width), "m", "cylindrical: (default: the face width)",
     kDependent},
    {"<gear>_web_diameter", of_blank(&gear::Blank::web_diameter), "m",
     "cylindrical: outer diameter of the web, inner of the ring", kDependent},
    {"<gear>_web_width", of_blank(&gear::Blank::web_width), "m", "cylindrical: width of the web", kDependent},
    {"<gear>_mesh", "-", "",
     "cylindrical: mesh of your own, .msh or .inp, with z as its axis, whose flanks are those of the data; "
     "it is "
     "moved along z and turned into place, and flanks, roots and the bore are found"},
    {"<gear>_unit", "-", "", "cylindrical: unit of length of that file, m, mm, um or in (default: unit)"},
    {"<gear>_mate", &GearChoices::mate, "-",
     "cylindrical: an earlier gear that this one is in mesh with (default: the one before), or several, "
     "planets",
     kDependent},
    {"<gear>_centre_distance", &GearChoices::centre_distance, "m",
     "cylindrical: to its mate (default: option centre_distance, or what the profile shifts give)",
     kDependent},
    {"<gear>_direction", &GearChoices::direction, "deg",
     "cylindrical: of the line from its mate's axis to its own, from world +X (default: 0; an internal gear "
     "around a "
     "planet has the sun's axis, around the first gear it is 180)",
     kDependent},
};

gear::BasicRack basic_rack(const Options& options, const Choices& c) {
  gear::BasicRack rack = gear::basic_rack(c.rack);
  if (options.given("pressure_angle")) rack.alpha_n = options.number("pressure_angle") * kRadPerDegree;
  if (c.addendum > 0) rack.h_aP = c.addendum;
  if (c.dedendum > 0) rack.h_fP = c.dedendum;
  if (c.fillet > 0) rack.rho_fP = c.fillet;
  rack.pr = c.protuberance;
  if (options.given("rack_protuberance_angle")) {
    rack.alpha_pr = c.protuberance_angle * kRadPerDegree;
    require(rack.alpha_pr >= 0, options.label("rack_protuberance_angle"), " = ", c.protuberance_angle,
            " deg: must be at least 0");
  }
  return rack;
}

double normal_module(const Options& options, const Choices& c) {
  const int n = options.given("module") + options.given("transverse_module") + options.given("axial_module");
  require(n == 1, n == 0 ? "option -module is missing: normal module, as in 'module: 3 mm'"
                         : "options -module, -transverse_module and -axial_module: give one of them");
  if (options.given("module")) return options.positive("module");
  const double beta = c.helix_angle * kRadPerDegree;
  if (options.given("transverse_module")) return c.transverse_module * std::cos(beta);
  require(beta != 0, "option -axial_module: spur gears have none, give -module");
  return c.axial_module * std::abs(std::sin(beta));
}

GearChoices gear_choices(const Options& options, const std::string& name) {
  GearChoices g;
  if (options.given("face_width")) g.gear.blank.face_width = options.positive("face_width");
  read_rows(options, kGearRows, g, name);
  require(g.gear.z > 0, "option -", name, "_teeth is missing: number of teeth, as in '", name,
          ": {teeth: 17}'");
  require(g.gear.blank.face_width > 0,
          "option -face_width is missing: width of the teeth, as in 'face_width: 25 mm'");
  g.gear.name = name;
  g.gear.r_a = g.tip_diameter / 2;
  return g;
}

// The pair through which a gear has its place; nothing for the first gear.
const gear::GearPair* placing(const CylindricalDrive& d, int gear) {
  for (const gear::GearPair& pair : d.pairs)
    if (pair.second == gear) return &pair;
  return nullptr;
}

// An internal gear without a place stands around the sun of its planet, or so that the pitch point lies where
// it does for external mates.
void place_ring(const Options& options, gear::GearPair& pair, const CylindricalDrive& d) {
  const std::string& name = d.gears.back().name;
  if (!d.gears.back().internal || options.given(name + "_direction")) return;
  const gear::GearPair* of_planet = placing(d, pair.first);
  pair.direction = std::numbers::pi + (of_planet ? of_planet->direction : 0);
  if (of_planet && pair.a == 0) pair.coaxial = of_planet->first;
}

// The first gear stands at the origin.
void refuse_place(const Options& options, const std::string& first) {
  for (const char* key : {"_mate", "_centre_distance", "_direction"})
    require(!options.given(first + key), options.label(first + key), ": places nothing: ", first,
            " is the first gear, and its mates are placed against it; give it of one of them");
}

// The pairs of the last gear with earlier ones, of which the first gives it its place.
void add_pairs(const Options& options, const GearChoices& g, CylindricalDrive& d) {
  const int second = static_cast<int>(d.gears.size()) - 1;
  const std::string& name = g.gear.name;
  const auto earlier = [&](const std::string& mate) {
    for (int i = 0; i < second; ++i)
      if (d.gears[i].name == mate) return i;
    fail(options.label(name + "_mate"), " = '", mate, "': must be a gear named before in option -gears");
  };
  gear::GearPair pair{.first = g.mate.empty() ? second - 1 : earlier(g.mate[0]),
                      .second = second,
                      .a = g.centre_distance,
                      .direction = g.direction * kRadPerDegree};
  if (options.given("centre_distance") && second == 1 && pair.a == 0)
    pair.a = options.positive("centre_distance");
  place_ring(options, pair, d);
  d.pairs.push_back(pair);
  for (std::size_t i = 1; i < g.mate.size(); ++i)
    d.pairs.push_back({.first = earlier(g.mate[i]), .second = second});
}

CylindricalDrive cylindrical_design(const Options& options) {
  Choices c;
  read_rows(options, kRackRows, c);
  CylindricalDrive d;
  d.m_n = normal_module(options, c);
  d.beta = c.helix_angle * kRadPerDegree;
  d.rack = basic_rack(options, c);
  if (options.given("backlash")) {
    d.j_n = options.number("backlash");
    require(d.j_n >= 0, options.label("backlash"), " = ", d.j_n, " m: must be at least 0");
  }
  for (const std::string& name : options.list("gears")) {
    const GearChoices g = gear_choices(options, name);
    d.gears.push_back(g.gear);
    d.gears.size() > 1 ? add_pairs(options, g, d) : refuse_place(options, name);
  }
  return d;
}

mesh::Mesh read_own_mesh(const Options& options, const std::string& file, const gear::OwnGear& gear,
                         mesh::ReadReport& report) {
  mesh::Mesh mesh = mesh::read_mesh(file, unit_in_m(options, gear.name), &report);
  const gear::MeshFit fit = [&] {
    try {
      return gear::fit_own_mesh(mesh, gear);
    } catch (const Error& error) {
      fail(options.label(gear.name + "_mesh"), " = '", file, "': ", error.what());
    }
  }();
  print_item("mesh of " + gear.name, file + ", moved by " + in_mm(fit.shift) +
                                         " along its axis and turned by " +
                                         with_unit(fit.turn / kRadPerDegree, "deg") +
                                         " into place; corners of its flanks are within " +
                                         in_mm(fit.farthest) + " of those of the data, and put onto them");
  return mesh;
}

// The member's mesh is its user's.
void take_own_mesh(const Options& options, const std::string& file, double end_diameter,
                   DriveMember& member) {
  const std::string& name = member.name;
  const bool names_held = options.given(name + "_restrain") || options.given("restrain");
  const gear::OwnGear gear{name, member.toothing, member.width, names_held ? "" : member.held,
                           end_diameter / 2};
  member.mesh = [=](const MeshDensity&, mesh::ReadReport& report) {
    return read_own_mesh(options, file, gear, report);
  };
}

}  // namespace

OptionTable cylindrical_table() { return table_of(kRackRows, kGearRows); }

Drive cylindrical_drive(const Options& options, const drive::Start& start) {
  const CylindricalDrive d = cylindrical_design(options);
  const CylindricalGeometry g = gear::derive(d);
  Drive drive{drive::cylindrical_drive(d, g, start), drive::facts(d, g)};
  for (std::size_t i = 0; i < d.gears.size(); ++i) {
    DriveMember& member = drive.members[i];
    if (const std::string file = own_mesh(options, member.name); !file.empty())
      take_own_mesh(options, file, g.blank[i].end_diameter(), member);
  }
  return drive;
}

}  // namespace elastogear::app
