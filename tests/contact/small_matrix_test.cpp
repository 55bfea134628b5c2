#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "elastogear/contact/small_matrix.h"

namespace elastogear::contact::small_matrix_test {
namespace {

using Small = SmallMatrix<double, 3, Eigen::Dynamic, 6>;
using SmallVector = SmallMatrix<int, Eigen::Dynamic, 1, 2>;

Eigen::Matrix3Xd numbers(Eigen::Index cols) {
  return Eigen::VectorXd::LinSpaced(3 * cols, 1, static_cast<double>(3 * cols)).reshaped(3, cols);
}

bool lies_in_object(const Small& small) {
  const auto* object = reinterpret_cast<const char*>(&small);
  const auto* data = reinterpret_cast<const char*>(small.data());
  return data >= object && data < object + sizeof(Small);
}

TEST(SmallMatrix, has_few_entries_in_itself_and_many_outside) {
  EXPECT_TRUE(lies_in_object(Small(numbers(2))));
  EXPECT_FALSE(lies_in_object(Small(numbers(3))));
  EXPECT_EQ(Small().cols(), 0);
  EXPECT_EQ(SmallVector().size(), 0);
}

TEST(SmallMatrix, takes_values_and_size_of_what_is_assigned) {
  Small small;
  for (const Eigen::Index cols : {1, 4, 2, 0, 3}) {
    small = numbers(cols);
    EXPECT_EQ(Eigen::Matrix3Xd(small), numbers(cols)) << cols;
  }
  SmallVector vector = Eigen::Vector3i(5, 6, 7);
  vector = Eigen::Vector2i(1, 2);
  EXPECT_EQ(Eigen::VectorXi(vector), Eigen::VectorXi(Eigen::Vector2i(1, 2)));
}

TEST(SmallMatrix, may_be_assigned_what_depends_on_it) {
  Small small = numbers(2);
  small = small.rowwise().sum() * Eigen::RowVector3d::Ones();
  EXPECT_EQ(Eigen::Matrix3Xd(small), Eigen::Matrix3Xd(Eigen::Vector3d(5, 7, 9) * Eigen::RowVector3d::Ones()));
}

TEST(SmallMatrix, copies_are_apart) {
  for (const Eigen::Index cols : {2, 3}) {
    Small small = numbers(cols);
    Small copy = small;
    copy(0, 0) = -1;
    EXPECT_EQ(Eigen::Matrix3Xd(small), numbers(cols));
    small = copy;
    copy.setZero();
    EXPECT_EQ(small(0, 0), -1);
  }
}

TEST(SmallMatrix, moves_leave_what_can_be_assigned_again) {
  for (const Eigen::Index cols : {2, 3}) {
    Small small = numbers(cols);
    Small moved = std::move(small);
    EXPECT_EQ(Eigen::Matrix3Xd(moved), numbers(cols));
    small = numbers(4);  // NOLINT(bugprone-use-after-move)
    moved = std::move(small);
    EXPECT_EQ(Eigen::Matrix3Xd(moved), numbers(4));
  }
}

TEST(SmallMatrix, follows_its_object_in_vectors) {
  std::vector<Small> all;
  for (Eigen::Index cols = 0; cols < 5; ++cols) all.emplace_back(numbers(cols));
  for (Eigen::Index cols = 0; cols < 5; ++cols)
    EXPECT_EQ(Eigen::Matrix3Xd(all[static_cast<std::size_t>(cols)]), numbers(cols));
}

}  // namespace
}  // namespace elastogear::contact::small_matrix_test
