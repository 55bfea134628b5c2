#include "app/gear/design_options.h"

#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using gear::Design, gear::WormCounts, gear::WheelCounts;

constexpr double kDegree = std::numbers::pi / 180;

const Rows<Design> kDesignRows = {
    {"part", "-", "", "worm or wheel"},
    {"size", "-", "tiny", "tiny, small, medium or paper; the counts below refine it"},
    {"element_order", "-", "2",
     "order of the hexahedra: 1 (8 nodes) or 2 (20 nodes, midside nodes on the exact flanks and fillets)"},
    {"refinement", "-", "1",
     "counts of the size are so many times as large, also 1.5 times; layers, and rows behind the teeth, its "
     "square root"},
    {"mesh", "-", "", "mesh file to write, Gmsh 4.1 .msh or Abaqus .inp"},
    {"z1", &Design::z1, "-", "starts of the worm", kPositive},
    {"z2", &Design::z2, "-", "teeth of the wheel", kPositive},
    {"pressure_angle", "deg", default_text(Design{}.alpha_n / kDegree), "normal pressure angle",
     [](const Options& options, const std::string& name, Design& design) {
       if (options.given(name)) design.alpha_n = options.number(name) * kDegree;
     }},
    {"worm_flank", &Design::flank, one_of("ZA", "ZN", "ZI", "ZK"),
     "worm: flank form of ISO 10828: straight in the axial section, straight in the normal section of the "
     "space, "
     "involute helicoid, or made by a conical cutter"},
    {"worm_cutter_diameter", &Design::cutter_diameter, "m",
     "worm: diameter of the cutter of form ZK, where it reaches the root (default: 40 modules)", kDependent},
    {"hand", &Design::hand, one_of("right", "left"), "hand of worm and wheel"},
    {"wheel_form", &Design::wheel_form, one_of("helical", "cylindrical", "throated"),
     "wheel: an involute helical gear, for worms of form ZI, or made by the hob on a cylindrical or a "
     "throated "
     "blank"},
    {"wheel_outside_diameter", &Design::outside_diameter, "m",
     "wheel: throated: outside diameter (default: a module above the throat's tip diameter)", kDependent},
    {"hob_oversize", &Design::hob_oversize, "m",
     "wheel: pitch diameter of the hob over that of the worm: contact in points, for tolerances"},
    {"module", &Design::m_n, "m", "normal module"},
    {"wheel_profile_shift", &Design::x2, "-", "profile shift of the wheel, in axial modules"},
    {"centre_distance", &Design::a, "m", "centre distance; the lead angle follows from it"},
    {"backlash", &Design::j_n, "m", "normal backlash, taken half from each body's tooth thickness"},
    {"addendum", &Design::addendum, "m", "tip over pitch radius, both bodies"},
    {"dedendum", &Design::dedendum, "m", "pitch over root radius, both bodies"},
    {"worm_fillet", &Design::worm_fillet, "m", "root fillet radius of the worm, axial section"},
    {"wheel_rack_tip", &Design::wheel_rack_tip, "m", "tip radius of the rack that generates the wheel"},
    {"thread_length", &Design::thread_length, "m", "worm: length of the thread, centred at z = 0"},
    {"worm_bore", &Design::worm_bore, "m", "worm: diameter of the axial bore"},
    {"seat_1_begin", &Design::seat_1_begin, "m", "worm: bearing seat at -z, begin"},
    {"seat_1_end", &Design::seat_1_end, "m", "worm: bearing seat at -z, end"},
    {"seat_1_diameter", &Design::seat_1_diameter, "m", "worm: diameter of the bearing seat at -z"},
    {"seat_2_begin", &Design::seat_2_begin, "m", "worm: bearing seat at +z, begin"},
    {"seat_2_end", &Design::seat_2_end, "m", "worm: bearing seat at +z, end"},
    {"seat_2_diameter", &Design::seat_2_diameter, "m", "worm: diameter of the bearing seat at +z"},
    {"shaft_1_end", &Design::shaft_1_end, "m", "worm: end of the shaft at -z"},
    {"shaft_1_diameter", &Design::shaft_1_diameter, "m", "worm: diameter of the stub beyond seat 1"},
    {"shaft_2_end", &Design::shaft_2_end, "m", "worm: end of the shaft at +z"},
    {"shaft_2_diameter", &Design::shaft_2_diameter, "m", "worm: diameter of the stub beyond seat 2"},
    {"shoulder", &Design::shoulder, "m", "worm: length of the cone between two diameters"},
    {"face_width", &Design::face_width, "m", "wheel: width of ring, rim and teeth"},
    {"wheel_bore", &Design::wheel_bore, "m", "wheel: diameter of the bore"},
    {"hub_diameter", &Design::hub_diameter, "m", "wheel: outer diameter of the hub"},
    {"hub_width", &Design::hub_width, "m", "wheel: width of the hub"},
    {"web_diameter", &Design::web_diameter, "m", "wheel: outer diameter of the web"},
    {"web_width", &Design::web_width, "m", "wheel: width of the web"},
    {"rim_diameter", &Design::rim_diameter, "m", "wheel: inner diameter of the rim (its own element set)"},
};

