#pragma once
// YAML files as options: nested keys are joined by '_', lists become "a,b,c".

#include <string>
#include <vector>

namespace elastogear::app {

struct YamlEntry {
  std::string name, value;  ///< "ts_dt", "1e-7"
  int line = 0;             ///< of the key, from 1
  bool merged = false;      ///< came by a merge key <<: what the map says itself wins
};

/// Every key of the text of a YAML file, each once, in the order of the file. Anchors, aliases, merge keys
/// and keys that begin with $$ (only there to hold an anchor) are understood. Throws Error that begins with
/// `file` and the line for what is no YAML, no map of keys, and for keys that are given twice.
std::vector<YamlEntry> parse_yaml(const std::string& text, const std::string& file);

}  // namespace elastogear::app
