#include "app/gear/true_surface.h"

#include <algorithm>
#include <cmath>

#include "app/console/console.h"
#include "app/gear/design_options.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/gear/flank.h"

namespace elastogear::app {
namespace {

constexpr double kOnFlank = 1e-6;  // m: the meshes are exact to 1e-9, and files may round to single precision

struct TrueSurfaceFiles {
  std::vector<std::string> flanks = {};
};

const Rows<TrueSurfaceFiles> kTrueSurfaceRows = {
    {"<body>_flanks", &TrueSurfaceFiles::flanks, "-",
     "with contact_surface exact: the gear data that the body was meshed from, the YAML files of elastogear "
     "mesh; its flanks take the place of the faces of tooth_<ii>_... and thread_<i>_..."},
};

// The toothing of the part that files of gear data describe.
gear::Toothing read_toothing(const std::vector<std::string>& files) {
  const Options options = Options::of_files("mesh", table_of(design_rows()), files);
  require(options.given("part"), join(files), ": names no part; add 'part: worm' or 'part: wheel'");
  const bool worm = is_worm(options);
  gear::Design design;
  read_rows(options, design_rows(), design);
  try {
    const gear::Geometry geometry = gear::derive(design);
    return worm ? geometry.worm : geometry.wheel;
  } catch (const Error& error) {
    fail(join(files), ": ", error.what());
  }
}

struct OffNode {
  double distance = 0;  // m, from its flank
  int node = -1;        // mesh number
  std::string group;
};

// The node of all flanks that is farthest from its exact flank.
OffNode farthest_node(const model::Surface& surface, const gear::Toothing& toothing) {
  OffNode farthest;
  for (int f = 0; f < surface.face.cols(); ++f) {
    const std::string& group = surface.group_name[surface.group[f]];
    const auto flank = gear::flank_of(group);
    if (!flank) continue;
    for (int node : surface.face.col(f)) {
      const double d =
          std::abs(gear::flank_distance(toothing, flank->tooth, flank->side, surface.X.col(node)));
      if (farthest.node < 0 || d > farthest.distance) farthest = {d, surface.node[node], group};
    }
  }
  return farthest;
}

// Adds the heights of all flanks; returns how many faces have some.
int add_heights(const model::Surface& surface, const gear::Toothing& toothing, contact::TrueSurface& known) {
  int n_faces = 0;
  known.height.resize(static_cast<std::size_t>(surface.face.cols()));
  for (int f = 0; f < surface.face.cols(); ++f) {
    const auto flank = gear::flank_of(surface.group_name[surface.group[f]]);
    if (!flank) continue;
    known.height[f] = contact::sampled_heights(surface, f, [&](const auto& x, const auto& n) {
      return gear::flank_distance_along(toothing, *flank, x, n);
    });
    ++n_faces;
  }
  return n_faces;
}

void add_flanks(const std::vector<std::string>& files, const std::string& body, const model::Surface& surface,
                contact::TrueSurface& known) {
  const gear::Toothing toothing = read_toothing(files);
  const std::string file = join(files);
  const OffNode farthest = farthest_node(surface, toothing);
  require(farthest.node >= 0, file, ": body '", body, "' has no faces of sets tooth_<ii>_left, ..._right or ",
          "thread_<i>_left, ..._right: reduce it with -surface flanks, from a mesh of elastogear mesh, or "
          "leave out -",
          body, "_flanks");
  require(farthest.distance <= kOnFlank, file, ": node ", farthest.node, " of body '", body, "', in ",
          farthest.group, ", is ", farthest.distance, " m off the flank of this gear data, allowed is ",
          kOnFlank, " m: name the files that the body was meshed from by -", body,
          "_flanks, or mesh it anew");
  const int n_faces = add_heights(surface, toothing, known);
  print_item("flanks of " + body, std::to_string(n_faces) + " faces, nodes within " +
                                      with_unit(farthest.distance, "m") + " of " + file);
}

}  // namespace

OptionTable true_surface_table() { return table_of(kTrueSurfaceRows); }

std::shared_ptr<const contact::TrueSurface> true_surface(const Options& options, const std::string& body,
                                                         const model::Surface& surface) {
  TrueSurfaceFiles files;
  read_rows(options, kTrueSurfaceRows, files, body);
  const bool exact = options.text("contact_surface") == "exact";
  if (files.flanks.empty() || !exact) return nullptr;
  auto known = std::make_shared<contact::TrueSurface>();
  add_flanks(files.flanks, body, surface, *known);
  return known;
}

}  // namespace elastogear::app
