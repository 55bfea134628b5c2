#pragma once
// The bodies of simulate: where they come from, their joints, initial states, loads and prescribed motions.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "elastogear/drive/drive_system.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::app {

/// Rows of the option table of simulate.
OptionTable body_table();

/// Bodies that have been read or made, by name, and what their files hold, whatever options leave out of it.
struct KnownBody {
  std::shared_ptr<const model::ElasticBody> body = nullptr;
  std::string identity = {};  ///< empty: there is no file
  std::shared_ptr<const contact::TrueSurface> true_surface = nullptr;
  std::string true_surface_input = {};            ///< that it was made of
  std::optional<double> surface_compliance = {};  ///< 1/Pa, as in BodySetup; empty: not asked for
};
using KnownBodies = std::map<std::string, KnownBody>;

/// A body as it is where no option says otherwise.
struct BodyStart {
  dynamics::BodySetup setup;
  const DriveMember* member = nullptr;        ///< gear of a drive that it is; null: none
  std::vector<drive::Bearing> bearings = {};  ///< of the gear
};

/// The setup of a body, which is read unless it is known.
dynamics::BodySetup body_setup(const Options& options, const BodyStart& start, KnownBodies& known);

}  // namespace elastogear::app
