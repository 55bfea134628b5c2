#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "sample_body.h"

namespace elastogear::written_responses_test {
using namespace io;
using testing::HasSubstr;

namespace {

// Static responses of all five surface nodes, whose columns are written in two pieces.
struct WrittenResponses : testing::Test {
  mesh::Folder folder{"responses"};
  std::string path = folder / "worm.h5";
  model::ElasticBody body = sample_modal_body();
  model::Flexibility whole;
  const Eigen::MatrixXd modes = sample_modes();
  std::unique_ptr<BodyWriter> writer =
      std::make_unique<BodyWriter>(path, static_cast<int>(modes.rows() / 3), static_cast<int>(modes.cols()));

  void SetUp() override {
    whole.node = {0, 1, 2, 3, 4};
    whole.surface = model::no_images(5);
    whole.stress = model::no_images(2);
    whole.stress_row = {0, 1};
    whole.F = Eigen::MatrixXf::Random(15, 15);
    whole.G = Eigen::MatrixXf::Random(12, 15);
    model::set_self(whole);
    for (int k = 0; k < modes.cols(); ++k) writer->write_mode(k, modes.col(k));
  }

  void write_columns(int first, int n) {
    writer->write_responses(whole, whole.F.middleCols(first, n), whole.G.middleCols(first, n));
  }

  void finish() {
    body.flexibility = whole;
    body.flexibility.F = body.flexibility.G = {};
    body.flexibility.read_F = writer->written_responses();
    writer->finish(body, sample_source());
  }
};

TEST_F(WrittenResponses, in_pieces_are_in_the_file_as_whole_ones_are) {
  write_columns(0, 6);
  write_columns(6, 9);
  for (int orbit = 0; orbit < 5; ++orbit)
    EXPECT_EQ(writer->written_responses()(orbit), whole.F.middleCols<3>(3 * orbit));
  finish();
  const std::string other = folder / "whole.h5";
  body.flexibility = whole;
  write_modal(other, body, modes);
  for (const std::string& file : {path, other}) {
    const model::Flexibility read = read_body(file).flexibility;
    EXPECT_EQ(read.self, whole.self);
    for (int orbit = 0; orbit < 5; ++orbit) {
      EXPECT_EQ(model::displacement_columns(read, orbit), whole.F.middleCols<3>(3 * orbit));
      EXPECT_EQ(read_stress_responses(file, orbit), whole.G.middleCols<3>(3 * orbit));
    }
  }
}

TEST_F(WrittenResponses, that_lack_columns_make_no_file) {
  write_columns(0, 6);
  EXPECT_THAT(test::message_of([&] { finish(); }), HasSubstr("not those of the body"));
  writer.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(WrittenResponses, beyond_the_last_force_and_without_value_are_errors) {
  write_columns(0, 6);
  whole.F(3, 7) = NAN;
  EXPECT_THAT(test::message_of([&] { write_columns(6, 9); }), HasSubstr("not finite"));
  whole.F(3, 7) = 0;
  write_columns(6, 9);
  EXPECT_THAT(test::message_of([&] { write_columns(0, 3); }), HasSubstr("came to more"));
}

}  // namespace
}  // namespace elastogear::written_responses_test
