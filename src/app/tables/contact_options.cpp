#include "app/tables/contact_options.h"

#include <algorithm>

#include "app/console/console.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

const OptionTable kTable = {
    {"contact_pairs", "-", "", "pairs of bodies that may touch, a:b"},
    {"contact_slave", "-", "first", "which body of a pair gives the slave nodes: first or second"},
    {"contact_two_pass", "-", "false",
     "check both bodies' nodes against the other's faces, half the stiffness each"},
    {"contact_penalty", "-", "per_area", "penalty stiffness per_area (Pa/m) or per_node (N/m)"},
    {"contact_stiffness", "Pa/m or N/m", "0",
     "penalty stiffness; 0: from material and size of the cells, both sides in series"},
    {"contact_depth", "m", "0", "deepest penetration still taken for contact; 0: from the size of the faces"},
    {"contact_kdop", "-", "24", "directions of the bounding volumes: 6, 14, 18, 24 or 26"},
    {"contact_skin", "m", "0",
     "relative motion after which the surfaces are searched anew; 0: from the size of the faces"},
    {"contact_update", "-", "bound",
     "how the trees follow the motion: bound (leaf-up, deformation bounded by the elastic energy), refit "
     "(leaf-up from the deformed surface) or realign (hull points)"},
    {"contact_offset", "m", "0", "added to every gap: > 0 takes initial overlap out, < 0 backlash"},
    {"contact_smooth", "-", "false",
     "gaps and normals of the smooth surface behind the facets (averaged normals at the nodes)"},
    {"contact_feature_angle", "deg", "30", "smooth: edges that turn by more stay sharp"},
    {"contact_extension", "-", "0.2",
     "share of a face's length by which surfaces are prolonged at open ends; forces fade out over it"},
    {"contact_damping", "Pa s/m or N s/m", "0", "damping while bodies approach, per area or per node"},
    {"contact_hysteresis", "s/m", "0",
     "Hunt and Crossley's factor of the penalty force while bodies approach"},
    {"contact_friction", "-", "0", "coefficient of friction"},
    {"contact_friction_static", "-", "0", "stick: coefficient of nodes that stick; 0: that of sliding"},
    {"contact_friction_law", "-", "regularised",
     "regularised (fades below a speed; for rolling) or stick (tangential springs; for standstill)"},
    {"contact_friction_speed", "m/s", "0", "regularised: speed at which friction is 0.7 of its full value"},
    {"contact_tangential", "-", "1", "stick: tangential over normal penalty stiffness"},
    {"contact_tangent", "-", "full", "contact tangent: full, or normal (without its geometric part)"},
};

contact::FrictionSettings friction(const Options& options) {
  contact::FrictionSettings f;
  f.mu = options.number("contact_friction");
  f.mu_static = options.number("contact_friction_static");
  f.law = options.choice("contact_friction_law", {"regularised", "stick"}) == 0
              ? contact::FrictionLaw::regularised
              : contact::FrictionLaw::stick;
  f.v_0 = options.number("contact_friction_speed");
  f.stiffness = options.number("contact_tangential");
  return f;
}

contact::Settings settings(const Options& options) {
  contact::Settings s;
  s.k = options.count("contact_kdop");
  s.slave = options.choice("contact_slave", {"first", "second"});
  s.two_pass = options.flag("contact_two_pass");
  s.penalty = options.choice("contact_penalty", {"per_area", "per_node"}) == 0 ? contact::Penalty::per_area
                                                                               : contact::Penalty::per_node;
  s.stiffness = options.number("contact_stiffness");
  s.depth = options.number("contact_depth");
  s.skin = options.number("contact_skin");
  s.offset = options.number("contact_offset");
  s.smooth = options.flag("contact_smooth");
  s.feature_angle = options.number("contact_feature_angle");
  s.extension = options.number("contact_extension");
  s.damping = options.number("contact_damping");
  s.hysteresis = options.number("contact_hysteresis");
  s.friction = friction(options);
  s.update = static_cast<contact::Update>(options.choice("contact_update", {"bound", "refit", "realign"}));
  s.full_tangent = options.choice("contact_tangent", {"full", "normal"}) == 0;
  return s;
}

int body_index(const std::vector<std::string>& bodies, const std::string& name, const std::string& pair) {
  const auto found = std::find(bodies.begin(), bodies.end(), name);
  require(found != bodies.end(), "option -contact_pairs = '", pair, "': there is no body '", name, "'");
  return static_cast<int>(found - bodies.begin());
}

}  // namespace

const OptionTable& contact_table() { return kTable; }

namespace {

// Warns that smoothing has no effect on the slave surface of a pair with one pass, of which only the nodes
// are in contact.
void warn_of_facets(const dynamics::PairSetup& pair, const std::vector<std::string>& bodies) {
  if (!pair.settings.smooth || pair.settings.two_pass) return;
  const std::string& slave = bodies[pair.body[pair.settings.slave]];
  print_item("warning", "contact_smooth has no effect on the surface of " + slave +
                            ", the slave of the pair " + pair.name +
                            ": only its nodes are in contact; contact_two_pass smooths both");
}

}  // namespace

std::vector<dynamics::PairSetup> pair_setups(const Options& options, const std::vector<std::string>& bodies) {
  std::vector<dynamics::PairSetup> setups;
  for (const std::string& pair : options.list("contact_pairs")) {
    require(std::none_of(setups.begin(), setups.end(), [&](const auto& s) { return s.name == pair; }),
            "option -contact_pairs names the pair '", pair, "' twice");
    const auto colon = pair.find(':');
    require(colon != std::string::npos, "option -contact_pairs = '", pair, "': must be two bodies, a:b");
    const int a = body_index(bodies, pair.substr(0, colon), pair);
    const int b = body_index(bodies, pair.substr(colon + 1), pair);
    setups.push_back({pair, {a, b}, settings(options)});
    warn_of_facets(setups.back(), bodies);
  }
  return setups;
}

bool friction_sticks(const Options& options) {
  const contact::FrictionSettings f = friction(options);
  return !options.list("contact_pairs").empty() && f.mu > 0 && f.law == contact::FrictionLaw::stick;
}

}  // namespace elastogear::app
