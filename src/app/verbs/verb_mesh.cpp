// elastogear mesh: gear data -> volume mesh.

#include <numbers>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/options/rows.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::app {
namespace {

using gear::Design, gear::WormCounts, gear::WheelCounts;

constexpr double kDegree = std::numbers::pi / 180;

const Rows<Design> kDesign = {
    {"part", "-", "", "worm or wheel"},
    {"size", "-", "tiny", "tiny, small, medium or paper; the counts below refine it"},
    {"mesh", "-", "", "mesh file to write, Gmsh 4.1 .msh or Abaqus .inp"},
    {"z1", &Design::z1, "-", "starts of the worm", kPositive},
    {"z2", &Design::z2, "-", "teeth of the wheel", kPositive},
    {"pressure_angle", "deg", default_text(Design{}.alpha_n / kDegree), "normal pressure angle",
     [](const Options& options, const std::string& name, Design& design) {
       if (options.given(name)) design.alpha_n = options.number(name) * kDegree;
     }},
    {"module", &Design::m_n, "m", "normal module"},
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
// The default counts are those of the size.
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
};

void print_toothing(const gear::Geometry& g, const gear::Toothing& t) {
  const auto mm = [](double diameter) { return with_unit(2e3 * diameter, "mm"); };
  print_item("pitch / tip / root diameter", mm(t.r) + " / " + mm(t.r_a) + " / " + mm(t.r_f));
  print_item("lead angle", with_unit(g.gamma / kDegree, "deg"));
  print_item("contact ratio", with_unit(g.epsilon, ""));
  print_item("normal backlash", with_unit(1e3 * g.j_n, "mm"));
}

void print_mesh(const mesh::Mesh& mesh) {
  const mesh::Quality quality = mesh::quality(mesh);
  print_item("nodes", std::to_string(mesh.n_nodes()));
  print_item("elements", std::to_string(mesh.cells.size()));
  print_item("contact faces", std::to_string(mesh::face_set(mesh, "flanks").size()));
  print_item("smallest scaled Jacobian", with_unit(quality.min_scaled_jacobian, ""));
  print_item("mean scaled Jacobian", with_unit(quality.mean_scaled_jacobian, ""));
}

template <class Counts>
Counts refined(Counts counts, const Rows<Counts>& rows, const Options& options) {
  read_rows(options, rows, counts);
  return counts;
}

void run_mesh(const Options& options, const std::vector<std::string>&) {
  options.reject_unknown();
  const bool is_worm = options.choice("part", {"worm", "wheel"}) == 0;
  const std::string path = options.text("mesh");
  protect_inputs(options, {{"mesh", {path}}});
  const OutputLock lock(path);
  Design d;
  read_rows(options, kDesign, d);
  const gear::Size size = gear::size(options.text("size"));
  const gear::Geometry geometry = gear::derive(d);
  const mesh::Mesh mesh = is_worm
                              ? gear::worm_mesh(d, refined(gear::worm_counts(size), kWormCounts, options))
                              : gear::wheel_mesh(d, refined(gear::wheel_counts(size), kWheelCounts, options));
  print_toothing(geometry, is_worm ? geometry.worm : geometry.wheel);
  print_mesh(mesh);
  mesh::write_mesh(path, mesh);
  print_item("written", path);
}

}  // namespace

Verb mesh_verb() {
  return {"mesh", "mesh gear.yaml [-option value ...]",
          "gear data -> hexahedral mesh of the worm or the wheel",
          table_of(kDesign, kWormCounts, kWheelCounts), run_mesh};
}

}  // namespace elastogear::app
