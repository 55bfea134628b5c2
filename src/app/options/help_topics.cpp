#include "app/options/help_topics.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace elastogear::app {
namespace {

struct Topic {
  const char* title;
  bool first;                      // is one of first need
  std::vector<const char*> names;  // of options; * at an end stands for anything
};

constexpr const char* kOthers = "other options";

// An option belongs to the first topic that names it.
const std::vector<Topic> kTopics = {
    {"the drive",
     true,
     {"drive",
      "gears",
      "module",
      "<gear>_teeth",
      "<gear>_profile_shift",
      "helix_angle",
      "face_width",
      "centre_distance",
      "pressure_angle",
      "<gear>_internal",
      "<gear>_mate",
      "<gear>_direction",
      "<gear>_face_width",
      "<gear>_bore",
      "backlash",
      "diameter_quotient",
      "worm_starts",
      "hand",
      "<gear>_mesh",
      "<gear>_unit"}},
    {"micro-geometry, misalignment and bearings",
     true,
     {"<gear>_profile_crowning", "<gear>_lead_crowning", "<gear>_tip_relief", "<gear>_end_relief",
      "<gear>_helix_slope", "<gear>_radial_offset", "<gear>_bearing_radial"}},
    {"material",
     true,
     {"material_E", "material_nu", "material_rho", "material_prony", "material_temperature"}},
    {"the load and the motion",
     true,
     {"torque", "side", "speed", "roll", "analysis", "ts_max_time", "contact_friction", "torques",
      "sweep_positions", "sweep_pitches"}},
    {"accuracy and results",
     true,
     {"accuracy", "report", "size", "element_order", "refinement", "modes", "output", "output_every",
      "result", "fields", "verbose"}},
    {"a body's mesh, and how it is held",
     true,
     {"mesh", "unit", "restrain", "surface", "stress_nodes", "markers"}},
    {"a system of bodies",
     true,
     {"bodies", "<body>_file", "<body>_joint", "<body>_position", "<body>_rotation", "<body>_velocity0",
      "<body>_omega0", "<body>_torque", "contact_pairs", "<body>_points", "loads", "<load>_marker",
      "<load>_force", "<load>_torque"}},
    {"life and wear", true, {"duty_cycle", "sn_*", "revolutions", "coefficient", "limit"}},
    {"two results beside each other", true, {"match", "at", "reference_at", "csv"}},
    {"racks, cutters and tips",
     false,
     {"rack", "transverse_module", "axial_module", "rack_*", "<gear>_cutter_*", "<gear>_tip_diameter"}},
    {"gear bodies",
     false,
     {"<gear>_outer_diameter", "<gear>_rim_*", "<gear>_hub_*", "<gear>_web_*", "<gear>_centre_distance",
      "hub_*", "web_*", "rim_*", "wheel_bore"}},
    {"worms and their wheels",
     false,
     {"z1", "z2", "worm_*", "wheel_form", "wheel_outside_diameter", "hob_oversize", "wheel_profile_shift",
      "addendum", "dedendum", "wheel_rack_tip", "thread_length", "seat_*", "shaft_*", "shoulder", "wheel_*"}},
    {"flank modifications and deviations",
     false,
     {"<gear>_left_*", "<gear>_right_*", "<gear>_*_relief*", "<gear>_profile_slope", "<gear>_twist",
      "<gear>_pitch_deviation", "<gear>_run_out*", "<gear>_topography", "<gear>_wear"}},
    {"misalignment and bearings",
     false,
     {"<gear>_axial_offset", "<gear>_tangential_offset", "<gear>_inclination", "<gear>_skew",
      "<gear>_bearing*", "bearing_catalogue", "<bearing>_*"}},
    {"files of a drive", false, {"drawing", "part", "<gear>_file", "<gear>_mesh_output"}},
    {"materials", false, {"material_*"}},
    {"finite elements and their files",
     false,
     {"instance", "element", "element_mass", "restrain_nodes", "stiffness", "mass", "matrix_format", "dofs",
      "nodes", "frame", "point_mass_<set>"}},
    {"reduction",
     false,
     {"basis", "loaded", "window", "store", "precision", "invariants", "symmetry", "completeness",
      "stress_recovery", "marker_weights", "relaxed_states", "rise_time", "highest_frequency", "mode_error",
      "interface_modes", "krylov_shift", "damping_*"}},
    {"contact", false, {"contact_*"}},
    {"loads, bushings and sensors",
     false,
     {"gravity", "<load>_*", "bushings", "<bushing>_*", "sensors_<sensor>", "sensor_csv", "<body>_points"}},
    {"bodies and joints", false, {"<body>_*", "moduli", "inertia"}},
    {"steps, outputs and restart",
     false,
     {"static_steps", "time_under_load", "rest_tolerance", "ts_*", "step_*", "velocity_tolerance", "output_*",
      "initial_*", "checkpoint_every", "resume"}},
    {"variants", false, {"variants", "variant_<variant>", "variant"}},
    {"fatigue",
     false,
     {"files", "file_torques", "proportional", "damage_field", "survival", "mean_stress*", "tensile_strength",
      "<gear>_sn_*", "<gear>_survival", "<gear>_mean_stress*", "<gear>_tensile_strength"}},
    {"wear",
     false,
     {"increment", "cells_*", "most_sweeps", "density", "<gear>_coefficient", "<gear>_density"}},
    {"evaluation and stresses",
     false,
     {"coarser", "unloaded", "from", "to", "root_stress", "case_tables", "mode_acceleration",
      "error_estimate", "stress_<body>", "field_*", "box_*", "node_<body>", "match_tolerance"}},
};

bool fits(const std::string& pattern, const std::string& name) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return pattern == name;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  const std::string tail = pattern.substr(star + 1);
  for (std::size_t at = star; at <= name.size(); ++at)
    if (fits(tail, name.substr(at))) return true;
  return false;
}

const Topic* find_topic(const std::string& option) {
  for (const Topic& topic : kTopics)
    if (std::any_of(topic.names.begin(), topic.names.end(),
                    [&](const char* name) { return fits(name, option); }))
      return &topic;
  return nullptr;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_about(const OptionSpec& spec, const Topic* topic, const std::string& about) {
  if (about.empty()) return topic && topic->first;
  if (about == "all") return true;
  const std::string word = lower(about);
  for (const std::string& text : {spec.name, spec.help, std::string(topic ? topic->title : kOthers)})
    if (lower(text).find(word) != std::string::npos) return true;
  return false;
}

// The options of a topic; nullptr: those of none.
std::string under(const OptionTable& table, const Topic* topic, const std::string& about) {
  OptionTable rows;
  for (const OptionSpec& spec : table)
    if (!spec.help.empty() && find_topic(spec.name) == topic && is_about(spec, topic, about))
      rows.push_back(spec);
  if (rows.empty()) return "";
  return std::string(topic ? topic->title : kOthers) + ":\n" + help_text(rows) + "\n";
}

}  // namespace

std::string help_by_topic(const OptionTable& table, const std::string& about) {
  std::string text;
  for (const Topic& topic : kTopics) text += under(table, &topic, about);
  text += under(table, nullptr, about);
  const auto more = std::count_if(table.begin(), table.end(), [&](const OptionSpec& spec) {
    return !spec.help.empty() && !is_about(spec, find_topic(spec.name), about);
  });
  if (about.empty() && more > 0)
    text += std::to_string(more) + " options more: '-help all', or '-help WORD' for those about a word.\n";
  return text;
}

}  // namespace elastogear::app
