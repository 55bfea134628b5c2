#include "app/gear/drive_options.h"

#include <algorithm>
#include <filesystem>

#include "app/console/console.h"
#include "app/gear/bearing_options.h"
#include "app/gear/cylindrical_options.h"
#include "app/gear/design_options.h"
#include "app/gear/facts.h"
#include "app/gear/misalignment.h"
#include "app/gear/modification_options.h"
#include "app/gear/worm_options.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

struct DriveChoices {
  std::string gears = "pinion,wheel";
  double roll = 0, torque = 0, speed = 0;
};

const Rows<DriveChoices> kDriveRows = {
    {"drive", "-", "",
     "a drive file: cylindrical (spur, helical and internal gears) or worm (a worm and its wheel); its "
     "numbers "
     "serve mesh, reduce, simulate and recover"},
    {"gears", &DriveChoices::gears, "-",
     "drive: names of the gears, the driving one first; each has its own section"},
    {"roll", &DriveChoices::roll, "-",
     "drive: pitches by which the first gear is turned from where one of its teeth points to its mate"},
    {"side", "-", "drive",
     "drive: flanks in touch: drive (the first gear drives counter-clockwise, seen against its z axis), or "
     "coast"},
    {"torque", &DriveChoices::torque, "N m",
     "drive: on the first gear, in the sense that presses the flanks of side together; the last one is held "
     "at rest (static, relax) and carries the torque in motion"},
    {"drawing", "-", "", "drive: SVG file that mesh draws the gears in (default: the file's name, .svg)"},
    {"<gear>_mesh_output", "-", "", "drive: mesh file that mesh writes, .msh or .inp (default: <gear>.msh)"},
    {"<gear>_file", "-", "", "drive: body file that reduce writes and simulate reads (default: <gear>.h5)"},
    {"speed", &DriveChoices::speed, "rad/s",
     "drive: of the first gear at the start of a motion, in that sense; with its unit, 1500 rpm"},
};

// Rows of gear data for a single body, and those that all drives share.
constexpr const char* kOfParts[] = {"part", "mesh"};
constexpr const char* kShared[] = {"size",           "element_order",   "refinement", "module",
                                   "pressure_angle", "centre_distance", "backlash",   "face_width"};

// Options of reduce that a drive sets itself for each gear.
const std::vector<std::string> kOfDrive = {"mesh",          "output", "stiffness", "mass",
                                           "matrix_format", "dofs",   "nodes",     "instance"};

bool any_material(const Options& options) {
  const auto all = options.given_to_verb();
  return std::any_of(all.begin(), all.end(),
                     [](const auto& option) { return option.first.starts_with("material_"); });
}

bool is_worm_drive(const Options& options) { return options.choice("drive", {"cylindrical", "worm"}) == 1; }

