#include "elastogear/dynamics/approach_choice.h"

#include "elastogear/base/error.h"

namespace elastogear::dynamics {

using contact::FlankApproach;

std::string lacks_for_approach(const SystemModel& model, const PairSetup& pair) {
  for (int b : pair.body) {
    const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(b)];
    const std::string who = "body '" + body.name + "' has ";
    if (!body.true_surface || body.true_surface->curvature.empty())
      return who + "no exact flanks; name the gear data it was meshed from";
    if (body.eq.body->flexibility.empty())
      return who + "no residual flexibility; reduce it with -basis modal_residual";
    if (!(body.surface_compliance > 0) || !body.eq.body->relaxing.empty())
      return who + "several, orthotropic or viscoelastic materials";
  }
  if (pair.settings.points != contact::SlavePoints::minima ||
      pair.settings.law != contact::ContactLaw::unilateral)
    return "it needs the law 'unilateral' and the points 'minima'";
  return {};
}

FlankApproach chosen_approach(const SystemModel& model, const PairSetup& pair) {
  if (pair.settings.approach == FlankApproach::mesh) return FlankApproach::mesh;
  const std::string lacks = lacks_for_approach(model, pair);
  if (lacks.empty()) return FlankApproach::hertz;
  require(pair.settings.approach == FlankApproach::automatic, "contact approach 'hertz' of the pair ",
          pair.name, ": ", lacks, ", or take the approach 'mesh'");
  return FlankApproach::mesh;
}

}  // namespace elastogear::dynamics
