#pragma once
// The kinds of charts that exact_flanks chooses from.

#include "elastogear/drive/exact_flanks.h"

namespace elastogear::drive {

/// Of involutes.
std::shared_ptr<const contact::ExactFlanks> involute_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers);
/// Of threads that are no involutes, one profile screwed along the axis.
std::shared_ptr<const contact::ExactFlanks> thread_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations);
/// Of wheels that a hob has made.
std::shared_ptr<const contact::ExactFlanks> hobbed_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations);

inline constexpr double kEdgeRadius = 0.03;  // modules, of the edges of tips
/// m, normal.
double normal_module(const gear::Toothing& toothing);

}  // namespace elastogear::drive
