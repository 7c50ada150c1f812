// SPDX-License-Identifier: Apache-2.0
#include "view/server/access_control.h"

#include <gtest/gtest.h>

#include <set>

namespace pellucid::view::gate_test {
namespace {

constexpr const char* host = "127.0.0.1:8080";
constexpr const char* origin = "http://127.0.0.1:8080";

class GateTest : public testing::Test {
 protected:
  bool admits(const Caller& caller) const { return gate.admit(caller).has_value(); }

  const AccessControl gate{"0123abcd", 8080};
};

TEST_F(GateTest, AdmitsItsPage) {
  EXPECT_EQ(gate.address(), "http://127.0.0.1:8080/0123abcd/");
  EXPECT_EQ(gate.admit({"/0123abcd/", host, {}, false}), "/");
  EXPECT_EQ(gate.admit({"/0123abcd/style.css", "localhost:8080", {}, false}), "/style.css");
  EXPECT_EQ(gate.admit({"/0123abcd/main.js", host, origin, false}), "/main.js");
  EXPECT_EQ(gate.admit({"/0123abcd/socket", host, origin, true}), "/socket");
  EXPECT_TRUE(admits({"/0123abcd/socket", "localhost:8080", "http://localhost:8080", true}));
}

TEST_F(GateTest, RefusesOtherTokens) {
  for (const char* target : {"/", "", "/socket", "/0123abcd", "/0123abce/", "/0123abcd0/", "//",
                             "0123abcd/", "/0123ABCD/", "/?token=0123abcd", "/x/0123abcd/"}) {
    EXPECT_FALSE(admits({target, host, {}, false})) << target;
    EXPECT_FALSE(admits({target, host, origin, true})) << target;
  }
}

TEST_F(GateTest, RefusesOtherHosts) {
  EXPECT_FALSE(admits({"/0123abcd/", {}, {}, false}));
  for (const char* other : {"", "127.0.0.1", "127.0.0.1:80", "localhost", "evil.example:8080",
                            "127.0.0.1:8080.evil.example", "127.0.0.1:8080 ", "[::1]:8080"}) {
    EXPECT_FALSE(admits({"/0123abcd/", other, {}, false})) << other;
    // Not even where the origin says the same: the name may resolve to us (DNS rebinding).
    const std::string same = std::string("http://") + other;
    EXPECT_FALSE(admits({"/0123abcd/socket", other, same, true})) << other;
  }
}

TEST_F(GateTest, RefusesOtherOrigins) {
  for (const char* other : {"", "null", "http://evil.example", "https://127.0.0.1:8080",
                            "http://127.0.0.1:8081", "http://localhost:8080",
                            "http://127.0.0.1:8080.evil.example", "127.0.0.1:8080", "file://"}) {
    EXPECT_FALSE(admits({"/0123abcd/socket", host, other, true})) << other;
    EXPECT_FALSE(admits({"/0123abcd/", host, other, false})) << other;
  }
}

TEST_F(GateTest, RefusesSocketsWithoutAnOrigin) {
  EXPECT_FALSE(admits({"/0123abcd/socket", host, {}, true}));
}

TEST(Token, HasTheBitsAndIsAlwaysAnother) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 64U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100U);
}

TEST(EqualInConstantTime, ComparesTexts) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
  EXPECT_FALSE(equal_in_constant_time("abc", "Abc"));
}

}  // namespace
}  // namespace pellucid::view::gate_test
