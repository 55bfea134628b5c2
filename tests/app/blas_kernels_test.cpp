// The program names the kernels of OpenBLAS that use the instructions of a processor.
#include "app/console/blas_kernels.h"

#include <gtest/gtest.h>

namespace elastogear::app::blas_kernels_test {
namespace {

TEST(BlasKernels, are_those_with_the_instructions_of_the_processor) {
  EXPECT_EQ(faster_core("Prescott", Instructions::avx512), "SKYLAKEX");
  EXPECT_EQ(faster_core("Prescott", Instructions::avx2), "HASWELL");
  EXPECT_EQ(faster_core("Haswell", Instructions::avx512), "SKYLAKEX");
  EXPECT_EQ(faster_core("Zen", Instructions::avx512), "SKYLAKEX");
}

TEST(BlasKernels, that_use_the_processor_stay) {
  EXPECT_EQ(faster_core("Prescott", Instructions::portable), "");
  EXPECT_EQ(faster_core("Haswell", Instructions::avx2), "");
  EXPECT_EQ(faster_core("Zen", Instructions::portable), "");
  EXPECT_EQ(faster_core("SkylakeX", Instructions::avx512), "");
}

TEST(BlasKernels, of_another_library_or_a_later_processor_stay) {
  for (const char* core : {"", "Sapphirerapids", "Zen6"})
    EXPECT_EQ(faster_core(core, Instructions::avx512), "");
}

}  // namespace
}  // namespace elastogear::app::blas_kernels_test