template <class List>
bool holds(const List& list, const std::string& name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

// Names that are given of the options of a table, whatever stands for their placeholders.
std::vector<std::string> given_of(const Options& options, const OptionTable& table) {
  std::vector<std::string> names;
  for (const OptionSpec& spec : table)
    if (spec.name.find('<') == std::string::npos) {
      if (options.given(spec.name)) names.push_back(spec.name);
    } else {
      for (const std::string& word : options.placeholder_values(spec.name))
        names.push_back(with_word(spec.name, word));
    }
  return names;
}

// Is this a key of the gear, its own one or one of any gear or body?
bool is_of_gear(const Options& options, const OptionTable& keys, const std::string& gear,
                const std::string& key) {
  return options.has_key("<body>_" + key) ||
         std::any_of(keys.begin(), keys.end(), [&](const OptionSpec& spec) {
           return spec.name == gear + "_" + key || spec.name == "<gear>_" + key;
         });
}

// Nothing would read what is the whole drive's, or what a drive sets itself, in the section of a gear.
void refuse_keys_of_drive(const Options& options) {
  OptionTable keys = table_of(kDriveRows, design_rows());
  for (const OptionTable& more : {cylindrical_table(), worm_table()})
    keys.insert(keys.end(), more.begin(), more.end());
  const auto in_section = [](const std::string& gear, const std::string& key) {
    return std::string(gear).append("_").append(key);
  };
  const auto is_lost = [&](const std::string& gear, const std::string& key) {
    return options.given(in_section(gear, key)) && !is_of_gear(options, keys, gear, key);
  };
  for (const std::string& gear : options.list("gears")) {
    for (const OptionSpec& spec : keys)
      require(spec.name.find('<') != spec.name.npos || !is_lost(gear, spec.name),
              options.label(in_section(gear, spec.name)), ": all gears of a drive have one ", spec.name,
              "; give it without the gear's name");
    for (const std::string& key : kOfDrive)
      require(!is_lost(gear, key), options.label(in_section(gear, key)),
              ": is for a single body; a drive makes the bodies of its gears of their data");
  }
}

// Keys of a section begin with its gear's name, which must begin no key that is there without the gear.
void refuse_names_of_gears(const Options& options) {
  const std::vector<std::string> names = options.list("gears"), of_worm_drive = {"worm", "wheel"};
  for (const std::string& name : names) {
    require(std::count(names.begin(), names.end(), name) == 1, options.label("gears"), ": '", name,
            "' is there twice");
    require(holds(of_worm_drive, name) || !options.begins_key(name), options.label("gears"), ": '", name,
            "' is no name for a gear, as other keys begin with '", name, "_'; give it another one");
  }
  require(!is_worm_drive(options) || names == of_worm_drive, options.label("gears"), " = ", join(names),
          ": the gears of drive: worm are worm, wheel; leave the key out");
}

// Numbers that the other kind of drive, or a single body, would have must not be passed over in silence.
void refuse_others(const Options& options) {
  for (const char* name : kOfParts)
    require(!options.given(name), options.label(name),
            ": is for a single body; a drive names its gears' files ",
            "by <gear>_file, what mesh writes by <gear>_mesh_output, and meshes of your own by <gear>_mesh");
  const bool worm = is_worm_drive(options);
  OptionTable of_worms = table_of(design_rows());
  for (const OptionSpec& spec : worm_table()) of_worms.push_back(spec);
  const std::vector<std::string> in_worms = given_of(options, of_worms),
                                 in_cylindrical = given_of(options, cylindrical_table());
  for (const std::string& name : worm ? in_cylindrical : in_worms)
    require(holds(worm ? in_worms : in_cylindrical, name) || holds(kShared, name) ||
                (worm && name == "wheel_teeth"),
            options.label(name), ": has no meaning in drive: ", worm ? "worm" : "cylindrical",
            "; docs/drives.md lists its keys");
}

}  // namespace

OptionTable drive_table() {
  OptionTable table = table_of(kDriveRows);
  for (const OptionTable& more :
       {cylindrical_table(), worm_table(), modification_table(), misalignment_table(), bearing_table()})
    table.insert(table.end(), more.begin(), more.end());
  return table;
}

OptionTable whole_drive_table() {
  OptionTable table = drive_table();
  for (OptionSpec spec : table_of(design_rows())) {
    if (holds(kOfParts, spec.name)) continue;
    spec.help = "drive: " + spec.help;
    if (spec.name != "size" && spec.name != "element_order" && spec.name != "refinement")
      spec.default_value.clear();
    table.push_back(spec);
  }
  return table;
}

void require_torque_of_side(const Options& options, const std::string& name, double torque) {
  const bool coasts = drive_start(options).coasts;
  require(torque >= 0, options.label(name), " = ", torque, " N m: would press other flanks together than ",
          coasts ? "side: coast" : "side: drive", " puts in touch; give ", -torque, " N m with -side ",
          coasts ? "drive" : "coast");
}

std::string drive_stem(const Options& options) {
  return options.files().empty() ? "drive" : std::filesystem::path(options.files()[0]).stem().string();
}

