#include "app/gear/modification_options.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "app/console/console.h"
#include "app/input/column_table.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using gear::FlankDeviations, gear::FlankModification, gear::Relief, gear::Topography;

constexpr double kEndRelief = 0.1;  // of the face width, where no length is given

struct Errors {
  std::vector<double> pitch;
  double run_out = 0, run_out_angle = 0;
  std::string topography, wear;
};

const Rows<Errors> kErrorRows = {
    {"<gear>_pitch_deviation", &Errors::pitch, "m",
     "drive: index deviations of single teeth, along the pitch circle, > 0 counter-clockwise: [TOOTH, VALUE, "
     "TOOTH, VALUE, ...]"},
    {"<gear>_run_out", &Errors::run_out, "m",
     "drive: of the toothing, twice its eccentricity against the gear's axis"},
    {"<gear>_run_out_angle", &Errors::run_out_angle, "deg",
     "drive: from the middle of tooth 1 to where the toothing stands out farthest"},
    {"<gear>_topography", &Errors::topography, "-",
     "drive: CSV file of measured flanks: a line for each point with its diameter, z and height out of the "
     "exact flank, all in m; two more columns, tooth (0: all) and side (left, right, both), where flanks "
     "differ; the points of a flank form a grid of diameters and z"},
    {"<gear>_wear", &Errors::wear, "-",
     "drive: CSV file of worn flanks that wear wrote, in the form of topography; comes on top of all others"},
};

template <class Member>
auto of(Relief FlankModification::*relief, Member member) {
  return [=](FlankModification & m) -> auto& { return m.*relief.*member; };
}

// Amount, length and form of one relief.
Rows<FlankModification> relief_rows(const std::string& prefix, Relief FlankModification::*relief,
                                    const std::string& amount_help, const std::string& length_help) {
  return {{prefix, of(relief, &Relief::amount), "m", "drive: " + amount_help},
          {prefix + "_length", of(relief, &Relief::length), "m", "drive: " + length_help, kDependent},
          {prefix + "_form", of(relief, &Relief::parabolic), one_of("linear", "parabolic"),
           "drive: linear or parabolic"}};
}

// side: "", "left_" or "right_".
Rows<FlankModification> modification_rows(const std::string& side) {
  const std::string gear = "<gear>_" + side;
  Rows<FlankModification> rows = {
      {gear + "profile_crowning", &FlankModification::C_alpha, "m",
       "drive: material removed at both ends of the profile, parabolic"},
      {gear + "profile_slope", &FlankModification::C_Halpha, "m",
       "drive: material removed at the tip, linear from the start of contact"},
      {gear + "lead_crowning", &FlankModification::C_beta, "m",
       "drive: material removed at both ends of the face, parabolic"},
      {gear + "helix_slope", &FlankModification::C_Hbeta, "m",
       "drive: material removed at the end of larger z, linear from the other one"},
      {gear + "twist", &FlankModification::S_alpha, "m",
       "drive: profile slope at the end of larger z less that at the other end"},
  };
  for (const auto& more :
       {relief_rows(gear + "tip_relief", &FlankModification::tip,
                    "material removed at the tip of all flanks (<gear>_left_..., <gear>_right_...: of those "
                    "of one side; so with the other modifications)",
                    "length of roll of the tip relief (default: where two pairs are in contact)"),
        relief_rows(gear + "root_relief", &FlankModification::root,
                    "material removed at the start of contact",
                    "length of roll of the root relief (default: where two pairs are in contact)"),
        relief_rows(gear + "end_relief", &FlankModification::end, "material removed at both ends of the face",
                    "along the axis (default: a tenth of the face)")})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

// Those of one side have no help of their own.
OptionTable side_table(const std::string& side) {
  OptionTable table = table_of(modification_rows(side));
  for (OptionSpec& spec : table) spec.help.clear();
  return table;
}

bool any_given(const Options& options, const std::string& gear) {
  const OptionTable table = modification_table();
  return std::any_of(table.begin(), table.end(),
                     [&](const OptionSpec& spec) { return options.given(with_word(spec.name, gear)); });
}

// A length or a form needs the amount that it is of, of all flanks or of one side, unless variants may give
// it.
void require_amounts(const Options& options, const std::string& gear) {
  if (options.given("variants")) return;
  for (const char* relief : {"tip_relief", "root_relief", "end_relief"}) {
    const auto amount = [&](const char* side) { return gear + "_" + side + relief; };
    const auto is_given = [&](const char* side) { return options.given(amount(side)); };
    for (const char* side : {"", "left_", "right_"})
      for (const char* end : {"_length", "_form"}) {
        const bool has_amount =
            is_given("") || is_given(side) || (!*side && (is_given("left_") || is_given("right_")));
        require(!options.given(amount(side) + end) || has_amount, options.label(amount(side) + end),
                ": needs ", amount(side), ", too, the material removed");
      }
  }
}

FlankModification modification(const Options& options, const DriveMember& member, const std::string& side) {
  FlankModification m;
  m.tip.length = m.root.length = gear::relief_length(member.toothing);
  m.end.length = kEndRelief * member.width;
  read_rows(options, modification_rows(""), m, member.name);
  read_rows(options, modification_rows(side), m, member.name);
  return m;
}

Eigen::VectorXd index_deviations(const Options& options, const DriveMember& member,
                                 const std::vector<double>& pairs) {
  const std::string label = options.label(member.name + "_pitch_deviation");
  require(pairs.size() % 2 == 0, label, ": must be pairs of a tooth and its deviation, as in [3, 10 um]");
  Eigen::VectorXd index = Eigen::VectorXd::Zero(member.toothing.z);
  std::set<double> seen;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    const double tooth = pairs[i];
    require(tooth == std::floor(tooth) && tooth >= 1 && tooth <= member.toothing.z, label, ": tooth ", tooth,
            " is not there, teeth are 1 to ", member.toothing.z);
    require(seen.insert(tooth).second, label, ": tooth ", tooth, " is there twice");
    index[static_cast<Eigen::Index>(tooth) - 1] = pairs[i + 1];
  }
  return index;
}