const Rows<WormCounts> kWormCounts = {
    {"worm_count_tooth", &WormCounts::tooth, "-", "worm: columns across the tooth, even", kDependent},
    {"worm_count_space", &WormCounts::space, "-", "worm: columns across half a space", kDependent},
    {"worm_count_flank", &WormCounts::flank, "-", "worm: rows up the flank", kDependent},
    {"worm_count_fillet", &WormCounts::fillet, "-", "worm: rows up the tooth's half of the fillet",
     kDependent},
    {"worm_count_ring", &WormCounts::ring, "-", "worm: rows from the bore to the root", kDependent},
    {"worm_count_turn", &WormCounts::turn, "-", "worm: sections per turn, a multiple of z1 (2 space + tooth)",
     kDependent},
    {"worm_count_shaft", &WormCounts::shaft, "-", "worm: layers of each plain shaft end", kDependent},
    {"worm_growth", &WormCounts::growth, "-",
     "worm: how much thicker each row from the root inwards is than the one before, 1 to 10; 0: nearly equal",
     kDependent},
    {"worm_tooth_growth", &WormCounts::tooth_growth, "-",
     "worm: the same of columns from the flanks to the middle of the tooth", kDependent},
};
const Rows<WheelCounts> kWheelCounts = {
    {"wheel_count_tooth", &WheelCounts::tooth, "-", "wheel: columns across the tooth, even", kDependent},
    {"wheel_count_space", &WheelCounts::space, "-", "wheel: columns across half a space", kDependent},
    {"wheel_count_flank", &WheelCounts::flank, "-", "wheel: rows up the flank", kDependent},
    {"wheel_count_fillet", &WheelCounts::fillet, "-", "wheel: rows up the tooth's half of the fillet",
     kDependent},
    {"wheel_count_rim", &WheelCounts::rim, "-", "wheel: rows from the rim radius to the root", kDependent},
    {"wheel_count_ring", &WheelCounts::ring, "-", "wheel: rows across the ring", kDependent},
    {"wheel_count_web", &WheelCounts::web, "-", "wheel: rows across the web", kDependent},
    {"wheel_count_hub", &WheelCounts::hub, "-", "wheel: rows across the hub", kDependent},
    {"wheel_count_web_layers", &WheelCounts::web_layers, "-", "wheel: axial layers across the web",
     kDependent},
    {"wheel_count_face_layers", &WheelCounts::face_layers, "-",
     "wheel: axial layers of the face beside the web", kDependent},
    {"wheel_count_hub_layers", &WheelCounts::hub_layers, "-",
     "wheel: axial layers of the hub beyond the face", kDependent},
    {"wheel_growth", &WheelCounts::growth, "-",
     "wheel: how much thicker each row from the root inwards is than the one before, 1 to 10; 0: nearly "
     "equal",
     kDependent},
    {"wheel_tooth_growth", &WheelCounts::tooth_growth, "-",
     "wheel: the same of columns from the flanks to the middle of the tooth", kDependent},
    {"wheel_web_growth", &WheelCounts::web_growth, "-",
     "wheel: the same of rows of hub, web and ring away from the corners of the web", kDependent},
};

}  // namespace

const Rows<Design>& design_rows() { return kDesignRows; }

int element_order(const Options& options) { return options.choice("element_order", {"1", "2"}) + 1; }

MeshDensity mesh_density(const Options& options) {
  constexpr double kFinest = 100;  // times the counts of a size, of which no machine holds the mesh
  const double refinement = options.positive("refinement");
  require(refinement <= kFinest, options.label("refinement"), " = ", refinement, ": must be at most ",
          kFinest);
  return {gear::size(options.text("size")), element_order(options), refinement};
}

bool is_worm(const Options& options) { return options.choice("part", {"worm", "wheel"}) == 0; }

const Rows<WormCounts>& worm_count_rows() { return kWormCounts; }
const Rows<WheelCounts>& wheel_count_rows() { return kWheelCounts; }

void refuse_counts(const Options& options) {
  for (const OptionSpec& spec : table_of(kWormCounts, kWheelCounts))
    require(!options.given(spec.name), options.label(spec.name),
            ": counts are for single bodies; a drive's meshes follow from size");
}

}  // namespace elastogear::app
