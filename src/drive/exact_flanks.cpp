#include "drive/charts.h"

#include <cmath>

namespace elastogear::drive {

double normal_module(const gear::Toothing& t) { return 2 * t.r / t.z * std::cos(std::atan(t.r / t.p)); }

std::shared_ptr<const contact::ExactFlanks> exact_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers) {
  if (!toothing.half_angle) return involute_flanks(toothing, deviations, layers);
  return layers == Layers::axial ? thread_flanks(toothing, deviations) : hobbed_flanks(toothing, deviations);
}

}  // namespace elastogear::drive
