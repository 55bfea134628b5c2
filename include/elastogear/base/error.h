#pragma once
// The one exception a user can cause, and the check that throws it.

#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

namespace elastogear {

/// An error that a user can cause: it says what, where, which value, and what is allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the exception says; where memory lacks, what helps.
inline std::string failure_text(const std::exception& error) {
  if (!dynamic_cast<const std::bad_alloc*>(&error)) return error.what();
  return "out of memory; take a coarser mesh, fewer modes or nodes, fewer ranks, or a machine with more of "
         "it";
}

/// Throws Error with the parts streamed into one message.
template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream message;
  message.precision(10);
  (message << ... << parts);
  throw Error(message.str());
}

/// Throws Error unless `condition` holds. The parts are only formatted on failure.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
  if (!condition) fail(parts...);
}

}  // namespace elastogear