std::string body_file(const Options& options, const DriveMember& member) {
  const std::string option = member.name + "_file";
  return options.given(option) ? options.text(option) : member.name + ".h5";
}

std::string own_mesh(const Options& options, const std::string& gear) {
  const std::string option = gear + "_mesh";
  return options.given(option) ? options.text(option) : "";
}

drive::Start drive_start(const Options& options) {
  return {options.number("roll"), options.choice("side", {"drive", "coast"}) == 1};
}

bool is_drive(const Options& options) { return options.given("drive"); }

void require_drive(const Options& options, const std::string& verb) {
  if (is_drive(options)) return;
  const std::vector<std::string>& files = options.files();
  fail("needs a drive file: ",
       files.empty() ? "elastogear " + verb + " drive.yaml"
                     : join(files) + " has no line 'drive: cylindrical' or 'drive: worm'",
       " (docs/drives.md)");
}

Options with_gears(Options options) {
  if (!is_drive(options)) {
    for (const OptionSpec& spec : drive_table())
      require(!options.given(spec.name), options.label(spec.name),
              ": is for a drive; name its kind by 'drive: cylindrical' or 'drive: worm'");
    return options;
  }
  options.set_default("gears", is_worm_drive(options) ? "worm,wheel" : DriveChoices{}.gears);
  return options;
}

// A number alone is as likely meant in rpm as in rad/s.
void require_unit_of_speed(const Options& options) {
  if (!options.given("speed") || options.number("speed") == 0 || options.has_unit("speed")) return;
  const std::string value = options.text("speed");
  fail(options.label("speed"), " = ", value, ": write its unit, '", value, " rpm' or '", value, " rad/s'");
}

Drive read_drive(const Options& options) {
  require_unit_of_speed(options);
  refuse_others(options);
  refuse_counts(options);
  refuse_names_of_gears(options);
  refuse_keys_of_drive(options);
  Drive drive = is_worm_drive(options) ? worm_drive(options, drive_start(options))
                                       : cylindrical_drive(options, drive_start(options));
  for (DriveMember& member : drive.members) member.deviations = flank_deviations(options, member);
  misalign(options, drive);
  return drive;
}

Options member_options(const Options& options, const DriveMember& member) {
  Options own = options.of_section(member.name, kOfDrive);
  own.set_default("output", body_file(options, member));
  own.set_default("surface", "flanks");
  own.set_default("stress_nodes", "root");
  own.set_default("restrain", member.held);
  if (any_material(own) || !own_mesh(options, member.name).empty()) return own;
  print_detail("material", "steel: 210 GPa, nu 0.3, 7850 kg/m^3 (none is given)");
  return with_steel(own);
}

Options with_steel(Options options) {
  options.set_default("material_E", "210e9");
  options.set_default("material_nu", "0.3");
  options.set_default("material_rho", "7850");
  return options;
}

Options with_recovery(Options options, const Drive& drive) {
  options.set_default("result", drive_stem(options) + "_result.h5");
  options.set_default("output", drive_stem(options) + "_stress.h5");
  const bool chosen = !options.placeholder_values("stress_<body>").empty();
  for (const DriveMember& member : drive.members)
    if (!chosen) options.set_default("stress_" + member.name, "root");
  return options;
}

std::string drawing_file(const Options& options) {
  return options.given("drawing") ? options.text("drawing") : drive_stem(options) + ".svg";
}

void print_drive(const Drive& drive) {
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    print_item(drive.members[i].name, "");
    for (const drive::Fact& fact : drive.facts.members[i]) print_item("  " + fact.name, text(fact));
  }
  for (std::size_t i = 0; i < drive.pairs.size(); ++i) {
    print_item(pair_name(drive, drive.pairs[i]), "");
    for (const drive::Fact& fact : drive.facts.pairs[i]) print_item("  " + fact.name, text(fact));
  }
}

void print_facts(const Drive& drive) {
  if (is_verbose()) print_drive(drive);
}

}  // namespace elastogear::app
