#include "app/tables/marker_options.h"

#include <algorithm>
#include <set>

#include "app/options/rows.h"
#include "app/tables/motion.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

using Bushing = dynamics::BushingSetup;
using Load = dynamics::LoadSetup;
using dynamics::BushingLaw, model::ElasticBody;

constexpr const char* kGround = "ground";

// "BODY.MARKER"
dynamics::MarkerName marker_name(const std::string& option, const std::string& text) {
  const auto dot = text.find('.');
  require(dot != std::string::npos && dot > 0 && dot + 1 < text.size(), "option -", option, " = '", text,
          "': must be BODY.MARKER; every body has the marker ", model::kFrameMarker);
  return {text.substr(0, dot), text.substr(dot + 1)};
}

void set_ends(const Options& options, const std::string& name, Bushing& bushing) {
  const bool has_ends = !bushing.marker[0].body.empty() || !bushing.marker[1].body.empty();
  if (has_ends && !options.given(name)) return;
  const std::vector<std::string> ends = options.list(name);
  require(ends.size() == 2, "option -", name, ": must be two, BODY.MARKER or ", kGround);
  for (int i : {0, 1})
    bushing.marker[i] = ends[i] == kGround ? dynamics::MarkerName{} : marker_name(name, ends[i]);
}

// name,x,y,z, ...
void add_points(const Options& options, const std::string& option, ElasticBody& body) {
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

// The setup of this name, or null.
template <class Setup>
const Setup* named(const std::vector<Setup>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Setup& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

void set_ratio(const Options& options, const std::string& name, ElasticBody& body) {
  if (!options.given(name)) return;
  const std::string prefix = name.substr(0, name.size() - std::string_view("damping_ratio").size());
  require(body.basis == model::Basis::modal, "option -", name,
          ": ratios belong to modes; the full basis takes -", prefix, "damping_alpha and _beta");
  body.zeta = model::ratios_at(damping_ratio(options, name), body.frequency);
}

const Rows<ElasticBody> kChangeRows = {
    {"<body>_points", "m", "", "markers fixed to the body frame: name,x,y,z for each", add_points},
    {"<body>_damping_alpha", &ElasticBody::alpha, "1/s", "Rayleigh damping in place of the body file's",
     kDependent},
    {"<body>_damping_beta", &ElasticBody::beta, "s", "Rayleigh damping in place of the body file's",
     kDependent},
    {"<body>_damping_ratio", "-", "",
     "damping ratios of modes in place of the body file's: a number or [table, FILE.csv] (Hz, ratio)",
     set_ratio},
};

const Rows<Load> kLoadRows = {
    {"loads", "-", "", "names of forces and torques at markers; each has its own <load>_... keys"},
    {"<load>_marker", "-", "", "BODY.MARKER; every body has the marker frame",
     [](auto& o, auto& name, auto& load) {
       if (load.marker.body.empty() || o.given(name)) load.marker = marker_name(name, o.text(name));
     }},
    {"<load>_force", &Load::force, "N", "force"},
    {"<load>_torque", &Load::torque, "N m", "torque"},
    {"<load>_pressure", &Load::pressure, "Pa",
     "pressure on the face set that the marker is, > 0 against its outward normals; it turns with the body's "
     "frame"},
    {"<load>_frame", &Load::follows, one_of("world", "body"),
     "directions of force and torque: world, or body (they turn with the marker)"},
    {"<load>_signal", "-", "1", "factor: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]",
     [](auto& o, auto& name, auto& load) {
       if (o.given(name)) load.signal = signal(o, name);
     }},
};

// When two rows fit a key the first counts, so that rows with the longer word at their end stand first.
const Rows<Bushing> kBushingRows = {
    {"bushings", "-", "",
     "names of springs and dampers in six directions; each has its own <bushing>_... keys"},
    {"<bushing>_markers", "-", "", "the two ends: BODY.MARKER or ground; unloaded at the start", set_ends},
    {"<bushing>_rotational_stiffness", in(&Bushing::law, &BushingLaw::k_r), "N m/rad",
     "tilt about x and y, turn about z"},
    {"<bushing>_rotational_damping", in(&Bushing::law, &BushingLaw::c_r), "N m s/rad", "about its axes"},
    {"<bushing>_stiffness", in(&Bushing::law, &BushingLaw::k), "N/m",
     "along its axes x,y,z, which turn with the first marker", kRequired},
    {"<bushing>_damping", in(&Bushing::law, &BushingLaw::c), "N s/m", "along its axes"},
    {"<bushing>_axes", "rad", "0,0,0",
     "rotation vector that turns x,y,z into its axes; z is the one about which it may turn all the way",
     [](auto& o, auto& name, auto& b) {
       if (o.given(name)) b.axes = rotation_matrix(o.vector(name));
     }},
    {"<bushing>_frame", &Bushing::axes_of_first, one_of("world", "body"),
     "which x,y,z at the start: world, or body (of the first marker)"},
};

}  // namespace

OptionTable marker_table() {
  OptionTable table = table_of(kChangeRows, kLoadRows, kBushingRows);
  table.push_back({"sensors_<sensor>", "-", "", "BODY.MARKER whose motion is written as this sensor's"});
  return table;
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

dynamics::MarkerSetups marker_setups(const Options& options, const dynamics::MarkerSetups& start) {
  dynamics::MarkerSetups setups;
  for (const std::string& name : options.list("loads")) {
    const Load* known = named(start.loads, name);
    require(known || options.given(name + "_force") || options.given(name + "_torque") ||
                options.given(name + "_pressure"),
            "load ", name, ": give -", name, "_force, -", name, "_torque or -", name, "_pressure");
    read_rows(options, kLoadRows, setups.loads.emplace_back(known ? *known : Load{name, {}}), name);
  }
  for (const std::string& name : options.list("bushings")) {
    const Bushing* known = named(start.bushings, name);
    read_rows(options, kBushingRows, setups.bushings.emplace_back(known ? *known : Bushing{name, {}}), name);
  }
  for (const std::string& name : options.placeholder_values("sensors_<sensor>")) {
    const std::string option = "sensors_" + name;
    setups.sensors.push_back({name, marker_name(option, options.text(option))});
  }
  return setups;
}

void change_body(const Options& options, const std::string& name, ElasticBody& body) {
  if (std::none_of(kChangeRows.begin(), kChangeRows.end(),
                   [&](const auto& row) { return options.given(with_word(row.spec.name, name)); }))
    return;
  read_rows(options, kChangeRows, body, name);
  model::validate(body, "options -" + name + "_...");
}

}  // namespace elastogear::app
