#include "elastogear/io/evaluation_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../message_of.h"
#include "elastogear/io/describe.h"
#include "sample_body.h"

namespace elastogear::io::evaluation_file_test {
namespace {

using testing::HasSubstr;

struct EvaluationFileTest : testing::Test {
  mesh::Folder folder{"evaluation_file"};
  EvaluationFile evaluation;

  EvaluationFileTest() {
    evaluation.items = {
        {"a/pinion:wheel/error/loaded", "m", "by how much it leads", {3}, {1e-6, 2e-6, -3e-6}},
        {"a/pinion:wheel/error/mean", "m", "its mean", {}, {0.5e-6}},
        {"a/pinion:wheel/teeth/share", "1", "shares", {2, 2}, {1, 0, 0.25, 0.75}},
        {"a/result", "1", "file", {1}, {}, {"a.h5"}}};
    evaluation.provenance = {{"verb", "evaluate"}};
  }
};

TEST_F(EvaluationFileTest, gives_back_what_was_written) {
  write_evaluation(folder / "a.h5", evaluation);
  const EvaluationFile read = read_evaluation(folder / "a.h5");
  ASSERT_EQ(read.items.size(), evaluation.items.size());
  EXPECT_EQ(read.provenance, evaluation.provenance);
  for (std::size_t i = 0; i < read.items.size(); ++i) {
    EXPECT_EQ(read.items[i].path, evaluation.items[i].path);
    EXPECT_EQ(read.items[i].unit, evaluation.items[i].unit);
    EXPECT_EQ(read.items[i].meaning, evaluation.items[i].meaning);
    EXPECT_EQ(read.items[i].shape, evaluation.items[i].shape);
    EXPECT_EQ(read.items[i].value, evaluation.items[i].value);
    EXPECT_EQ(read.items[i].words, evaluation.items[i].words);
  }
}

TEST_F(EvaluationFileTest, is_described) {
  write_evaluation(folder / "a.h5", evaluation);
  const std::string text = describe(folder / "a.h5");
  EXPECT_THAT(text, HasSubstr("a/pinion:wheel/error/mean: 5e-07 m (its mean)"));
  EXPECT_THAT(text, HasSubstr("a/pinion:wheel/teeth/share: 2 x 2 numbers"));
  EXPECT_THAT(text, HasSubstr("a/result: a.h5"));
}

TEST_F(EvaluationFileTest, holds_only_what_is_finite_and_fits_its_shape) {
  const auto refusal = [&](const EvaluationItem& item) {
    EvaluationFile wrong = evaluation;
    wrong.items.push_back(item);
    return test::message_of([&] { write_evaluation(folder / "b.h5", wrong); });
  };
  EXPECT_THAT(refusal({"b", "m", "", {2}, {1}}), HasSubstr("has 1 numbers, its shape holds 2"));
  EXPECT_THAT(refusal({"b", "m", "", {}, {NAN}}), HasSubstr("is not finite"));
  EXPECT_THAT(refusal({"a/result", "1", "", {}, {1}}), HasSubstr("is there twice"));
  EXPECT_THAT(refusal({"/b", "1", "", {}, {1}}), HasSubstr("no path"));
  EXPECT_EQ(refusal({"b", "1", "", {}, {1}}), "no error");
}

}  // namespace
}  // namespace elastogear::io::evaluation_file_test
