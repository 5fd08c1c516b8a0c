#include "shm/own_receivers.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string_view>

namespace tcs::shm {
namespace {

struct UnixAddress {
  sockaddr_un name{};
  std::size_t size = 0;
};

// With `more` bytes behind the name, as far as it is said to reach.
UnixAddress Unix(std::string_view name, std::size_t more = 0) {
  UnixAddress address;
  address.name.sun_family = AF_UNIX;
  memcpy(address.name.sun_path, name.data(), name.size());
  address.size = offsetof(sockaddr_un, sun_path) + name.size() + more;
  return address;
}
ReceiverAddress Of(const UnixAddress& address) { return AddressOf(&address.name, address.size); }

ReceiverAddress Udp(const char* host, std::uint16_t port, char behind = 0) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, host, &address.sin_addr);
  memset(address.sin_zero, behind, sizeof address.sin_zero);
  return AddressOf(&address, sizeof address);
}

std::unique_ptr<OwnReceivers> Receivers(std::initializer_list<ReceiverAddress> addresses) {
  auto receivers = std::make_unique<OwnReceivers>();
  for (const ReceiverAddress& address : addresses) {
    receivers->addresses[receivers->count++] = address;
  }
  std::sort(receivers->addresses, receivers->addresses + receivers->count, IsBefore);
  return receivers;
}

constexpr std::string_view kAbstract("\0drone/motors", 13), kLonger("\0drone/motors2", 14);

TEST(OwnReceivers, AreFoundByTheirAddresses) {
  const auto receivers =
      Receivers({Of(Unix(kAbstract)), Udp("127.0.0.1", 47011), Of(Unix("/tmp/motors"))});
  EXPECT_NE(PlaceAmong(*receivers, Of(Unix(kAbstract))), kNoReceiver);
  EXPECT_NE(PlaceAmong(*receivers, Udp("127.0.0.1", 47011)), kNoReceiver);
  EXPECT_NE(PlaceAmong(*receivers, Of(Unix("/tmp/motors"))), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Of(Unix(kLonger))), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Of(Unix(kAbstract.substr(0, 12)))), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Udp("127.0.0.1", 47012)), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Udp("127.0.0.2", 47011)), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Of(Unix("/tmp/motor"))), kNoReceiver);
}

TEST(OwnReceivers, HavePlacesInTheirOrder) {
  const auto receivers =
      Receivers({Of(Unix("/tmp/motors")), Of(Unix(kAbstract)), Udp("127.0.0.1", 47011)});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(PlaceAmong(*receivers, receivers->addresses[i]), i);
}

TEST(OwnReceivers, AreKnownToHaveFiles) {
  EXPECT_TRUE(HasFile(Of(Unix("/tmp/motors"))));
  EXPECT_FALSE(HasFile(Of(Unix(kAbstract))));
  EXPECT_FALSE(HasFile(Udp("127.0.0.1", 47011)));
}

// As the kernel has it: a path ends with its first zero, an abstract name is as long as it is said
// to be, and what is behind a port is nothing.
TEST(OwnReceivers, AreToldByWhatTheKernelTellsThemBy) {
  const auto receivers =
      Receivers({Of(Unix(kAbstract)), Udp("127.0.0.1", 47011), Of(Unix("/tmp/motors"))});
  EXPECT_NE(PlaceAmong(*receivers, Of(Unix("/tmp/motors", 1))), kNoReceiver);
  EXPECT_NE(PlaceAmong(*receivers, Of(Unix("/tmp/motors", 50))), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*receivers, Of(Unix(kAbstract, 1))), kNoReceiver);
  EXPECT_NE(PlaceAmong(*receivers, Udp("127.0.0.1", 47011, 'x')), kNoReceiver);
}

TEST(OwnReceivers, DoNotIncludeWhatIsNoAddressOfTheirs) {
  const auto receivers = Receivers({Of(Unix(kAbstract))});
  EXPECT_EQ(PlaceAmong(*receivers, AddressOf(nullptr, 0)), kNoReceiver);
  const sa_family_t alone = AF_UNIX;
  EXPECT_EQ(PlaceAmong(*receivers, AddressOf(&alone, sizeof alone)), kNoReceiver);
  sockaddr_storage other{};
  other.ss_family = AF_INET6;
  EXPECT_EQ(PlaceAmong(*receivers, AddressOf(&other, sizeof other)), kNoReceiver);
  EXPECT_EQ(PlaceAmong(*Receivers({}), Of(Unix(kAbstract))), kNoReceiver);
}

}  // namespace
}  // namespace tcs::shm
