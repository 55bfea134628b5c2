// The program knows a process that a launcher has started by its environment.
#include "app/console/lone_process.h"

#include <gtest/gtest.h>

namespace elastogear::app::lone_process_test {
namespace {

TEST(LoneProcess, is_told_from_those_of_launchers) {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE=2", "PMIX_RANK=0", "PMI_FD=7", "SLURM_PROCID=3"})
    EXPECT_TRUE(is_of_launcher(variable)) << variable;
  for (const char* variable :
       {"HOME=/PMIX_RANK", "OMPI_MCA_orte_tmpdir_base=/tmp", "OMPI_MCA_pml=cm", "PMI", ""})
    EXPECT_FALSE(is_of_launcher(variable)) << variable;
}

}  // namespace
}  // namespace elastogear::app::lone_process_test
