#pragma once
// The units of a sweep: chunks of the positions of a case, which ranks take one by one and keep in a folder
// until the whole sweep is there. They do not depend on each other nor on the number of ranks.

#include <optional>
#include <string>
#include <vector>

#include "elastogear/dynamics/sweep.h"
#include "elastogear/model/result.h"

namespace elastogear::app {

struct SweepUnit {
  std::size_t number = 0;  ///< of the case
  std::size_t chunk = 0;
};

/// Positions in a unit, at most: its first one costs five times as much as the others, and a killed sweep
/// goes on unit by unit.
inline constexpr std::size_t kUnitLength = 16;

/// Unit by unit, case by case.
std::vector<SweepUnit> sweep_units(std::size_t n_cases, std::size_t n_positions);

/// The positions of a unit, which counts its energies from the last position of the one before.
dynamics::SweepSettings unit_settings(const SweepUnit& unit, const std::vector<double>& positions);

/// What was found in one unit.
struct UnitResult {
  dynamics::SweepSummary summary;
  std::vector<model::Snapshot> snapshots;
};

/// The folder beside an output in which finished units are kept.
class UnitStore {
 public:
  explicit UnitStore(const std::string& output);

  const std::string& folder() const { return folder_; }
  /// The input of an earlier sweep that did not end; nothing where there is none.
  std::optional<std::map<std::string, std::string>> earlier_input() const;
  /// Removes what an earlier sweep has left, and keeps the input of this one.
  void begin(const std::map<std::string, std::string>& input) const;
  bool has(const SweepUnit& unit) const;
  bool has_units() const;
  void write(const SweepUnit& unit, UnitResult& result) const;
  /// Error when the unit is missing or damaged.
  UnitResult read(const SweepUnit& unit) const;
  /// Removes all, and the folder unless it holds other files.
  void remove() const;

 private:
  std::string path(const SweepUnit& unit) const;
  std::string input_path() const;

  std::string folder_;
};

}  // namespace elastogear::app
