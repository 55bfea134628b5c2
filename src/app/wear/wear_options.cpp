#include "app/wear/wear_options.h"

#include "app/console/plausibility.h"
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
  constexpr int kLeast = 2, kMost = 1000;  // cells
  const auto fits = [](int cells) { return cells >= kLeast && cells <= kMost; };
  require(fits(settings.along) && fits(settings.across), options.label("cells_along"), " = ", settings.along,
          ", cells_across = ", settings.across, ": must be ", kLeast, " at least and at most ", kMost);
  return settings;
}

void require_limit_within_teeth(const Options& options, const WearSettings& settings, const Drive& drive) {
  for (const DriveMember& member : drive.members)
    require(settings.limit <= tooth_height(member), options.label("limit"), " = ", settings.limit,
            " m: must be at most ", tooth_height(member), " m, the height of the teeth of ", member.name,
            "; write its unit, as in '20 um'");
}

WearMaterial wear_material(const Options& options, const DriveMember& member) {
  WearMaterial material;
  read_rows(options, material_rows(""), material);
  read_rows(options, material_rows("<gear>_"), material, member.name);
  const auto given = [&](const std::string& key) {
    return options.given(member.name + "_" + key) ? member.name + "_" + key : key;
  };
  require(material.coefficient >= 0, options.label(given("coefficient")), " = ", material.coefficient,
          " m^2/N: must be at least 0");
  warn_of_density(options.label(given("density")), material.density);
  return material;
}

}  // namespace elastogear::app
