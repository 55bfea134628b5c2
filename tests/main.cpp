// One main for all tests: starts MPI/PETSc/SLEPc, silences ranks > 0 unless they fail, returns the worst
// rank's result.
//   test_<folder> [a_test.cpp ...]   runs the tests of these sources, or all
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "elastogear/base/petsc.h"

namespace {

// The filter of GoogleTest that chooses the tests of a source; empty where there is none.
std::string tests_of(const std::string& source) {
  std::string filter;
  const auto& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const auto& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const auto& test = *suite.GetTestInfo(j);
      if (std::filesystem::path(test.file()).filename() == source)
        filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  std::string filter;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const std::string tests = tests_of(argv[i]);
    if (tests.empty()) {
      fprintf(stderr, "%s: no test comes from %s\n", argv[0], argv[i]);
      return 1;
    }
    filter += tests;
  }
  if (!filter.empty() && GTEST_FLAG_GET(filter) == "*") GTEST_FLAG_SET(filter, filter);
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
