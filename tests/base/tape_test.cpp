#include "elastogear/base/tape.h"

#include <gtest/gtest.h>

#include <limits>

using elastogear::Error;
using elastogear::Tape;

namespace {

struct State {
  double x = 0;
  int n = 0;
  bool flag = false;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::MatrixXd M;
  std::vector<std::vector<int>> lists;

  void visit(Tape& tape) {
    tape(x);
    tape(n);
    tape(flag);
    tape(v);
    tape(M);
    tape(lists);
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
  Tape tape;
  state.visit(tape);
  return tape.numbers();
}

}  // namespace

TEST(Tape, gives_back_what_it_recorded_to_the_bit) {
  const State original = sample();
  State state;
  Tape tape(recorded(original));
  state.visit(tape);
  tape.finish();
  EXPECT_EQ(recorded(state), recorded(original));
  EXPECT_EQ(state.n, -7);
  EXPECT_TRUE(std::signbit(state.v[1]));
  EXPECT_EQ(state.lists.size(), 2u);
}

TEST(Tape, refuses_a_state_of_another_shape) {
  std::vector<double> numbers = recorded(sample());
  State state;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    Tape cut(std::vector<double>(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n)));
    EXPECT_THROW(state.visit(cut), Error) << n;
  }
  numbers.push_back(0);
  Tape longer(numbers);
  state.visit(longer);
  EXPECT_THROW(longer.finish(), Error);
}
