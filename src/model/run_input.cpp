#include "elastogear/model/run_input.h"

namespace elastogear::model {

const std::vector<std::string>& analysis_names() {
  static const std::vector<std::string> names = {"dynamic", "static", "relax", "sweep"};
  return names;
}

}  // namespace elastogear::model
