#include "app/console/lone_process.h"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace elastogear::app {

bool is_of_launcher(std::string_view variable) {
  constexpr std::array<std::string_view, 5> kBeginnings{"OMPI_COMM_", "PMIX_", "PMI_", "SLURM_PROCID",
                                                        "ALPS_"};
  return std::any_of(kBeginnings.begin(), kBeginnings.end(), [&](std::string_view beginning) {
    return variable.substr(0, beginning.size()) == beginning;
  });
}

bool start_alone() {
  constexpr int kKeep = 0;  // what the user has set
  for (char** variable = environ; variable && *variable; ++variable)
    if (is_of_launcher(*variable)) return false;
  setenv("OMPI_MCA_pml", "ob1", kKeep);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", kKeep);
  setenv("OMPI_MCA_orte_create_session_dirs", "false", kKeep);
  return MPI_Init(nullptr, nullptr) == MPI_SUCCESS;
}

}  // namespace elastogear::app
