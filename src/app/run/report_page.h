#pragma once
// The report page of a run, made by scripts/report.py.

#include <string>

namespace elastogear::app {

/// Files of a run that its page shows.
struct PageInputs {
  std::string drive, result, evaluation;
  bool picture = false;  ///< the bodies in three dimensions, which body files of surfaces alone cannot give
};

/// Makes `page`, unless it is there of the same files. Returns why it could not be made; empty: it is there.
std::string make_page(const PageInputs& of, const std::string& page);

}  // namespace elastogear::app
