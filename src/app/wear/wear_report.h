#pragma once
// What wear writes and prints.

#include <string>
#include <vector>

#include "app/wear/flank_wear.h"
#include "elastogear/io/wear_file.h"

namespace elastogear::app {

/// Course of the wear: what there is after each step.
struct WearCourse {
  std::vector<double> revolutions = {0};         ///< of the first gear
  std::vector<std::vector<double>> depth, mass;  ///< by gear, over the steps, m, kg
};

/// Adds the present state of the gears.
void note(WearCourse& course, const std::vector<WearingGear>& gears, double revolutions);

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
