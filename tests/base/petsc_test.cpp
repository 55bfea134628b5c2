#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/version.h"

namespace elastogear::petsc_test {
namespace {

using test::message_of;

std::vector<int*> destroyed;

PetscErrorCode note_destruction(int** object) {
  destroyed.push_back(*object);
  *object = nullptr;
  return 0;
}

using Counted = Handle<int*, note_destruction>;

class HandleTest : public testing::Test {
 protected:
  void SetUp() override { destroyed.clear(); }
  int object = 0, other = 0;
};

TEST_F(HandleTest, destroys_its_object_once) {
  { Counted handle(&object); }
  EXPECT_EQ(destroyed, std::vector<int*>{&object});
}

TEST_F(HandleTest, destroys_nothing_when_empty) {
  { Counted handle; }
  EXPECT_TRUE(destroyed.empty());
}

TEST_F(HandleTest, moves_ownership_and_does_not_copy) {
  static_assert(!std::is_copy_constructible_v<Counted> && !std::is_copy_assignable_v<Counted>);
  Counted first(&object);
  {
    Counted second(std::move(first));
    EXPECT_EQ(second.get(), &object);
    EXPECT_EQ(first.get(), nullptr);  // NOLINT: a handle that was moved from is null
  }
  EXPECT_EQ(destroyed, std::vector<int*>{&object});
}

TEST_F(HandleTest, assignment_destroys_both_objects_once) {
  {
    Counted first(&object), second(&other);
    first = std::move(second);
    EXPECT_EQ(first.get(), &other);
  }
  EXPECT_EQ(destroyed, (std::vector<int*>{&object, &other}));
}

TEST_F(HandleTest, out_destroys_what_was_held) {
  Counted handle(&object);
  int** place = handle.out();
  EXPECT_EQ(destroyed, std::vector<int*>{&object});
  EXPECT_EQ(*place, nullptr);
}

TEST(Handle, holds_a_petsc_object_that_petsc_functions_take) {
  UniqueVec x;
  check(VecCreateSeq(PETSC_COMM_SELF, 3, x.out()));
  check(VecSet(x, 2.0));
  PetscReal norm = 0;
  check(VecNorm(x, NORM_1, &norm));
  EXPECT_EQ(norm, 6.0);
}

TEST(Check, passes_success) { EXPECT_NO_THROW(check(0)); }

TEST(Check, names_the_petsc_function_its_reason_and_the_call_site) {
  UniqueVec x, y;
  check(VecCreateSeq(PETSC_COMM_SELF, 3, x.out()));
  check(VecCreateSeq(PETSC_COMM_SELF, 4, y.out()));
  const std::string message = message_of([&] { check(VecCopy(x, y)); });
  EXPECT_NE(message.find("VecCopy"), std::string::npos) << message;
  EXPECT_NE(message.find("local size 3"), std::string::npos) << message;
  EXPECT_NE(message.find("petsc_test.cpp"), std::string::npos) << message;
}

TEST(Check, does_not_repeat_an_earlier_message) {
  UniqueVec x, y;
  check(VecCreateSeq(PETSC_COMM_SELF, 3, x.out()));
  check(VecCreateSeq(PETSC_COMM_SELF, 4, y.out()));
  message_of([&] { check(VecCopy(x, y)); });
  EXPECT_EQ(message_of([] { check(PETSC_ERR_USER); }).find("VecCopy"), std::string::npos);
}

TEST(Guard, runs_its_body_and_returns_success) {
  std::exception_ptr pending;
  bool ran = false;
  EXPECT_EQ(guard(pending, [&] { ran = true; }), 0);
  EXPECT_TRUE(ran);
  EXPECT_FALSE(pending);
}

TEST(Guard, keeps_the_exception_and_check_rethrows_it_once) {
  std::exception_ptr pending;
  const PetscErrorCode code = guard(pending, [] { fail("contact is too deep"); });
  EXPECT_NE(code, 0);
  EXPECT_EQ(message_of([&] { check(code, pending); }), "contact is too deep");
  EXPECT_FALSE(pending);
  EXPECT_NO_THROW(check(0, pending));
}

TEST(Guard, carries_an_exception_through_a_petsc_solver) {
  std::exception_ptr pending;
  UniqueMat A;
  UniqueVec x, y;
  check(MatCreateShell(PETSC_COMM_SELF, 2, 2, 2, 2, &pending, A.out()));
  const auto multiply = [](Mat shell, Vec, Vec) {
    void* context = nullptr;
    MatShellGetContext(shell, &context);
    return guard(*static_cast<std::exception_ptr*>(context), [] { fail("thrown in a callback"); });
  };
  PetscErrorCode (*callback)(Mat, Vec, Vec) = multiply;
  check(MatShellSetOperation(A, MATOP_MULT, reinterpret_cast<void (*)()>(callback)));
  check(MatCreateVecs(A, x.out(), y.out()));
  EXPECT_EQ(message_of([&] { check(MatMult(A, x, y), pending); }), "thrown in a callback");
}

TEST(Version, is_three_numbers) {
  int major = -1, minor = -1, patch = -1;
  EXPECT_EQ(std::sscanf(version(), "%d.%d.%d", &major, &minor, &patch), 3);
  EXPECT_FALSE(std::string(git_hash()).empty());
}

}  // namespace
}  // namespace elastogear::petsc_test
