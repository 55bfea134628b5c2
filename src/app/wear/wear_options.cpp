#include "app/wear/wear_options.h"

#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

const Rows<WearSettings> kWearRows = {
    {"revolutions", &WearSettings::revolutions, "-", "wear: revolutions of the first gear",
     kRequired | kPositive},
    {"limit", &WearSettings::limit, "m", "wear: depth at which the run ends; 0: at the revolutions"},
    {"increment", &WearSettings::increment, "m",
     "wear: largest growth of the depth from one sweep to the next, in which contact sees worn flanks",
     kPositive},
    {"cells_along", &WearSettings::along, "-", "wear: cells of a flank along its profile", kPositive},
    {"cells_across", &WearSettings::across, "-", "wear: cells of a flank across the face", kPositive},
    {"most_sweeps", &WearSettings::most_sweeps, "-", "wear: sweeps after which the run ends with an error",
     kPositive},
};

// prefix: "" or "<gear>_".
Rows<WearMaterial> material_rows(const std::string& prefix) {
  return {
      {prefix + "coefficient", &WearMaterial::coefficient, "m^2/N",
       "wear: k of Archard's law, depth = k pressure sliding distance, of all gears (<gear>_coefficient: of "
       "one)"},
      {prefix + "density", &WearMaterial::density, "kg/m^3", "wear: density, for the worn mass", kPositive}};
}

}  // namespace

OptionTable wear_table() {
  OptionTable table = table_of(kWearRows, material_rows(""));
  for (OptionSpec spec : table_of(material_rows("<gear>_"))) {
    spec.help.clear();
    table.push_back(spec);
  }
  return table;
}

WearSettings wear_settings(const Options& options) {
  WearSettings settings;
  read_rows(options, kWearRows, settings);
  require(settings.limit >= 0, options.label("limit"), " = ", settings.limit, " m: must be at least 0");
  require(settings.along >= 2 && settings.across >= 2, options.label("cells_along"), " = ", settings.along,
          ", cells_across = ", settings.across, ": must be 2 at least");
  return settings;
}

WearMaterial wear_material(const Options& options, const DriveMember& member) {
  WearMaterial material;
  read_rows(options, material_rows(""), material);
  read_rows(options, material_rows("<gear>_"), material, member.name);
  require(material.coefficient >= 0, options.label("coefficient"), " = ", material.coefficient,
          " m^2/N: must be at least 0");
  return material;
}

}  // namespace elastogear::app
