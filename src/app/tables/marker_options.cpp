#include "app/tables/marker_options.h"

#include <set>

#include "app/tables/motion.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

constexpr const char* kGround = "ground";

// "BODY.MARKER"
dynamics::MarkerName marker_name(const std::string& option, const std::string& text) {
  const auto dot = text.find('.');
  require(dot != std::string::npos && dot > 0 && dot + 1 < text.size(), "option -", option, " = '", text,
          "': must be BODY.MARKER; every body has the marker ", model::kFrameMarker);
  return {text.substr(0, dot), text.substr(dot + 1)};
}

Eigen::Vector3d vector_or_zero(const Options& options, const std::string& name) {
  return options.given(name) ? options.vector(name) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

bool in_body(const Options& options, const std::string& name) {
  return options.choice(name + "_frame", {"world", "body"}) == 1;
}

dynamics::LoadSetup load(const Options& options, const std::string& name) {
  dynamics::LoadSetup load{name, marker_name(name + "_marker", options.text(name + "_marker"))};
  require(options.given(name + "_force") || options.given(name + "_torque"), "load ", name, ": give -", name,
          "_force or -", name, "_torque");
  load.force = vector_or_zero(options, name + "_force");
  load.torque = vector_or_zero(options, name + "_torque");
  load.follows = in_body(options, name);
  if (options.given(name + "_signal")) load.signal = signal(options, name + "_signal");
  return load;
}

dynamics::BushingSetup bushing(const Options& options, const std::string& name) {
  const std::string option = name + "_markers";
  const std::vector<std::string> ends = options.list(option);
  require(ends.size() == 2, "option -", option, ": must be two, BODY.MARKER or ", kGround);
  dynamics::BushingSetup bushing{name, {}};
  for (int i : {0, 1})
    if (ends[i] != kGround) bushing.marker[i] = marker_name(option, ends[i]);
  bushing.law = {options.vector(name + "_stiffness"), options.vector(name + "_rotational_stiffness"),
                 vector_or_zero(options, name + "_damping"), options.vector(name + "_rotational_damping")};
  bushing.axes = rotation_matrix(options.vector(name + "_axes"));
  bushing.axes_of_first = in_body(options, name);
  return bushing;
}

// name,x,y,z, ...
void add_points(const Options& options, const std::string& option, model::ElasticBody& body) {
  const std::vector<std::string> words = options.list(option);
  require(words.size() % 4 == 0, "option -", option, ": must be a name and x,y,z (m) for each point");
  for (std::size_t i = 0; i < words.size(); i += 4) {
    model::Marker marker{words[i], Eigen::Vector3d::Zero()};
    for (int a = 0; a < 3; ++a) {
      const std::optional<double> value = parse<double>(words[i + 1 + static_cast<std::size_t>(a)]);
      require(value.has_value(), "option -", option, ": '", words[i + 1 + static_cast<std::size_t>(a)],
              "' is not a coordinate of point '", words[i], "'");
      marker.X[a] = *value;
    }
    marker.Phi = model::SparseRows(6, body.n_q());
    body.markers.push_back(marker);
  }
}

}  // namespace

// Options of markers. When two rows fit a key the first counts, so that rows with the longer word at their
// end stand first.
OptionTable marker_table() {
  return {
      {"<body>_points", "m", "", "markers fixed to the body frame: name,x,y,z for each"},
      {"<body>_damping_alpha", "1/s", "", "Rayleigh damping in place of the body file's"},
      {"<body>_damping_beta", "s", "", "Rayleigh damping in place of the body file's"},
      {"<body>_damping_ratio", "-", "",
       "damping ratios of modes in place of the body file's: a number or [table, FILE.csv] (Hz, ratio)"},
      {"loads", "-", "", "names of forces and torques at markers; each has its own <load>_... keys"},
      {"<load>_marker", "-", "", "BODY.MARKER; every body has the marker frame"},
      {"<load>_force", "N", "0,0,0", "force"},
      {"<load>_torque", "N m", "0,0,0", "torque"},
      {"<load>_frame", "-", "world",
       "directions of force and torque: world, or body (they turn with the marker)"},
      {"<load>_signal", "-", "1", "factor: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]"},
      {"bushings", "-", "",
       "names of springs and dampers in six directions; each has its own <bushing>_... keys"},
      {"<bushing>_markers", "-", "", "the two ends: BODY.MARKER or ground; unloaded at the start"},
      {"<bushing>_rotational_stiffness", "N m/rad", "0,0,0", "tilt about x and y, turn about z"},
      {"<bushing>_rotational_damping", "N m s/rad", "0,0,0", "about its axes"},
      {"<bushing>_stiffness", "N/m", "", "along its axes x,y,z, which turn with the first marker"},
      {"<bushing>_damping", "N s/m", "0,0,0", "along its axes"},
      {"<bushing>_axes", "rad", "0,0,0",
       "rotation vector that turns x,y,z into its axes; z is the one about which it may turn all the way"},
      {"<bushing>_frame", "-", "world", "which x,y,z at the start: world, or body (of the first marker)"},
      {"sensors_<sensor>", "-", "", "BODY.MARKER whose motion is written as this sensor's"},
  };
}

PlaceholderValues simulate_names(const Options& options) {
  const PlaceholderValues names = {{"body", options.list_with_files("bodies")},
                                   {"load", options.list_with_files("loads")},
                                   {"bushing", options.list_with_files("bushings")}};
  std::set<std::string> all;
  for (const auto& [kind, values] : names)
    for (const std::string& name : values)
      require(all.insert(name).second, "option -", kind == "body" ? "bodies" : kind + "s", ": the name '",
              name, "' is taken, bodies, loads and bushings need different ones");
  return names;
}

dynamics::MarkerSetups marker_setups(const Options& options) {
  dynamics::MarkerSetups setups;
  for (const std::string& name : options.list("loads")) setups.loads.push_back(load(options, name));
  for (const std::string& name : options.list("bushings")) setups.bushings.push_back(bushing(options, name));
  for (const std::string& name : options.placeholder_values("sensors_<sensor>")) {
    const std::string option = "sensors_" + name;
    setups.sensors.push_back({name, marker_name(option, options.text(option))});
  }
  return setups;
}

void change_body(const Options& options, const std::string& prefix, model::ElasticBody& body) {
  const auto given = [&](const char* name) { return options.given(prefix + name); };
  if (!given("points") && !given("damping_alpha") && !given("damping_beta") && !given("damping_ratio"))
    return;
  add_points(options, prefix + "points", body);
  if (options.given(prefix + "damping_alpha")) body.alpha = options.number(prefix + "damping_alpha");
  if (options.given(prefix + "damping_beta")) body.beta = options.number(prefix + "damping_beta");
  if (options.given(prefix + "damping_ratio")) {
    require(body.basis == model::Basis::modal, "option -", prefix,
            "damping_ratio: ratios belong to modes; the full basis takes -", prefix,
            "damping_alpha and _beta");
    body.zeta = model::ratios_at(damping_ratio(options, prefix + "damping_ratio"), body.frequency);
  }
  model::validate(body, "options -" + prefix + "...");
}

}  // namespace elastogear::app
