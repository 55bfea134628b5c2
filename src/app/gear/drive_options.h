#pragma once
// Options of a drive file: several gears, their assembly and load. Every verb reads it and takes from it what
// it needs, so that meshes, bodies and places belong together.

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

/// The rows of drive files besides those of gear data.
OptionTable drive_table();
/// The same with those of gear data that drives share: for verbs that have none of their own.
OptionTable whole_drive_table();

/// The drive file's name without its end.
std::string drive_stem(const Options& options);
/// The member's body file.
std::string body_file(const Options& options, const DriveMember& member);

/// The file of a mesh of one's own for this gear; empty: the data make it.
std::string own_mesh(const Options& options, const std::string& gear);

/// Its roll angle and the flanks in touch.
drive::Start drive_start(const Options& options);

/// Throws Error for a torque on the first gear at rest, N m, that presses flanks together which side does not
/// put in touch. name: of its option.
void require_torque_of_side(const Options& options, const std::string& name, double torque);

/// Is this the run of a drive file?
bool is_drive(const Options& options);
/// Throws Error where the options are not those of a drive file, which this verb needs.
void require_drive(const Options& options, const std::string& verb);

/// Options with the names of the drive's gears, to be checked by reject_unknown.
Options with_gears(Options options);

/// Throws Error, naming value and remedy, for drives that do not exist.
Drive read_drive(const Options& options);

/// Options of a member for `reduce`: its section, then what the drive says where nothing is given. A mesh of
/// one's own may have materials in its file and gets none here.
Options member_options(const Options& options, const DriveMember& member);

/// Options with the material of gears where none is given.
Options with_steel(Options options);

/// Options with result, stress file and stresses at the roots of all members where nothing is given.
Options with_recovery(Options options, const Drive& drive);

/// The SVG file that `mesh` draws the drive in.
std::string drawing_file(const Options& options);

/// Table of the drive's numbers, on rank 0.
void print_drive(const Drive& drive);
/// The same as a detail.
void print_facts(const Drive& drive);

}  // namespace elastogear::app
