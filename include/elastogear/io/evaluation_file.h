#pragma once
// The evaluation file (HDF5, docs/file_format.md): figures and curves that are read off a drive. Written by
// evaluate, read by info and scripts.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace elastogear::io {

/// One figure, curve or table.
struct EvaluationItem {
  std::string path;                     ///< "drive_result/pinion:wheel/transmission_error/mean", below /cases
  std::string unit;                     ///< "1" for none
  std::string meaning;                  ///< one line
  std::vector<std::size_t> shape = {};  ///< empty: a number
  std::vector<double> value = {};       ///< row-major
  std::vector<std::string> words = {};  ///< in place of numbers, as a list
};

struct EvaluationFile {
  std::vector<EvaluationItem> items;
  std::map<std::string, std::string> provenance;
};

/// Error when numbers do not fit their shape, are not finite, or a path is there twice; the file appears only
/// when complete.
void write_evaluation(const std::string& path, const EvaluationFile& evaluation);
EvaluationFile read_evaluation(const std::string& path);

}  // namespace elastogear::io
