#include "coordinator/channel/udp/udp_socket.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <cerrno>
#include <utility>

namespace tcs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

UdpSocket Bound(std::uint16_t port = 0) {
  return std::get<UdpSocket>(UdpSocket::Bind({"127.0.0.1", port}));
}

std::optional<Datagram> Received(UdpSocket* socket) {
  return std::get<std::optional<Datagram>>(socket->Receive());
}

// One that was sent: the kernel may hand it over later.
std::optional<Datagram> Awaited(UdpSocket* socket) {
  pollfd readable{socket->fd(), POLLIN, 0};
  poll(&readable, 1, 60'000);
  return Received(socket);
}

SocketError WhyNotBound(const UdpEndpoint& endpoint) {
  const auto result = UdpSocket::Bind(endpoint);
  const auto* error = std::get_if<SocketError>(&result);
  return error != nullptr ? *error : SocketError{};
}

TEST(UdpSocket, CarriesDatagramsOneByOne) {
  UdpSocket receiver = Bound();
  UdpSocket sender = std::get<UdpSocket>(UdpSocket::ForSending());
  ASSERT_FALSE(sender.SendTo(receiver.LocalEndpoint(), "first"));
  ASSERT_FALSE(sender.SendTo(receiver.LocalEndpoint(), ""));
  ASSERT_FALSE(sender.SendTo(receiver.LocalEndpoint(), std::string(65507, 'x')));

  const auto first = Awaited(&receiver);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->payload, "first");
  EXPECT_EQ(first->from.host, "127.0.0.1");
  EXPECT_EQ(first->from.port, sender.LocalEndpoint().port);
  for (const std::string& expected : {std::string(), std::string(65507, 'x')}) {
    const auto next = Awaited(&receiver);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->payload, expected);
  }
}

TEST(UdpSocket, DoesNotWait) {
  UdpSocket socket = Bound();
  EXPECT_EQ(Received(&socket), std::nullopt);
}

TEST(UdpSocket, IsNotInheritedByPrograms) {
  const UdpSocket socket = Bound();
  EXPECT_NE(fcntl(socket.fd(), F_GETFD) & FD_CLOEXEC, 0);
}

TEST(UdpSocket, ATakenPortIsNamed) {
  const UdpSocket holder = Bound();
  const UdpEndpoint endpoint = holder.LocalEndpoint();
  const SocketError error = WhyNotBound(endpoint);
  EXPECT_EQ(error.error_number, EADDRINUSE);
  EXPECT_THAT(error.message, HasSubstr("port " + std::to_string(endpoint.port) +
                                       " on 127.0.0.1 is taken by another program; choose"));
}

TEST(UdpSocket, FreesItsPort) {
  std::uint16_t port = 0;
  {
    const UdpSocket holder = Bound();
    port = holder.LocalEndpoint().port;
  }
  EXPECT_EQ(Bound(port).LocalEndpoint().port, port);
}

TEST(UdpSocket, ForeignAddressesAreExplained) {
  EXPECT_THAT(WhyNotBound({"192.0.2.1", 47010}).message, HasSubstr("no such address"));
  EXPECT_THAT(WhyNotBound({"localhost", 47010}).message,
              HasSubstr("'localhost' is not an IPv4 address"));
  UdpSocket socket = Bound();
  EXPECT_THAT(socket.SendTo({"nowhere", 1}, "x")->message, HasSubstr("not an IPv4 address"));
}

TEST(UdpSocket, DatagramsTooLongAreExplained) {
  UdpSocket socket = Bound();
  const auto error = socket.SendTo(socket.LocalEndpoint(), std::string(65508, 'x'));
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, AllOf(HasSubstr("65508 bytes"), HasSubstr("longer than a UDP")));
}

TEST(UdpSocket, SendingToNobodyIsNoError) {
  std::uint16_t port = 0;
  {
    const UdpSocket gone = Bound();
    port = gone.LocalEndpoint().port;
  }
  UdpSocket socket = Bound();
  EXPECT_FALSE(socket.SendTo({"127.0.0.1", port}, "x"));
  EXPECT_FALSE(socket.SendTo({"127.0.0.1", port}, "x"));
  EXPECT_EQ(Received(&socket), std::nullopt);
}

TEST(UdpSocket, IsListenedToWhileItIsOpen) {
  UdpEndpoint endpoint;
  {
    const UdpSocket open = Bound();
    endpoint = open.LocalEndpoint();
    EXPECT_TRUE(IsListenedTo(endpoint));
    // Somebody has the port, on another address.
    EXPECT_FALSE(IsListenedTo({"127.0.0.2", endpoint.port}));
  }
  EXPECT_FALSE(IsListenedTo(endpoint));
  // Not this machine's to know.
  EXPECT_TRUE(IsListenedTo({"192.0.2.1", endpoint.port}));
  const auto any = UdpSocket::Bind({"0.0.0.0", 0});
  EXPECT_TRUE(IsListenedTo({"127.0.0.1", std::get<UdpSocket>(any).LocalEndpoint().port}));
}

TEST(UdpSocket, MovesWithItsDescriptor) {
  UdpSocket first = Bound();
  const int fd = first.fd();
  UdpSocket second(std::move(first));
  EXPECT_EQ(second.fd(), fd);
  UdpSocket third = Bound();
  third = std::move(second);
  EXPECT_EQ(third.fd(), fd);
  EXPECT_EQ(Received(&third), std::nullopt);
}

}  // namespace
}  // namespace tcs
