#pragma once
// Outputs of evaluate beside the HDF5 file: CSV tables, the JSON summary and what is printed.

#include <map>
#include <string>
#include <vector>

#include "app/evaluate/cases.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/evaluation_file.h"

namespace elastogear::app {

/// The items of one pair in one case, paths below it.
struct PairFigures {
  std::string pair;  ///< "pinion:wheel"
  std::vector<io::EvaluationItem> items;
};

/// A case with all that was read off it.
struct CaseFigures {
  Case of;
  std::vector<PairFigures> pairs;
  std::vector<io::EvaluationItem> bearings;  ///< loads, deflections and their orders, by bearing
  std::vector<io::EvaluationItem> sensors;   ///< order spectra
  std::vector<std::string> notes;
};

/// The item at a path; nullptr where there is none.
const io::EvaluationItem* find_item(const std::vector<io::EvaluationItem>& items, const std::string& path);

/// A table that is to be written.
struct NamedTable {
  std::string path;
  std::vector<io::CsvColumn> columns;
};

/// The tables of a pair, named after `stem`.
std::vector<NamedTable> pair_tables(const std::string& stem, const std::vector<io::EvaluationItem>& items);

/// Loads and deflections of bearings over the roll angle, and the amplitudes of their orders; none without
/// bearings.
std::vector<NamedTable> bearing_tables(const std::string& stem, const CaseFigures& of);

/// Writes one row a case with all single numbers.
void write_cases_table(const std::string& path, const std::vector<CaseFigures>& cases);

/// Writes all single numbers and words of all cases as JSON.
void write_summary(const std::string& path, const std::string& drive, const std::vector<CaseFigures>& cases);

/// Pa, sum of all estimated errors of a largest stress ("root/pinion/largest_tension"); 0 where that of the
/// reduction or of the mesh is not known.
double whole_error(const std::vector<io::EvaluationItem>& items, const std::string& path);
/// "410 +- 79" in MPa, of Pa: the last digit of both is the second one of the error. Without an error the
/// value alone.
std::string with_error(double value, double error);

/// What figures are read with that the results do not say.
struct Surroundings {
  std::map<std::string, std::string> kind = {};  ///< of gears that are equal and have equal mates: planets
  std::string loaded_flanks = "drive";           ///< or "coast"
  std::string finer = {};                        ///< size of a finer mesh; empty: there is none
  bool chosen_by_accuracy = false;               ///< is the mesh that of option accuracy?

  /// That of a gear, its own name where it is one of a kind.
  std::string kind_of(const std::string& gear) const;
};

/// Has one of the gears of a pair ("pinion:wheel") bearings, whose deflection is in the motion of the gears?
bool is_in_bearings(const CaseFigures& of, const std::string& pair);

/// Prints what an engineer looks for, on one screen: numbers rounded, gears of one kind summed up.
void print_case_in_short(const CaseFigures& of, const Surroundings& about);
/// Prints all figures.
void print_figures(const CaseFigures& of);
/// Prints one line a case.
void print_cases(const std::vector<CaseFigures>& cases);

}  // namespace elastogear::app
