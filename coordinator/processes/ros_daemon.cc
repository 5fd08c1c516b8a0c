#include "coordinator/processes/ros_daemon.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include "coordinator/os/socket_tables.h"

namespace tcs {

namespace {

constexpr std::uint16_t kFirstPort = 11511;  // the port of domain 0
constexpr unsigned kMostDomain = 232;

struct Command {
  std::string_view name;
  std::string_view silent_verbs;  // verbs that ask no daemon
};
constexpr Command kCommands[] = {
    {"action", " send_goal echo "},
    {"component", " types standalone "},
    {"lifecycle", ""},
    {"node", ""},
    {"param", ""},
    {"service", " call echo "},
    {"topic", " hz bw delay pub "},
};

std::string ContentsOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The texts of a file that ends each of them with a zero.
std::vector<std::string> TextsOf(const std::string& file) {
  std::istringstream in(ContentsOf(file));
  std::vector<std::string> texts;
  for (std::string text; std::getline(in, text, '\0');) texts.push_back(text);
  return texts;
}

std::string DomainOf(pid_t pid) {
  constexpr std::string_view kName = "ROS_DOMAIN_ID=";
  for (const std::string& variable : TextsOf(fmt::format("/proc/{}/environ", pid))) {
    if (variable.starts_with(kName)) return variable.substr(kName.size());
  }
  return {};
}

bool IsRos2(const std::string& argument) {
  return argument == "ros2" || argument.ends_with("/ros2");
}

}  // namespace

std::optional<std::uint16_t> PortOfRosDaemon(const std::vector<std::string>& arguments,
                                             const std::string& domain) {
  // The command is behind its interpreter, if it has one.
  const auto last = arguments.begin() + std::min<std::ptrdiff_t>(2, std::ssize(arguments));
  const auto begin = std::find_if(arguments.begin(), last, IsRos2);
  if (begin == last || arguments.end() - begin < 3) return std::nullopt;
  const auto* const command =
      std::find_if(std::begin(kCommands), std::end(kCommands),
                   [&](const Command& each) { return each.name == begin[1]; });
  if (command == std::end(kCommands) ||
      command->silent_verbs.find(" " + begin[2] + " ") != std::string_view::npos ||
      std::find(begin, arguments.end(), "--no-daemon") != arguments.end()) {
    return std::nullopt;
  }
  unsigned number = 0;
  std::from_chars(domain.data(), domain.data() + domain.size(), number);
  if (number > kMostDomain) return std::nullopt;
  return static_cast<std::uint16_t>(kFirstPort + number);
}

std::uint64_t ListenerAt(const std::string& table, std::uint16_t port) {
  for (const InternetSocket& socket : InternetSocketsOf(table)) {
    const bool is_here = socket.local.host == "127.0.0.1" || socket.local.IsAny();
    if (socket.listens && is_here && socket.local.port == port) return socket.inode;
  }
  return 0;
}

void RosDaemon::Begins(pid_t pid) {
  if (has_warned_) return;
  const std::string folder = fmt::format("/proc/{}/", pid);
  const std::vector<std::string> arguments = TextsOf(folder + "cmdline");
  if (!PortOfRosDaemon(arguments, "").has_value()) return;
  const auto port = PortOfRosDaemon(arguments, DomainOf(pid));
  const std::uint64_t listener =
      port.has_value() ? ListenerAt(ContentsOf(folder + "net/tcp"), *port) : 0;
  if (listener == 0 || peers_.IsOfRun(listener)) return;
  has_warned_ = true;
  const std::size_t command = IsRos2(arguments[0]) ? 1 : 2;
  run_.Warn(
      fmt::format("`ros2 {} {}` asks the ros2 daemon at 127.0.0.1:{}, which was started outside of "
                  "the run and knows nothing of it: end it (`ros2 daemon stop`), or give the "
                  "command --no-daemon",
                  arguments[command], arguments[command + 1], *port));
}

}  // namespace tcs
