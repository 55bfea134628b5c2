#include "contact/settings.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/contact/kdop.h"
#include "elastogear/contact/stiffness.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {
namespace {

constexpr double kSkin = 0.25;  // of the face size: dozens of time steps, and few more nodes than at 0

constexpr double kCompliance = 1e-4;  // of the penalty's, that is left without one: Eq. (6.24)

// Of a face's length, by which boundaries of two surfaces may miss each other where they are meant to meet.
// Aligned ends of gears move by micrometres along their axes as elastic teeth are loaded, and would gain and
// lose their contact otherwise; rigid ones stay where they are, and a tip does not touch beyond the mate's
// flank.
constexpr double kSharedBoundary = 1e-2, kRigidSharedBoundary = 1e-4;

bool is_rigid(const model::Surface& surface) { return model::column_count(surface.Phi) == 0; }

}  // namespace

ContactLaw chosen_law(const Settings& s, bool has_residual_flexibility) {
  if (s.law == ContactLaw::unilateral && !has_residual_flexibility) return ContactLaw::augmented;
  if (s.law != ContactLaw::automatic) return s.law;
  const bool has_penalty = s.stiffness > 0 || s.damping > 0 || s.hysteresis > 0;
  return has_residual_flexibility && !has_penalty ? ContactLaw::unilateral : ContactLaw::penalty;
}

SlavePoints chosen_points(const Settings& s, const model::Surface& slave) {
  if (s.points != SlavePoints::automatic) return s.points;
  return slave.side.cols() > 0 && !s.two_pass ? SlavePoints::faces : SlavePoints::nodes;
}

void validate(const FrictionSettings& s) {
  require(std::isfinite(s.mu) && s.mu >= 0, "contact: friction ", s.mu, " must not be negative");
  require(s.mu_static == 0 || (std::isfinite(s.mu_static) && s.mu_static >= s.mu),
          "contact: static friction ", s.mu_static, ", allowed are 0 and values from the sliding one, ", s.mu,
          ", on");
  require(std::isfinite(s.v_0) && s.v_0 >= 0, "contact: friction speed ", s.v_0, " m/s must not be negative");
  require(s.mu == 0 || s.law == FrictionLaw::stick || s.v_0 > 0,
          "contact: regularised friction needs the speed below which it fades, friction_speed (m/s, > 0)");
  require(std::isfinite(s.stiffness) && s.stiffness > 0, "contact: tangential stiffness ", s.stiffness,
          " must be positive");
}

void validate(const Settings& s) {
  directions(s.k);
  require(std::isfinite(s.stiffness) && s.stiffness >= 0, "contact: stiffness ", s.stiffness,
          ", allowed are positive values and 0 (from material and cell size)");
  require(std::isfinite(s.depth) && s.depth >= 0, "contact: depth ", s.depth,
          ", allowed are positive values and 0 (from the face size)");
  require(std::isfinite(s.skin) && s.skin >= 0, "contact: skin ", s.skin,
          ", allowed are positive values and 0 (from the face size)");
  require(s.slave == 0 || s.slave == 1, "contact: slave ", s.slave, ", allowed are 0 and 1");
  require(s.normal_angle >= 90 && s.normal_angle <= 180, "contact: normal_angle ", s.normal_angle,
          " deg, allowed is 90 to 180");
  require(std::isfinite(s.damping) && s.damping >= 0, "contact: damping ", s.damping,
          " must not be negative");
  require(std::isfinite(s.hysteresis) && s.hysteresis >= 0, "contact: hysteresis ", s.hysteresis,
          " s/m must not be negative");
  require(std::isfinite(s.offset), "contact: offset ", s.offset, " m must be finite");
  require(s.feature_angle > 0 && s.feature_angle <= 90, "contact: feature_angle ", s.feature_angle,
          " deg, allowed is 0 to 90");
  validate(s.friction);
  require(s.law == ContactLaw::penalty || (s.damping == 0 && s.hysteresis == 0),
          "contact: damping and hysteresis are those of the penalty; the unilateral law has none");
  require(s.restitution >= 0 && s.restitution <= 1, "contact: restitution ", s.restitution,
          ", allowed is 0 to 1");
  require(
      s.restitution == 0 || s.law == ContactLaw::augmented, "contact: restitution ", s.restitution,
      " is that of impacts between bodies without residual flexibility; with it, or with a penalty, leave "
      "it out");
  require(s.points == SlavePoints::nodes || !s.two_pass, "contact: points '",
          s.points == SlavePoints::minima ? "minima" : "faces",
          "' take both surfaces in one pass; leave two_pass out");
  require(s.points != SlavePoints::minima || s.friction.mu == 0 || s.friction.law == FrictionLaw::regularised,
          "contact: friction that sticks needs the points 'nodes' or 'faces'");
  require(s.points != SlavePoints::minima ||
              (s.law != ContactLaw::penalty && s.surface != ContactSurface::facets),
          "contact: points 'minima' need the law 'unilateral' and the surface 'smooth' or 'exact'");
  require(s.extension >= 0 && s.extension <= 0.5, "contact: extension ", s.extension,
          ", allowed is 0 to 0.5");
}

Settings with_defaults(Settings settings, const model::Surface& a, const model::Surface& b) {
  if (settings.stiffness == 0) settings.stiffness = default_stiffness(settings, a, b);
  const double size = std::min(face_size(a.X, a.face), face_size(b.X, b.face));
  if (settings.depth == 0) settings.depth = 0.5 * size;
  if (settings.skin == 0) settings.skin = kSkin * size;
  if (settings.points == SlavePoints::minima)
    settings.extension = is_rigid(a) && is_rigid(b) ? kRigidSharedBoundary : kSharedBoundary;
  require(settings.depth > 0, "contact: the faces have no area, give the depth");
  require(std::abs(settings.offset) <= settings.depth, "contact: offset ", settings.offset,
          " m must not exceed the depth that is searched, ", settings.depth, " m");
  return settings;
}

std::vector<Law> node_laws(const Settings& s, const model::Surface& slave) {
  const Eigen::VectorXd c_p = node_stiffness(s, slave);
  std::vector<Law> laws(static_cast<std::size_t>(c_p.size()));
  const bool sticks = s.friction.law == FrictionLaw::stick;
  for (Eigen::Index i = 0; Law & law : laws) {
    law.c_p = c_p[i++];
    law.unilateral = s.law == ContactLaw::unilateral;
    law.compliance = kCompliance;
    law.d_p = s.damping * law.c_p / s.stiffness;
    law.hysteresis = s.hysteresis;
    law.offset = s.offset;
    law.mu = s.friction.mu;
    law.mu_static = std::max(s.friction.mu, s.friction.mu_static);
    law.v_0 = sticks ? 0 : s.friction.v_0;
    law.c_t = sticks ? s.friction.stiffness * law.c_p : 0;
    law.restitution = s.restitution;
  }
  return laws;
}

bool has_potential(const Settings& s) {
  return s.law != ContactLaw::augmented && s.damping == 0 && s.hysteresis == 0 && s.offset == 0 &&
         s.friction.mu == 0;
}

}  // namespace elastogear::contact
