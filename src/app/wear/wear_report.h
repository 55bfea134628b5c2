#pragma once
// What wear writes and prints.

#include <string>
#include <vector>

#include "app/wear/flank_wear.h"
#include "elastogear/io/wear_file.h"

namespace elastogear::app {

/// What a revolution of the first gear takes off: largest depth, m, and mass of all teeth, kg, by gear.
struct WearRates {
  std::vector<double> depth = {}, mass = {};
};

/// Course of the wear: what there is after each step.
struct WearCourse {
  std::vector<double> revolutions = {0};         ///< of the first gear
  std::vector<std::vector<double>> depth, mass;  ///< by gear, over the steps, m, kg
  WearRates first = {};                          ///< of unworn flanks
  /// Estimated errors by the mesh, as shares of depth and mass, by gear. Empty: there is no coarser mesh.
  WearRates error = {};
  int limited_by = -1;  ///< gear whose depth has ended the run; -1: the revolutions have
};

/// Errors at the end are as large a share as those of unworn flanks, Eq. (10.15) to (10.18), depths and
/// masses each a kind. Where a depth has ended the run, the revolutions have the share of that depth.
/// on_coarser: rates on coarser meshes; refinement: of all meshes, ascending.
void estimate_errors(WearCourse& course, std::vector<WearRates> on_coarser,
                     const std::vector<double>& refinement);

/// Adds the present state of the gears.
void note(WearCourse& course, const std::vector<WearingGear>& gears, double revolutions);

/// A path without the end of its name.
std::string without_end(const std::string& output);

/// The CSV file of the worn flanks of a gear, <gear>_wear of the drive file; output: the wear file.
std::string worn_flanks_file(const std::string& output, const std::string& gear);
/// Writes it: heights at the middles of the cells.
void write_worn_flanks(const std::string& path, const WearingGear& gear);

/// The files besides these: table of the course, summary.
std::vector<std::string> course_files(const std::string& output);
void write_course(const std::string& output, const WearCourse& course, const std::vector<WearingGear>& gears,
                  const std::string& why);

io::WearFile wear_file(const WearCourse& course, const std::vector<WearingGear>& gears);

void print_wear(const WearCourse& course, const std::vector<WearingGear>& gears, const std::string& why);

}  // namespace elastogear::app
