#include "coordinator/view/admission.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

std::string PathOf(const std::string& rest, const std::string& token = kToken) {
  return "/" + token + "/" + rest;
}

TEST(AdmissionTest, WhoeverWasGivenTheAddressIsLetIn) {
  const Admission admission(kToken, "127.0.0.1", 8080);
  EXPECT_EQ(admission.url(), "http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/");
  const std::string path = PathOf("news");
  EXPECT_EQ(admission.Admit({.path = path, .host = "127.0.0.1:8080"}), "news");
  EXPECT_EQ(admission.Admit({.path = path, .host = "localhost:8080"}), "news");
  EXPECT_EQ(
      admission.Admit({.path = path, .host = "127.0.0.1:8080", .origin = "http://127.0.0.1:8080"}),
      "news");
}

TEST(AdmissionTest, AnotherTokenIsRefusedHoweverAlike) {
  const Admission admission(kToken, "127.0.0.1", 8080);
  for (const std::string& token :
       {std::string("0123456789abcdef0123456789abcdee"),
        std::string("1123456789abcdef0123456789abcdef"), std::string(kToken) + "0",
        std::string(kToken).substr(1), std::string(kToken) + '\0', std::string()}) {
    const std::string path = PathOf("news", token);
    EXPECT_FALSE(admission.Admit({.path = path, .host = "127.0.0.1:8080"})) << token;
  }
  for (const std::string& path :
       {std::string(), std::string("/"), std::string(kToken), std::string("/") + kToken}) {
    EXPECT_FALSE(admission.Admit({.path = path, .host = "127.0.0.1:8080"})) << path;
  }
}

// A page of somebody else's whose name has come to stand for this machine names itself there.
TEST(AdmissionTest, AnotherHostIsRefused) {
  const Admission admission(kToken, "127.0.0.1", 8080);
  const std::string path = PathOf("");
  for (const char* host :
       {"", "evil.example:8080", "evil.example", "127.0.0.1", "127.0.0.1:8081", "localhost",
        "localhost.evil.example:8080", "192.0.2.7:8080", "127.0.0.1.evil.example:8080", "[::1:8080",
        ":8080", "127.0.0.1:8080:8080"}) {
    EXPECT_FALSE(admission.Admit({.path = path, .host = host})) << host;
  }
}

TEST(AdmissionTest, AnotherOriginIsRefused) {
  const Admission admission(kToken, "127.0.0.1", 8080);
  const std::string path = PathOf("wish");
  for (const char* origin :
       {"null", "http://evil.example", "http://127.0.0.1:8081", "https://127.0.0.1:8080",
        "http://localhost:8080", "http://127.0.0.1:8080.evil.example"}) {
    EXPECT_FALSE(admission.Admit({.path = path, .host = "127.0.0.1:8080", .origin = origin}))
        << origin;
  }
}

TEST(AdmissionTest, WhatListensForOthersIsAskedForByNumbers) {
  const Admission admission(kToken, "0.0.0.0", 8080);
  const std::string path = PathOf("");
  EXPECT_TRUE(admission.Admit({.path = path, .host = "192.0.2.7:8080"}));
  EXPECT_TRUE(admission.Admit({.path = path, .host = "[2001:db8::1]:8080"}));
  EXPECT_FALSE(admission.Admit({.path = path, .host = "evil.example:8080"}));
  EXPECT_EQ(Admission("t", "::1", 1).url(), "http://[::1]:1/t/");
}

TEST(AdmissionTest, TokensAreLongAndNeverTheSame) {
  const std::string token = MakeToken();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(token, MakeToken());
  EXPECT_TRUE(EqualsSecret(token, token));
}

}  // namespace
}  // namespace tcs
