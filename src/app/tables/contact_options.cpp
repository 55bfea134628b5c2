#include "app/tables/contact_options.h"

#include <algorithm>

#include "app/console/console.h"
#include "app/gear/drive_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using S = contact::Settings;
using F = contact::FrictionSettings;

const Rows<S> kContactRows = {
    {"contact_pairs", "-", "", "pairs of bodies that may touch, a:b"},
    {"contact_slave", &S::slave, one_of("first", "second"),
     "which body of a pair gives the slave nodes: first or second"},
    {"contact_two_pass", &S::two_pass, "-",
     "check both bodies' nodes against the other's faces, half the stiffness each; in one pass those of the "
     "slave and, without a penalty, those on sharp and open edges of the other"},
    {"contact_law", &S::law, one_of("auto", "penalty", "unilateral"),
     "penalty (forces grow with the penetration) or unilateral (there is none: gaps are closed by the "
     "residual flexibility of a body; without it from equilibrium to equilibrium at rest, and by impacts in "
     "motion); auto: unilateral where a body has that and no stiffness, damping or hysteresis is given"},
    {"contact_restitution", &S::restitution, "-",
     "unilateral, bodies in motion without residual flexibility: rate of a gap after over that before an "
     "impact, 0 to 1; elastic bodies rebound by themselves and take 0"},
    {"contact_points", &S::points, one_of("auto", "nodes", "minima", "faces", "stations"),
     "of the slave that are kept from entering the master: its nodes; minima, also the least gaps along the "
     "sides of its faces and within them (unilateral, smooth); faces, all points in the mean around each "
     "node (pressure as a field); auto: faces where the slave's cells are of second order, whose nodes alone "
     "cannot carry an even pressure, unless there are two passes; nodes elsewhere; stations: exact "
     "flanks touch along their lines of contact, or at points on axes that cross, on any mesh (unilateral; "
     "minima where that cannot be); drives take stations"},
    {"contact_penalty", &S::penalty, one_of("per_node", "per_area"),
     "penalty stiffness per_area (Pa/m) or per_node (N/m)"},
    {"contact_stiffness", &S::stiffness, "Pa/m or N/m",
     "penalty stiffness; 0: from material and size of the cells, both sides in series, where there is a "
     "penalty"},
    {"contact_depth", &S::depth, "m",
     "deepest penetration still taken for contact; 0: from the size of the faces"},
    {"contact_kdop", &S::k, "-", "directions of the bounding volumes: 6, 14, 18, 24 or 26"},
    {"contact_skin", &S::skin, "m",
     "relative motion after which the surfaces are searched anew; 0: from the size of the faces"},
    {"contact_update", &S::update, one_of("bound", "refit", "realign"),
     "how the trees follow the motion: bound (leaf-up, deformation bounded by the elastic energy), refit "
     "(leaf-up from the deformed surface) or realign (hull points)"},
    {"contact_offset", &S::offset, "m", "added to every gap: > 0 takes initial overlap out, < 0 backlash"},
    {"contact_surface", &S::surface, one_of("facets", "smooth", "exact"),
     "what gaps and normals are taken from: facets (the faces as they are), smooth (a smooth surface through "
     "their nodes) or exact (the flanks of <body>_flanks, and the smooth surface where none are given)"},
    {"contact_feature_angle", &S::feature_angle, "deg",
     "smooth surfaces: edges that turn by more stay sharp"},
    {"contact_extension", &S::extension, "-",
     "nodes: share of a face's length by which surfaces are prolonged at free boundaries; forces fade out "
     "over it"},
    {"contact_damping", &S::damping, "Pa s/m or N s/m",
     "damping while bodies approach, per area or per node"},
    {"contact_hysteresis", &S::hysteresis, "s/m",
     "Hunt and Crossley's factor of the penalty force while bodies approach"},
    {"contact_friction", in(&S::friction, &F::mu), "-", "coefficient of friction"},
    {"contact_friction_static", in(&S::friction, &F::mu_static), "-",
     "stick: coefficient of nodes that stick; 0: that of sliding"},
    {"contact_friction_law", in(&S::friction, &F::law), one_of("regularised", "stick"),
     "regularised (fades below a speed; for rolling) or stick (tangential springs; for standstill)"},
    {"contact_friction_speed", in(&S::friction, &F::v_0), "m/s",
     "regularised: speed at which friction is 0.7 of its full value"},
    {"contact_tangential", in(&S::friction, &F::stiffness), "-",
     "stick: tangential over normal penalty stiffness"},
    {"contact_tangent", &S::full_tangent, one_of("normal", "full"),
     "contact tangent: full, or normal (without its geometric part)"},
};

contact::Settings settings(const Options& options) {
  contact::Settings s;
  read_rows(options, kContactRows, s);
  return s;
}

int body_index(const std::vector<std::string>& bodies, const std::string& name, const std::string& pair) {
  const auto found = std::find(bodies.begin(), bodies.end(), name);
  require(found != bodies.end(), "option -contact_pairs = '", pair, "': there is no body '", name, "'");
  return static_cast<int>(found - bodies.begin());
}

// An exact surface that is asked for must come from somewhere; by default the smooth one does where none is
// known.
void require_exact_surface(const Options& options, const dynamics::PairSetup& pair,
                           const std::vector<std::string>& bodies) {
  const std::string &a = bodies[pair.body[0]], &b = bodies[pair.body[1]];
  require(!options.given("contact_surface") || pair.settings.surface != contact::ContactSurface::exact ||
              is_drive(options) || options.given(a + "_flanks") || options.given(b + "_flanks"),
          options.label("contact_surface"), " = exact: neither body of the pair ", pair.name,
          " has exact flanks; name the gear data that they were meshed from by -", a, "_flanks and -", b,
          "_flanks, or take smooth");
}

}  // namespace

OptionTable contact_table() { return table_of(kContactRows); }

void warn_of_facets(const Options& options, const dynamics::PairSetup& pair,
                    const std::vector<std::string>& bodies) {
  const std::string& slave = bodies[pair.body[pair.settings.slave]];
  const bool facets = pair.settings.surface == contact::ContactSurface::facets;
  std::string idle;
  if (options.given(slave + "_deviation")) idle = slave + "_deviation";
  for (const std::string& option : {slave + "_flanks", std::string("contact_surface")})
    if (options.given(option) && !facets) idle = option;
  if (idle.empty() || pair.settings.two_pass || pair.settings.points != contact::SlavePoints::nodes) return;
  print_item("warning", idle + " has no effect on the surface of " + slave + ", the slave of the pair " +
                            pair.name + ": only its nodes are in contact; contact_two_pass takes both");
}

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
    require_exact_surface(options, setups.back(), bodies);
  }
  return setups;
}

bool friction_sticks(const Options& options) {
  const contact::FrictionSettings f = settings(options).friction;
  return !options.list("contact_pairs").empty() && f.mu > 0 && f.law == contact::FrictionLaw::stick;
}

}  // namespace elastogear::app
