#include "app/life/life_options.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "app/console/plausibility.h"
#include "app/gear/drive_options.h"
#include "app/input/column_table.h"
#include "app/options/rows.h"
#include "app/options/units.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

using life::Block, life::MeanStress;

const Rows<LifeSettings> kLifeRows = {
    {"files", &LifeSettings::files, "-",
     "result files of sweeps, or stress files that recover wrote of them, one for each torque (default: what "
     "simulate wrote of the drive)"},
    {"file_torques", &LifeSettings::torques, "N m",
     "torque on the first gear in each of the files, < 0 on the coast side (default: as the files say)"},
    {"variant", &LifeSettings::variant, "-",
     "the variant of the sweep whose cases are taken, where there are several"},
    {"output", &LifeSettings::output, "-",
     "life file to write (HDF5); tables, summary and fields are named after it (default: the drive file's "
     "name with _life.h5)"},
    {"proportional", &LifeSettings::proportional, "-",
     "scale stresses in proportion to the torque outside the torques of the sweep; otherwise such a duty "
     "cycle is refused"},
    {"damage_field", &LifeSettings::field, "-",
     "write the damage on the meshes of the bodies for ParaView (from their body files)"},
    {"stress_<body>", &LifeSettings::sets, "-",
     "node sets of a gear whose damage is wanted (of its stress_nodes; default: root, of all gears)"},
    {"<body>_file", &LifeSettings::body_file, "-",
     "body file, when it is no longer where the result files say"},
};

// As given, for one gear or all.
struct StrengthKeys {
  life::SnCurve curve;
  MeanStress mean_stress{MeanStress::Kind::fkm, 0, 0};
  std::optional<double> sensitivity;
  double survival = 0.5;
};

// prefix: "" or "<gear>_".
Rows<StrengthKeys> strength_rows(const std::string& prefix) {
  using Keys = StrengthKeys;
  return {
      {prefix + "sn_knee_stress", in(&Keys::curve, &life::SnCurve::knee_stress), "Pa",
       "S-N curve: stress amplitude at its knee, for the finished part (size, surface)",
       kRequired | kPositive},
      {prefix + "sn_knee_cycles", in(&Keys::curve, &life::SnCurve::knee_cycles), "-",
       "S-N curve: cycles at its knee", kPositive},
      {prefix + "sn_slope", in(&Keys::curve, &life::SnCurve::slope), "-",
       "S-N curve: slope k above the knee, N = N_D (sigma_D / sigma_a)^k", kPositive},
      {prefix + "sn_below", in(&Keys::curve, &life::SnCurve::below),
       one_of("original", "haibach", "elementary"),
       "S-N curve below its knee: original (slope k), haibach (slope 2 k - 1) or elementary (no damage)"},
      {prefix + "sn_ratio", in(&Keys::curve, &life::SnCurve::ratio), "-",
       "S-N curve: stress ratio at which it was found, -1 fully reversed, 0 pulsating"},
      {prefix + "sn_survival", in(&Keys::curve, &life::SnCurve::survival), "-",
       "S-N curve: probability of survival for which it holds"},
      {prefix + "sn_scatter", in(&Keys::curve, &life::SnCurve::scatter), "-",
       "S-N curve: amplitude at 10 % survival over that at 90 %, log-normal"},
      {prefix + "survival", &Keys::survival, "-", "probability of survival for which the life is computed"},
      {prefix + "mean_stress", in(&Keys::mean_stress, &MeanStress::kind), one_of("none", "goodman", "fkm"),
       "correction for mean stress: goodman (needs tensile_strength), fkm (mean-stress sensitivity over four "
       "ranges of the stress ratio) or none"},
      {prefix + "tensile_strength", in(&Keys::mean_stress, &MeanStress::tensile_strength), "Pa",
       "of the material", kDependent | kPositive},
      {prefix + "mean_stress_sensitivity", &Keys::sensitivity, "-",
       "M of fkm (default: 0.35 R_m / 1000 MPa - 0.1 of tensile_strength, for steel)"},
  };
}

void read_given(const Options& options, const std::string& gear, StrengthKeys& keys) {
  const std::string own = gear + "_sn_knee_stress";
  require(options.given("sn_knee_stress") || options.given(own),
          "option -sn_knee_stress is missing: stress "
          "amplitude at the knee of the S-N curve, as in 'life: {sn: {knee_stress: 250 MPa}}', or of ",
          gear, " alone, -", own);
  for (const auto& [prefix, word] : {std::pair<std::string, std::string>{"", ""}, {"<gear>_", gear}})
    for (const auto& row : strength_rows(prefix)) {
      const std::string name = with_word(row.spec.name, word);
      if (options.given(name)) row.read(options, name, keys);
    }
}

void set_sensitivity(const std::string& gear, StrengthKeys& keys) {
  if (keys.mean_stress.kind != MeanStress::Kind::fkm) return;
  require(keys.sensitivity || keys.mean_stress.tensile_strength > 0, "gear ", gear,
          ": mean stress by fkm needs mean_stress_sensitivity, or tensile_strength, from which that of steel "
          "follows; or choose mean_stress goodman or none");
  keys.mean_stress.sensitivity = keys.sensitivity
                                     ? *keys.sensitivity
                                     : life::fkm_sensitivity_of_steel(keys.mean_stress.tensile_strength);
}

Block block(const std::string& label, double torque, double revolutions) {
  require(std::isfinite(torque) && torque != 0, label, ": torque ", torque,
          " N m must be > 0 on the drive side or < 0 on the coast side");
  require(std::isfinite(revolutions) && revolutions > 0, label, ": ", revolutions,
          " revolutions of the first gear must be > 0");
  return {torque, revolutions, 0};
}

