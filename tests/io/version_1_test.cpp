// Files of version 1, without checksums and with text of variable length: written by elastogear 17c2e82.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastogear/io/body_file.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"

namespace elastogear::version_1_test {
using namespace io;
using testing::AllOf;
using testing::HasSubstr;

namespace {

const std::string folder = IO_TESTS "/version_1/";

TEST(Version1, of_a_body_is_read) {
  const auto body = read_body(folder + "body.h5");
  EXPECT_EQ(body.n_q(), 3);
  EXPECT_FALSE(body.assembled_K || body.assembled_M);  // the file does not say it
  EXPECT_EQ(body.provenance.at("git_hash"), "17c2e8296de7");
  EXPECT_EQ(body.flexibility.node.size(), 6u);
  EXPECT_EQ(read_stress_responses(folder + "body.h5", 0).cols(), 3);
  EXPECT_EQ(read_displacement_field(folder + "body.h5", Eigen::Vector3d(1, 0, 0)).cols(), 12);
  EXPECT_THAT(describe(folder + "body.h5"), HasSubstr("elastogear body, version 1"));
}

TEST(Version1, of_a_result_is_read) {
  EXPECT_EQ(read_times(folder + "result.h5").size(), 6);
  EXPECT_THAT(describe(folder + "result.h5"),
              AllOf(HasSubstr("elastogear result, version 1"), HasSubstr("peak force: 30.5984 N")));
  EXPECT_EQ(read_contacts(folder + "result.h5", "high:low").back().size(), 4u);
}

TEST(Version1, of_a_stress_file_is_read) {
  const StressFile history = read_stress(folder + "stress.h5");
  EXPECT_NEAR(history.sets.at(0).von_mises.maxCoeff(), 86884.3, 0.1);
  EXPECT_THAT(describe(folder + "stress.h5"), HasSubstr("elastogear stress, version 1"));
}

}  // namespace
}  // namespace elastogear::version_1_test
