#include "coordinator/view/launch.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(ViewAddressTest, IsAPortAnAddressOrBoth) {
  struct Case {
    const char* text;
    const char* address;
    int port;
  };
  for (const Case& one : {Case{"", "127.0.0.1", 0}, Case{"8080", "127.0.0.1", 8080},
                          Case{"192.0.2.7", "192.0.2.7", 0}, Case{"192.0.2.7:80", "192.0.2.7", 80},
                          Case{"[::1]", "::1", 0}, Case{"[::1]:8080", "::1", 8080}}) {
    ViewRequest request;
    EXPECT_EQ(TakeViewAddress(one.text, &request), "") << one.text;
    EXPECT_EQ(request.address, one.address) << one.text;
    EXPECT_EQ(request.port, one.port) << one.text;
  }
}

TEST(ViewAddressTest, WhatIsNoneIsSaid) {
  for (const char* text : {"65536", "-1", "http://a", "localhost:80", "192.0.2:80", "192.0.2.7:",
                           "192.0.2.7:x", "[::1", "[::1]8080", "::1", ":8080", "[192.0.2.7]:80"}) {
    ViewRequest request;
    EXPECT_NE(TakeViewAddress(text, &request).find("is not a place to listen at"),
              std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace tcs
