// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "pellucid/scene/error.h"

/// Expects that the call throws pellucid::Error with a message of one line that holds every part.
template <class Call>
void expect_error(Call&& call, std::initializer_list<const char*> parts) {
  try {
    call();
  } catch (const pellucid::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const char* part : parts) {
      EXPECT_NE(message.find(part), std::string::npos)
          << "expected \"" << part << "\" in: " << message;
    }
    return;
  }
  ADD_FAILURE() << "no error was thrown; expected one with \"" << *parts.begin() << "\"";
}

/// Returns the message of the pellucid::Error that the call throws; empty if it throws none.
template <class Call>
std::string error_message(Call&& call) {
  try {
    call();
  } catch (const pellucid::Error& error) {
    return error.what();
  }
  return {};
}
