#include "coordinator/channel/unix/unix_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

namespace tcs {
namespace {

using testing::HasSubstr;

class UnixSocketTest : public testing::Test {
 protected:
  UnixSocketTest() {
    char folder[] = "/tmp/tcs-unix-XXXXXX";
    folder_ = mkdtemp(folder);
  }
  ~UnixSocketTest() override { std::filesystem::remove_all(folder_); }

  UnixName Name(const std::string& file) const { return {.name = folder_ + "/" + file}; }
  static UnixSocket Bound(const UnixName& name) {
    return std::get<UnixSocket>(UnixSocket::Bind(name));
  }
  static std::string Complaint(const UnixName& name) {
    const auto result = UnixSocket::Bind(name);
    const auto* error = std::get_if<std::string>(&result);
    return error == nullptr ? "" : *error;
  }

  std::string folder_;
};

TEST_F(UnixSocketTest, CarriesDatagramsOfAnyLength) {
  for (const UnixName& name : {Name("s"), UnixName{"tcs-test" + folder_, true}}) {
    UnixSocket receiver = Bound(name);
    UnixSocket sender = std::get<UnixSocket>(UnixSocket::ForSending());
    EXPECT_TRUE(receiver.ReceiveAll().empty());
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100'000}}) {
      ASSERT_TRUE(sender.SendTo(name, std::string(size, 'x')));
    }
    const std::vector<std::string> all = receiver.ReceiveAll();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0], "");
    EXPECT_EQ(all[1], "x");
    EXPECT_EQ(all[2], std::string(100'000, 'x'));
    EXPECT_TRUE(receiver.ReceiveAll().empty());
  }
}

TEST_F(UnixSocketTest, TakesItsFileAlong) {
  { const UnixSocket socket = Bound(Name("s")); }
  EXPECT_FALSE(std::filesystem::exists(Name("s").name));
}

TEST_F(UnixSocketTest, MovesWithItsFile) {
  UnixSocket first = Bound(Name("s"));
  {
    const UnixSocket second(std::move(first));
    EXPECT_TRUE(std::filesystem::exists(Name("s").name));
  }
  EXPECT_FALSE(std::filesystem::exists(Name("s").name));
}

TEST_F(UnixSocketTest, WhatIsInItsWayIsNamed) {
  const UnixSocket holder = Bound(Name("s"));
  EXPECT_THAT(Complaint(Name("s")), HasSubstr("is taken by another program; end that program"));
  EXPECT_TRUE(IsListenedTo(Name("s")));
  std::ofstream(Name("file").name) << "kept";
  EXPECT_THAT(Complaint(Name("file")), HasSubstr("exists and is not a socket"));
  EXPECT_TRUE(std::filesystem::exists(Name("file").name));
  EXPECT_THAT(Complaint(Name("nowhere/s")), HasSubstr("its folder does not exist"));
  const UnixName abstract{"tcs-test2" + folder_, true};
  const UnixSocket other = Bound(abstract);
  EXPECT_THAT(Complaint(abstract), HasSubstr("'@tcs-test2" + folder_ + "' is taken"));
}

TEST_F(UnixSocketTest, SendingToNobodyIsNoError) {
  UnixSocket sender = std::get<UnixSocket>(UnixSocket::ForSending());
  EXPECT_FALSE(sender.SendTo(Name("nobody"), "x"));
  EXPECT_FALSE(IsListenedTo(Name("nobody")));
}

}  // namespace
}  // namespace tcs
