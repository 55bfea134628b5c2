// The worm and the wheel by cyclic symmetry.
#include "cyclic_body.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::cyclic_gears_test {
namespace {

using namespace test;

TEST(Cyclic, modes_of_a_wheel_are_those_of_the_whole) {
  const Body body{gear::wheel_mesh({}, gear::wheel_counts(gear::Size::tiny)),
                  {"bore"},
                  {{"body", kSteel}, {"rim", {110e9, 0.34, 8800}}},
                  41};
  expect_equals_the_general_path(body, 60);
}

TEST(Cyclic, modes_of_a_worm_are_those_of_the_whole) {
  const Body body{gear::worm_mesh({}, gear::worm_counts(gear::Size::tiny)), {"seats"}, kSteelBody, 2};
  expect_equals_the_general_path(body, 40);
}

}  // namespace
}  // namespace elastogear::cyclic_gears_test
