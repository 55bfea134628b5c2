#pragma once
// The options of recover.

#include <map>
#include <string>
#include <vector>

#include "app/options/options.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::app {

/// What the options ask for.
struct RecoverSettings {
  std::string result = {}, output = {};  ///< files: of the run, and of the stresses to write
  std::map<std::string, std::vector<std::string>> stress = {};  ///< by body, sets of nodes
  bool all_nodes = false;                ///< in CSV tables of large sets, not only the node of the peak
  std::vector<double> field_times = {};  ///< s; empty with `all_fields`
  bool all_fields = false;               ///< fields of all output times, or of every n-th
  int field_every = 1;                   ///< that n
  std::string fields = {};               ///< first part of the names of fields and of trees
  std::vector<int> box_levels = {};      ///< of the trees to write; the largest number: leaves
  int box_kdop = 24;                     ///< directions of the k-DOPs of these trees
  recovery::Acceleration mode_acceleration = recovery::Acceleration::automatic;
  bool error_estimate = true;
  std::map<std::string, std::string> body_file = {};  ///< by body, where the result names another place
};

/// Says whether fields are wanted.
inline bool has_fields(const RecoverSettings& s) { return s.all_fields || !s.field_times.empty(); }

/// Rows for the options of recover.
OptionTable recover_table();

RecoverSettings recover_settings(const Options& options);

}  // namespace elastogear::app
