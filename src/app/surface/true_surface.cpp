#include "app/surface/true_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/console/console.h"
#include "app/gear/design_options.h"
#include "app/gear/modification_options.h"
#include "app/input/column_table.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/contact/topology.h"
#include "elastogear/drive/drive_system.h"

namespace elastogear::app {
namespace {

struct TrueSurfaceFiles {
  std::vector<std::string> flanks = {};
  std::string deviation = {};
};

const Rows<TrueSurfaceFiles> kTrueSurfaceRows = {
    {"<body>_flanks", &TrueSurfaceFiles::flanks, "-",
     "with contact_surface exact: the gear data that the body was meshed from, the YAML files of elastogear "
     "mesh; its flanks take the place of the faces of tooth_<ii>_... and thread_<i>_..."},
    {"<body>_deviation", &TrueSurfaceFiles::deviation, "-",
     "CSV file of how far the surface stands out of its mesh: a line for each node, its number in "
     "/surface/nodes of the body file and m along the outward normal (> 0: material added); linear between "
     "nodes, 0 at others"},
};

using drive::Teeth;

// The teeth of the part that files of gear data describe.
Teeth read_teeth(const std::vector<std::string>& files) {
  const Options options = Options::of_files("mesh", table_of(design_rows()), files);
  require(options.given("part"), join(files), ": names no part; add 'part: worm' or 'part: wheel'");
  const bool worm = is_worm(options);
  gear::Design design;
  read_rows(options, design_rows(), design);
  try {
    const gear::Geometry geometry = gear::derive(design);
    return {
        worm ? geometry.worm : geometry.wheel, {}, worm ? drive::Layers::axial : drive::Layers::transverse};
  } catch (const Error& error) {
    fail(join(files), ": ", error.what());
  }
}

// file: where the gear data come from. Stations take deviations as they are, other contact by polynomials.
contact::TrueSurface flanks_of(const Teeth& teeth, const std::string& file, const std::string& body,
                               const model::Surface& surface, bool at_stations) {
  const drive::FlankSurface found = [&] {
    try {
      return drive::flank_surface(teeth, surface, !is_silenced());
    } catch (const Error& error) {
      fail(file, ": body '", body, "': ", error.what(),
           ". Make the body anew from a mesh of this gear data, ",
           "with -surface flanks, or name the files that it was meshed from by -", body, "_flanks");
    }
  }();
  print_detail("flanks of " + body, std::to_string(found.n_faces) + " faces, nodes within " +
                                        with_unit(found.farthest.distance, "m") + " of " + file);
  if (teeth.deviations)
    (at_stations ? print_detail : print_item)(
        "modified flanks of " + body,
        "followed within " + with_unit(found.error * 1e6, "um") + " by polynomials over the faces");
  return found.surface;
}

void add_deviations(const std::string& file, const std::string& body, const model::Surface& surface,
                    contact::TrueSurface& known) {
  ColumnTable reader(file);
  const double allowed = contact::face_size(surface.X, surface.face);
  known.deviation = Eigen::VectorXd::Zero(surface.X.cols());
  std::vector<bool> given(surface.node.size(), false);
  while (reader.next()) {
    if (reader.n_columns() != 2) reader.fail_here("must be two numbers, a node and its deviation in m");
    const double number = reader.number(0, "-"), value = reader.number(1, "m");
    const auto at = std::lower_bound(surface.node.begin(), surface.node.end(), number);
    if (at == surface.node.end() || *at != number)
      reader.fail_here("node ", number, " is not on the surface of body '", body,
                       "'; /surface/nodes of its body file lists the nodes");
    const auto node = at - surface.node.begin();
    if (given[node]) reader.fail_here("node ", number, " is given twice");
    if (std::abs(value) > allowed)
      reader.fail_here("deviation ", value, " m of node ", number, " exceeds the size of a face, ", allowed,
                       " m; give it in m");
    given[node] = true;
    known.deviation[node] = value;
  }
  print_item("deviation of " + body, with_unit(known.deviation.minCoeff(), "m") + " to " +
                                         with_unit(known.deviation.maxCoeff(), "m") + " by " + file);
}

}  // namespace

OptionTable true_surface_table() { return table_of(kTrueSurfaceRows); }

std::string true_surface_input(const Options& options, const std::string& body) {
  std::string input = options.text("contact_surface");
  OptionTable table = modification_table();
  for (const OptionSpec& spec : true_surface_table()) table.push_back(spec);
  for (const OptionSpec& spec : table)
    if (const std::string name = with_word(spec.name, body); options.given(name))
      input += "\n" + name + " " + options.text(name);
  return input;
}

std::shared_ptr<const contact::TrueSurface> true_surface(const Options& options, const std::string& body,
                                                         const DriveMember* member,
                                                         const model::Surface& surface) {
  TrueSurfaceFiles files;
  read_rows(options, kTrueSurfaceRows, files, body);
  auto known = std::make_shared<contact::TrueSurface>();
  const bool at_stations = options.text("contact_points") == "stations";
  if (options.text("contact_surface") == "exact") {
    if (!files.flanks.empty())
      *known = flanks_of(read_teeth(files.flanks), join(files.flanks), body, surface, at_stations);
    else if (member)
      *known = flanks_of(drive::teeth_of(*member), join(options.files()), body, surface, at_stations);
  }
  if (!files.deviation.empty()) add_deviations(files.deviation, body, surface, *known);
  return known;
}

}  // namespace elastogear::app
