// elastogear mesh: gear data -> volume mesh.

#include <cstdio>
#include <numbers>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct LengthOption {
  const char* name;
  double gear::Design::*member;
  const char* help;
};

const LengthOption kLengths[] = {
    {"module", &gear::Design::m_n, "normal module"},
    {"centre_distance", &gear::Design::a, "centre distance; the lead angle follows from it"},
    {"backlash", &gear::Design::j_n, "normal backlash, taken half from each body's tooth thickness"},
    {"addendum", &gear::Design::addendum, "tip over pitch radius, both bodies"},
    {"dedendum", &gear::Design::dedendum, "pitch over root radius, both bodies"},
    {"worm_fillet", &gear::Design::worm_fillet, "root fillet radius of the worm, axial section"},
    {"wheel_rack_tip", &gear::Design::wheel_rack_tip, "tip radius of the rack that generates the wheel"},
    {"thread_length", &gear::Design::thread_length, "worm: length of the thread, centred at z = 0"},
    {"worm_bore", &gear::Design::worm_bore, "worm: diameter of the axial bore"},
    {"seat_1_begin", &gear::Design::seat_1_begin, "worm: bearing seat at -z, begin"},
    {"seat_1_end", &gear::Design::seat_1_end, "worm: bearing seat at -z, end"},
    {"seat_1_diameter", &gear::Design::seat_1_diameter, "worm: diameter of the bearing seat at -z"},
    {"seat_2_begin", &gear::Design::seat_2_begin, "worm: bearing seat at +z, begin"},
    {"seat_2_end", &gear::Design::seat_2_end, "worm: bearing seat at +z, end"},
    {"seat_2_diameter", &gear::Design::seat_2_diameter, "worm: diameter of the bearing seat at +z"},
    {"shaft_1_end", &gear::Design::shaft_1_end, "worm: end of the shaft at -z"},
    {"shaft_1_diameter", &gear::Design::shaft_1_diameter, "worm: diameter of the stub beyond seat 1"},
    {"shaft_2_end", &gear::Design::shaft_2_end, "worm: end of the shaft at +z"},
    {"shaft_2_diameter", &gear::Design::shaft_2_diameter, "worm: diameter of the stub beyond seat 2"},
    {"shoulder", &gear::Design::shoulder, "worm: length of the cone between two diameters"},
    {"face_width", &gear::Design::face_width, "wheel: width of ring, rim and teeth"},
    {"wheel_bore", &gear::Design::wheel_bore, "wheel: diameter of the bore"},
    {"hub_diameter", &gear::Design::hub_diameter, "wheel: outer diameter of the hub"},
    {"hub_width", &gear::Design::hub_width, "wheel: width of the hub"},
    {"web_diameter", &gear::Design::web_diameter, "wheel: outer diameter of the web"},
    {"web_width", &gear::Design::web_width, "wheel: width of the web"},
    {"rim_diameter", &gear::Design::rim_diameter, "wheel: inner diameter of the rim (its own element set)"},
};

template <class Counts>
struct CountOption {
  const char* name;
  int Counts::*member;
  const char* help;
};

const CountOption<gear::WormCounts> kWormCounts[] = {
    {"worm_count_tooth", &gear::WormCounts::tooth, "worm: columns across the tooth, even"},
    {"worm_count_space", &gear::WormCounts::space, "worm: columns across half a space"},
    {"worm_count_flank", &gear::WormCounts::flank, "worm: rows up the flank"},
    {"worm_count_fillet", &gear::WormCounts::fillet, "worm: rows up the tooth's half of the fillet"},
    {"worm_count_ring", &gear::WormCounts::ring, "worm: rows from the bore to the root"},
    {"worm_count_turn", &gear::WormCounts::turn,
     "worm: sections per turn, a multiple of z1 (2 space + tooth)"},
    {"worm_count_shaft", &gear::WormCounts::shaft, "worm: layers of each plain shaft end"},
};
const CountOption<gear::WheelCounts> kWheelCounts[] = {
    {"wheel_count_tooth", &gear::WheelCounts::tooth, "wheel: columns across the tooth, even"},
    {"wheel_count_space", &gear::WheelCounts::space, "wheel: columns across half a space"},
    {"wheel_count_flank", &gear::WheelCounts::flank, "wheel: rows up the flank"},
    {"wheel_count_fillet", &gear::WheelCounts::fillet, "wheel: rows up the tooth's half of the fillet"},
    {"wheel_count_rim", &gear::WheelCounts::rim, "wheel: rows from the rim radius to the root"},
    {"wheel_count_ring", &gear::WheelCounts::ring, "wheel: rows across the ring"},
    {"wheel_count_web", &gear::WheelCounts::web, "wheel: rows across the web"},
    {"wheel_count_hub", &gear::WheelCounts::hub, "wheel: rows across the hub"},
    {"wheel_count_web_layers", &gear::WheelCounts::web_layers, "wheel: axial layers across the web"},
    {"wheel_count_face_layers", &gear::WheelCounts::face_layers,
     "wheel: axial layers of the face beside the web"},
    {"wheel_count_hub_layers", &gear::WheelCounts::hub_layers,
     "wheel: axial layers of the hub beyond the face"},
};

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

OptionTable table() {
  const gear::Design reference;
  OptionTable table = {
      {"part", "-", "", "worm or wheel"},
      {"size", "-", "tiny", "tiny, small, medium or paper; the counts below refine it"},
      {"mesh", "-", "", "mesh file to write, Gmsh 4.1 .msh or Abaqus .inp"},
      {"z1", "-", std::to_string(reference.z1), "starts of the worm"},
      {"z2", "-", std::to_string(reference.z2), "teeth of the wheel"},
      {"pressure_angle", "deg", shortest(reference.alpha_n / kDegree), "normal pressure angle"},
  };
  for (const LengthOption& o : kLengths)
    table.push_back({o.name, "m", shortest(reference.*o.member), o.help});
  for (const auto& o : kWormCounts) table.push_back({o.name, "-", "", o.help});
  for (const auto& o : kWheelCounts) table.push_back({o.name, "-", "", o.help});
  return table;
}

gear::Design design(const Options& options) {
  gear::Design design;
  design.z1 = options.count("z1", 1);
  design.z2 = options.count("z2", 1);
  if (options.given("pressure_angle")) design.alpha_n = options.number("pressure_angle") * kDegree;
  for (const LengthOption& o : kLengths)
    if (options.given(o.name)) design.*o.member = options.number(o.name);
  return design;
}

template <class Counts, std::size_t n>
Counts refined(Counts counts, const CountOption<Counts> (&table)[n], const Options& options) {
  for (const auto& o : table)
    if (options.given(o.name)) counts.*o.member = options.count(o.name, 0);
  return counts;
}

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

void run(const Options& options, const std::vector<std::string>&) {
  options.reject_unknown();
  const bool is_worm = options.choice("part", {"worm", "wheel"}) == 0;
  const std::string path = options.text("mesh");
  protect_inputs(options, {{"mesh", {path}}});
  const OutputLock lock(path);
  const gear::Design d = design(options);
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
          "gear data -> hexahedral mesh of the worm or the wheel", table(), run};
}

}  // namespace elastogear::app
