#include "coordinator/view/auth.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

std::string PathOf(const std::string& rest, const std::string& token = kToken) {
  return "/" + token + "/" + rest;
}

TEST(AuthTest, WhoeverWasGivenTheAddressIsLetIn) {
  const Auth auth(kToken, "127.0.0.1", 8080);
  EXPECT_EQ(auth.url(), "http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/");
  const std::string path = PathOf("news");
  EXPECT_EQ(auth.Authorize({.path = path, .host = "127.0.0.1:8080"}), "news");
  EXPECT_EQ(auth.Authorize({.path = path, .host = "localhost:8080"}), "news");
  EXPECT_EQ(
      auth.Authorize({.path = path, .host = "127.0.0.1:8080", .origin = "http://127.0.0.1:8080"}),
      "news");
}

TEST(AuthTest, AnotherTokenIsRefusedHoweverAlike) {
  const Auth auth(kToken, "127.0.0.1", 8080);
  for (const std::string& token :
       {std::string("0123456789abcdef0123456789abcdee"),
        std::string("1123456789abcdef0123456789abcdef"), std::string(kToken) + "0",
        std::string(kToken).substr(1), std::string(kToken) + '\0', std::string()}) {
    const std::string path = PathOf("news", token);
    EXPECT_FALSE(auth.Authorize({.path = path, .host = "127.0.0.1:8080"})) << token;
  }
  for (const std::string& path :
       {std::string(), std::string("/"), std::string(kToken), std::string("/") + kToken}) {
    EXPECT_FALSE(auth.Authorize({.path = path, .host = "127.0.0.1:8080"})) << path;
  }
}

// A page of somebody else's whose name has come to stand for this machine names itself there.
TEST(AuthTest, AnotherHostIsRefused) {
  const Auth auth(kToken, "127.0.0.1", 8080);
  const std::string path = PathOf("");
  for (const char* host :
       {"", "evil.example:8080", "evil.example", "127.0.0.1", "127.0.0.1:8081", "localhost",
        "localhost.evil.example:8080", "192.0.2.7:8080", "127.0.0.1.evil.example:8080", "[::1:8080",
        ":8080", "127.0.0.1:8080:8080"}) {
    EXPECT_FALSE(auth.Authorize({.path = path, .host = host})) << host;
  }
}

TEST(AuthTest, AnotherOriginIsRefused) {
  const Auth auth(kToken, "127.0.0.1", 8080);
  const std::string path = PathOf("control");
  for (const char* origin :
       {"null", "http://evil.example", "http://127.0.0.1:8081", "https://127.0.0.1:8080",
        "http://localhost:8080", "http://127.0.0.1:8080.evil.example"}) {
    EXPECT_FALSE(auth.Authorize({.path = path, .host = "127.0.0.1:8080", .origin = origin}))
        << origin;
  }
}

TEST(AuthTest, WhatListensForOthersIsAskedForByNumbers) {
  const Auth auth(kToken, "0.0.0.0", 8080);
  const std::string path = PathOf("");
  EXPECT_TRUE(auth.Authorize({.path = path, .host = "192.0.2.7:8080"}));
  EXPECT_TRUE(auth.Authorize({.path = path, .host = "[2001:db8::1]:8080"}));
  EXPECT_FALSE(auth.Authorize({.path = path, .host = "evil.example:8080"}));
  EXPECT_EQ(Auth("t", "::1", 1).url(), "http://[::1]:1/t/");
}

TEST(AuthTest, TokensAreLongAndNeverTheSame) {
  const std::string token = MakeToken();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(token, MakeToken());
  EXPECT_TRUE(EqualsSecret(token, token));
}

}  // namespace
}  // namespace tcs
