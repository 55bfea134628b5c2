#pragma once
// The true surface of a body of `simulate`: exact flanks from gear data, deviations from a table.

#include <memory>
#include <string>

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "elastogear/contact/true_surface.h"

namespace elastogear::app {

OptionTable true_surface_table();

/// What is known of the true surface of a body. member: the gear of a drive that it is; null: none. Throws
/// Error naming file, value and remedy when gear data or deviations do not fit the surface.
std::shared_ptr<const contact::TrueSurface> true_surface(const Options& options, const std::string& body,
                                                         const DriveMember* member,
                                                         const model::Surface& surface);

/// All that true_surface takes from the options of a body, as text, but for the design of its drive.
std::string true_surface_input(const Options& options, const std::string& body);

}  // namespace elastogear::app
