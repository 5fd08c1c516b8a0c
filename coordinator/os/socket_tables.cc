#include "coordinator/os/socket_tables.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>

namespace tcs {

namespace {

template <class Number>
std::optional<Number> FromHex(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string TextOf(int family, const void* address) {
  char text[INET6_ADDRSTRLEN] = "";
  inet_ntop(family, address, text, sizeof text);
  constexpr std::string_view kMapped = "::ffff:";
  std::string host = text;
  const bool is_mapped = host.starts_with(kMapped) && host.find('.') != std::string::npos;
  return is_mapped ? host.substr(kMapped.size()) : host;
}

// An address as the kernel writes it: words of the host's byte order in hexadecimal digits.
std::optional<InternetAddress> AddressOf(std::string_view text) {
  constexpr std::size_t kWord = 8;
  const std::size_t colon = text.find(':');
  if (colon != kWord && colon != 4 * kWord) return std::nullopt;
  std::array<std::uint32_t, 4> words{};
  for (std::size_t i = 0; i * kWord < colon; ++i) {
    const auto word = FromHex<std::uint32_t>(text.substr(i * kWord, kWord));
    if (!word.has_value()) return std::nullopt;
    words[i] = *word;
  }
  const auto port = FromHex<std::uint16_t>(text.substr(colon + 1));
  if (!port.has_value()) return std::nullopt;
  return InternetAddress{TextOf(colon == kWord ? AF_INET : AF_INET6, words.data()), *port};
}

// Calls `take` with the lines behind the first.
template <class Take>
void ForEachLine(std::string_view table, Take take) {
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) take(line);
}

}  // namespace

std::string InternetAddress::Text() const {
  const bool is_six = host.find(':') != std::string::npos;
  return (is_six ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

InternetAddress AddressIn(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    sockaddr_in four;
    memcpy(&four, &address, sizeof four);
    return {TextOf(AF_INET, &four.sin_addr), ntohs(four.sin_port)};
  }
  sockaddr_in6 six;
  memcpy(&six, &address, sizeof six);
  return {TextOf(AF_INET6, &six.sin6_addr), ntohs(six.sin6_port)};
}

std::vector<InternetSocket> InternetSocketsOf(std::string_view table) {
  constexpr std::string_view kListens = "0A";
  std::vector<InternetSocket> sockets;
  ForEachLine(table, [&](const std::string& line) {
    std::istringstream in(line);
    std::string number, local, remote, state, queues, timer, unanswered, user, timeout;
    std::uint64_t inode = 0;
    in >> number >> local >> remote >> state >> queues >> timer >> unanswered >> user >> timeout >>
        inode;
    const auto here = AddressOf(local), there = AddressOf(remote);
    if (in && here && there) sockets.push_back({*here, *there, state == kListens, inode});
  });
  return sockets;
}

std::vector<UnixSocket> UnixSocketsOf(std::string_view table) {
  constexpr std::uint64_t kAcceptsConnections = 0x10000;  // __SO_ACCEPTCON
  std::vector<UnixSocket> sockets;
  ForEachLine(table, [&](const std::string& line) {
    std::istringstream in(line);
    std::string number, uses, protocol, flags, type, state, name;
    UnixSocket socket;
    in >> number >> uses >> protocol >> flags >> type >> state >> socket.inode;
    if (!in) return;
    in.ignore(1);
    std::getline(in, socket.name);
    socket.listens = (FromHex<std::uint64_t>(flags).value_or(0) & kAcceptsConnections) != 0;
    sockets.push_back(std::move(socket));
  });
  return sockets;
}

int DescriptorsOfSocket(pid_t pid, std::uint64_t inode) {
  const std::string wanted = "socket:[" + std::to_string(inode) + "]";
  std::error_code unreadable;
  const std::filesystem::directory_iterator descriptors("/proc/" + std::to_string(pid) + "/fd",
                                                        unreadable);
  return static_cast<int>(
      std::count_if(begin(descriptors), end(descriptors), [&](const auto& each) {
        return std::filesystem::read_symlink(each.path(), unreadable).string() == wanted;
      }));
}

std::vector<std::string> OwnAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return addresses;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr) continue;
    const int family = each->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    sockaddr_storage address{};
    memcpy(&address, each->ifa_addr,
           family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
    addresses.push_back(AddressIn(address).host);
  }
  freeifaddrs(first);
  return addresses;
}

}  // namespace tcs
