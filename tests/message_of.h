#pragma once
// What an action that is to fail says.

#include <string>

#include "elastogear/base/error.h"

namespace elastogear::test {

/// The message of the Error that it throws, "no error" when it throws none.
template <class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace elastogear::test
