#include "elastogear/base/archive.h"

#include <gtest/gtest.h>

#include <limits>

namespace elastogear::archive_test {
using elastogear::Archive;
using elastogear::Error;

namespace {

struct State {
  double x = 0;
  int n = 0;
  bool flag = false;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::MatrixXd M;
  std::vector<std::vector<int>> lists;

  void visit(Archive& archive) {
    archive(x);
    archive(n);
    archive(flag);
    archive(v);
    archive(M);
    archive(lists);
  }
};

State sample() {
  return {std::numeric_limits<double>::denorm_min(),
          -7,
          true,
          {1, -0.0, 1.0 / 3},
          Eigen::MatrixXd::Random(2, 5),
          {{}, {3, 1}}};
}

std::vector<double> recorded(State state) {
  Archive archive;
  state.visit(archive);
  return archive.numbers();
}

TEST(Archive, gives_back_what_it_recorded_to_the_bit) {
  const State original = sample();
  State state;
  Archive archive(recorded(original));
  state.visit(archive);
  archive.finish();
  EXPECT_EQ(recorded(state), recorded(original));
  EXPECT_EQ(state.n, -7);
  EXPECT_TRUE(std::signbit(state.v[1]));
  EXPECT_EQ(state.lists.size(), 2u);
}

TEST(Archive, refuses_a_state_of_another_shape) {
  std::vector<double> numbers = recorded(sample());
  State state;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    Archive cut(std::vector<double>(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n)));
    EXPECT_THROW(state.visit(cut), Error) << n;
  }
  numbers.push_back(0);
  Archive longer(numbers);
  state.visit(longer);
  EXPECT_THROW(longer.finish(), Error);
}

}  // namespace
}  // namespace elastogear::archive_test
