#pragma once
// The tables of damage and life that the verb life prints, and its results for the file.

#include <string>
#include <vector>

#include "app/life/life_inputs.h"
#include "elastogear/io/life_file.h"

namespace elastogear::app {

/// A gear's set with its figures.
struct LifeOfSet {
  io::LifeSet set;
  double ratio = 1;       ///< size of its revolutions over those of the first gear
  bool laid = true;       ///< from one pitch
  int pitches = 1;        ///< of the sweep
  double difference = 0;  ///< Pa, between what teeth bear at the same place of a pitch
  double largest = 0;     ///< Pa, stress of largest size in the duty cycle
  std::string body_file = {};
};

struct LifeReport {
  std::vector<life::Block> blocks;
  std::vector<SweptTorque> swept;
  std::vector<LifeOfSet> sets;
};

/// Files that are written besides the life file, by the name of the latter.
std::vector<std::string> side_files(const std::string& output, const LifeReport& report, bool field);

/// Writes tables, summary (JSON) and fields.
void write_side_files(const std::string& output, const LifeReport& report, bool field);

void print_life(const LifeReport& report);

}  // namespace elastogear::app
