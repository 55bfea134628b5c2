// One main for all tests: starts MPI/PETSc/SLEPc, silences ranks > 0 unless they fail, returns the worst
// rank's result.
#include <gtest/gtest.h>

#include "elastogear/base/petsc.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  elastogear::Session session(argc, argv);
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank > 0)
    delete testing::UnitTest::GetInstance()->listeners().Release(
        testing::UnitTest::GetInstance()->listeners().default_result_printer());
  int mine = RUN_ALL_TESTS();
  if (rank > 0 && mine != 0) fprintf(stderr, "rank %d: a test failed\n", rank);
  int worst = 0;
  MPI_Allreduce(&mine, &worst, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return worst;
}
