// The program asks the libraries for kernels and pages that suit a verb, but for what its user has asked for.
#include "app/console/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace elastogear::app::environment_test {
namespace {

constexpr const char* kPages = "GLIBC_TUNABLES";

// A variable has a value, or none, while this lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) { value ? setenv(name_, value, 1) : unsetenv(name_); }

  const char* name_;
  std::optional<std::string> before_ = {};
};

bool asks_for_pages(const std::string& verb) {
  const auto settings = missing_settings(verb);
  return std::any_of(settings.begin(), settings.end(), [](const auto& s) { return s.first == kPages; });
}

TEST(Environment, has_large_pages_where_large_matrices_are_made) {
  const Variable none(kPages, nullptr);
  EXPECT_TRUE(asks_for_pages("reduce"));
  EXPECT_FALSE(asks_for_pages("simulate"));
}

TEST(Environment, that_the_user_has_set_stays) {
  const Variable pages(kPages, "glibc.malloc.hugetlb=0"), kernels("OPENBLAS_CORETYPE", "Nehalem");
  EXPECT_TRUE(missing_settings("reduce").empty());
}

}  // namespace
}  // namespace elastogear::app::environment_test
