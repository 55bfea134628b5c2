#pragma once
// Loads, bushings, sensors and what else hangs on the markers and dampers of bodies, from the options of
// simulate.

#include <string>
#include <vector>

#include "app/options/options.h"
#include "elastogear/dynamics/marker_forces.h"

namespace elastogear::app {

/// Rows of the option table of simulate.
OptionTable marker_table();

/// Names of bodies, loads and bushings by the placeholders of their keys, those included that a file names
/// and the command line leaves out. Throws Error when two are equal.
PlaceholderValues simulate_names(const Options& options);

/// start: loads and bushings of a drive, from which options depart.
dynamics::MarkerSetups marker_setups(const Options& options, const dynamics::MarkerSetups& start);

/// Markers at points of the body frame, and damping in place of the body file's.
void change_body(const Options& options, const std::string& name, model::ElasticBody& body);

}  // namespace elastogear::app
