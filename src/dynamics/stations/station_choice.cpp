#include "elastogear/dynamics/station_choice.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace elastogear::dynamics {
namespace {

constexpr double kParallel = 0.99;  // cosine of the angle between axes, which are misaligned by less

// Rigid, or of one elastic material at the surface, with static responses.
std::string lacks_of_body(const SystemModel::Body& body) {
  if (is_rigid(body)) return {};
  if (body.eq.body->flexibility.empty())
    return "no residual flexibility; reduce it with -basis modal_residual";
  if (!(body.surface_compliance > 0) || !body.eq.body->relaxing.empty())
    return "several, orthotropic or viscoelastic materials";
  return {};
}

// Cosine of the angle between the axes of the bodies' frames at the start.
double cosine_of_axes(const SystemModel& model, const PairSetup& pair) {
  std::array<Eigen::Matrix3d, 2> R_WB;
  for (std::size_t side : {0, 1}) {
    const auto b = static_cast<std::size_t>(pair.body[side]);
    R_WB[side] =
        body::placement(model.bodies[b].eq.joint, motion(model, b, {0, model.U_0, model.V_0, model.V_0}).s)
            .R_WB;
  }
  return R_WB[0].col(2).dot(R_WB[1].col(2));
}

}  // namespace

std::string lacks_for_stations(const SystemModel& model, const PairSetup& pair) {
  for (int b : pair.body) {
    const SystemModel::Body& body = model.bodies[static_cast<std::size_t>(b)];
    const std::string who = "body '" + body.name + "' has ";
    if (!body.true_surface || !body.true_surface->flanks) return who + "no exact flanks of gear data";
    if (const std::string lacks = lacks_of_body(body); !lacks.empty()) return who + lacks;
  }
  if (std::ranges::all_of(pair.body,
                          [&](int b) { return is_rigid(model.bodies[static_cast<std::size_t>(b)]); }))
    return "both bodies are rigid";
  if (cosine_of_axes(model, pair) < -kParallel) return "axes run against each other";
  if (pair.settings.friction.mu > 0 && pair.settings.friction.law == contact::FrictionLaw::stick)
    return "friction sticks";
  if (pair.settings.law != contact::ContactLaw::unilateral) return "it needs the law 'unilateral'";
  if (pair.settings.surface != contact::ContactSurface::exact) return "it needs the surface 'exact'";
  return {};
}

int strips_of(const SystemModel& model, const PairSetup& pair) {
  if (pair.settings.points != contact::SlavePoints::stations) return 0;
  bool on_strips = cosine_of_axes(model, pair) > kParallel;
  for (int b : pair.body)
    on_strips = on_strips || model.bodies[static_cast<std::size_t>(b)].true_surface->flanks->is_hobbed();
  return on_strips ? kStrips : 0;
}

}  // namespace elastogear::dynamics
