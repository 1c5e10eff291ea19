// What is said where something is refused.
#pragma once

#include <catch2/catch.hpp>
#include <string>

namespace photile::test {

/// The message of the Failure that an action throws, one line; the test fails where it throws none.
template <class Failure, class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Failure& error) {
    const std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    return message;
  }
  FAIL("nothing was thrown");
  return {};
}

}  // namespace photile::test