double finite(const std::string& label, const std::string& text, const std::string& what) {
  const auto value = parse<double>(text);
  require(value && std::isfinite(*value), label, ": '", text, "' must be ", what);
  return *value;
}

constexpr double kTurn = 2 * std::numbers::pi;

// "1e6" are revolutions, "20 h" a time at the drive's speed.
Block entry(const Options& options, const std::string& torque, const std::string& amount) {
  const std::string label = options.label("duty_cycle");
  const double T = finite(label, in_unit(label, torque, "N m"), "a torque");
  if (const auto revolutions = parse<double>(amount)) return block(label, T, *revolutions);
  const double time = finite(label, in_unit(label, amount, "s"), "revolutions, or a time as 20 h");
  const double speed = options.number("speed");
  require(speed != 0, label, ": '", amount, "' is a time, which needs the speed of the first gear (speed)");
  return block(label, T, time * std::abs(speed) / kTurn);
}

std::vector<Block> read_duty_cycle(const std::string& file) {
  ColumnTable reader(file);
  std::vector<Block> blocks;
  while (reader.next()) {
    const std::size_t n = reader.n_columns();
    if (n != 2 && n != 3)
      reader.fail_here(
          "must be a torque in N m and revolutions, or a torque in N m, hours and a speed in rpm");
    const double torque = reader.number(0, "N m"), time = n == 3 ? 3600 * reader.number(1, "h") : 0;
    const double revolutions = n == 3 ? time / 60 * std::abs(reader.number(2, "rpm")) : reader.number(1, "-");
    if (torque == 0 || !(revolutions > 0))
      reader.fail_here("torque ", torque, " N m must not be 0, and ", revolutions,
                       " revolutions must be > 0");
    blocks.push_back({torque, revolutions, time});
  }
  require(!blocks.empty(), file, ": has no blocks");
  return blocks;
}

// A torque alone is no name of a table unless there is one.
bool names_table(const Options& options, const std::string& word) {
  return is_file(word) || !parse<double>(in_unit(options.label("duty_cycle"), word, "N m"));
}

// Times that are not given are those at the drive's speed, where it has one.
std::vector<Block> with_times(const Options& options, std::vector<Block> blocks) {
  const double speed = std::abs(options.number("speed"));
  for (Block& b : blocks)
    if (b.time == 0 && speed > 0) b.time = b.revolutions * kTurn / speed;
  return blocks;
}

}  // namespace

OptionTable life_table() {
  OptionTable table = table_of(kLifeRows, strength_rows(""));
  table.push_back(
      {"duty_cycle", "-", "",
       "torque on the first gear and its revolutions, or hours at its speed, of each block: [100 N "
       "m, 1e6, 250 N m, 20 h]; or a CSV file: a line for each block with torque in N m and "
       "revolutions, or torque in N m, hours and speed in rpm"});
  for (OptionSpec spec : table_of(strength_rows("<gear>_"))) {
    spec.help.clear();
    table.push_back(spec);
  }
  return table;
}

LifeSettings life_settings(const Options& options, const Drive& drive) {
  LifeSettings settings;
  read_rows(options, kLifeRows, settings);
  if (settings.sets.empty())
    for (const DriveMember& member : drive.members) settings.sets[member.name] = {"root"};
  if (settings.output.empty()) settings.output = drive_stem(options) + "_life.h5";
  require(settings.torques.empty() || settings.torques.size() == settings.files.size(),
          options.label("file_torques"), ": ", settings.torques.size(), " torques for ",
          settings.files.size(), " files (option -files): must be one for each");
  return settings;
}

Strength strength_of(const Options& options, const std::string& gear) {
  StrengthKeys keys;
  read_given(options, gear, keys);
  set_sensitivity(gear, keys);
  try {
    life::check(keys.curve);
    life::check(keys.mean_stress);
    require(keys.survival == keys.curve.survival || keys.curve.scatter > 1, "survival ", keys.survival,
            " differs from that of the S-N curve, ", keys.curve.survival,
            ": this needs its scatter, sn_scatter");
    return {life::at_survival(keys.curve, keys.survival), keys.mean_stress};
  } catch (const Error& error) {
    fail("strength of ", gear, ": ", error.what());
  }
}

void warn_of_strengths(const Options& options, const Drive& drive) {
  for (const OptionSpec& spec : table_of(strength_rows(""))) {
    if (spec.unit != "Pa") continue;
    std::vector<std::string> names = {spec.name};
    for (const DriveMember& member : drive.members) names.push_back(member.name + "_" + spec.name);
    for (const std::string& name : names)
      if (options.given(name)) warn_of_strength(options.label(name), options.number(name));
  }
}

std::vector<Block> duty_cycle(const Options& options) {
  require(options.given("duty_cycle"),
          "option -duty_cycle is missing: torques and revolutions, as in 'life: {duty_cycle: [100 N m, 1e6, "
          "250 N m, 1e4]}', or a CSV file");
  const std::vector<std::string> words = options.list("duty_cycle");
  if (words.size() == 1 && names_table(options, words[0]))
    return with_times(options, read_duty_cycle(words[0]));
  require(
      words.size() > 1 && words.size() % 2 == 0, options.label("duty_cycle"),
      ": must be pairs of a torque and revolutions or hours, as in [100 N m, 1e6, 250 N m, 20 h], or a CSV "
      "file");
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < words.size(); i += 2) blocks.push_back(entry(options, words[i], words[i + 1]));
  return with_times(options, blocks);
}

}  // namespace elastogear::app