int side_number(const ColumnTable& reader, const std::string& side) {
  if (side == "left") return 1;
  if (side == "right") return -1;
  if (side != "both") reader.fail_here("side '", side, "' must be left, right or both");
  return 0;
}

// Heights by (length of roll, z) of each flank of the file.
using Points = std::map<std::pair<double, double>, double>;
using Flanks = std::map<std::pair<int, int>, Points>;  // by tooth and side

Flanks read_flanks(const std::string& file, const DriveMember& member) {
  ColumnTable reader(file);
  Flanks flanks;
  while (reader.next()) {
    const std::size_t n = reader.n_columns();
    if (n != 3 && n != 5)
      reader.fail_here("must be diameter, z and height in m, or these with tooth and side");
    const double diameter = reader.number(0, "m"), z = reader.number(1, "m");
    const double tooth = n == 5 ? reader.number(3, "-") : 0;
    if (diameter < 2 * member.toothing.r_b ||
        diameter > 2.02 * std::max(member.toothing.r_a, member.toothing.r_f))
      reader.fail_here("diameter ", diameter, " m is not on the flank, which has diameters of ",
                       2 * member.toothing.r_form, " to ", 2 * member.toothing.r_a, " m");
    if (std::abs(z) > member.width)
      reader.fail_here("z = ", z, " m is far off the face, ", member.width, " m wide");
    if (tooth != std::floor(tooth) || tooth < 0 || tooth > member.toothing.z)
      reader.fail_here("tooth ", tooth, " is not there, teeth are 1 to ", member.toothing.z, ", 0 means all");
    const int side = n == 5 ? side_number(reader, reader.text(4)) : 0;
    const bool fresh =
        flanks[{static_cast<int>(tooth) - 1, side}]
            .try_emplace({gear::length_of_roll(member.toothing, diameter / 2), z}, reader.number(2, "m"))
            .second;
    if (!fresh) reader.fail_here("this point of the flank is given twice");
  }
  require(!flanks.empty(), file, ": has no points");
  return flanks;
}

Eigen::VectorXd as_vector(const std::set<double>& values) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.begin());
  return v;
}

Topography on_grid(const std::string& file, const Points& points) {
  std::set<double> roll, z;
  for (const auto& [at, height] : points) {
    roll.insert(at.first);
    z.insert(at.second);
  }
  require(roll.size() > 1 && z.size() > 1 && roll.size() * z.size() == points.size(), file, ": a flank has ",
          points.size(), " points at ", roll.size(), " diameters and ", z.size(),
          " z: they must form a grid of at least 2 x 2");
  Topography topography{.roll = as_vector(roll), .z = as_vector(z), .height = {}};
  topography.height.resize(topography.roll.size(), topography.z.size());
  for (Eigen::Index i = 0; i < topography.roll.size(); ++i)
    for (Eigen::Index j = 0; j < topography.z.size(); ++j)
      topography.height(i, j) = points.at({topography.roll[i], topography.z[j]});
  return topography;
}

std::vector<Topography> read_topography(const std::string& file, const DriveMember& member) {
  std::vector<Topography> all;
  for (const auto& [flank, points] : read_flanks(file, member)) {
    all.push_back(on_grid(file, points));
    std::tie(all.back().tooth, all.back().side) = flank;
  }
  return all;
}

}  // namespace

OptionTable modification_table() {
  OptionTable table = table_of(modification_rows(""), kErrorRows);
  for (const char* side : {"left_", "right_"}) {
    const OptionTable more = side_table(side);
    table.insert(table.end(), more.begin(), more.end());
  }
  return table;
}

std::optional<FlankDeviations> flank_deviations(const Options& options, const DriveMember& member) {
  if (!any_given(options, member.name)) return {};
  require_amounts(options, member.name);
  FlankDeviations deviations;
  deviations.left = modification(options, member, "left_");
  deviations.right = modification(options, member, "right_");
  deviations.width = member.width;
  Errors errors;
  read_rows(options, kErrorRows, errors, member.name);
  require(errors.run_out >= 0, options.label(member.name + "_run_out"), " = ", errors.run_out,
          " m: must be at least 0; run_out_angle says where the teeth stand out");
  deviations.index = index_deviations(options, member, errors.pitch);
  const double angle = member.toothing.theta_1 + errors.run_out_angle * std::numbers::pi / 180;
  deviations.eccentricity = errors.run_out / 2 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  for (const std::string& file : {errors.topography, errors.wear})
    if (!file.empty())
      for (Topography& more : read_topography(file, member)) deviations.topography.push_back(std::move(more));
  gear::check(member.name, member.toothing, deviations);
  if (gear::are_exact(deviations)) return {};
  return deviations;
}

}  // namespace elastogear::app
