#include "elastogear/drive/reduce.h"

namespace elastogear::drive {

reduction::ReductionOptions reduction_options(const Member& member, const model::Material& material) {
  reduction::ReductionOptions options;
  options.name = member.name;
  options.regions = {{"", material}};
  options.restrain = {member.held};
  options.surface = {"flanks"};
  options.stress_nodes = {"root"};
  options.n_modes = 0;
  options.flexibility = true;
  return options;
}

}  // namespace elastogear::drive
