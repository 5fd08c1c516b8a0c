#include "coordinator/network/robot_network.h"

#include <errno.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>
#include <variant>

#include "coordinator/os/file_errors.h"

namespace tcs {

namespace {

constexpr std::size_t kLargestPacket = 65536;

// The file has each robot by its name, and the names that every computer knows.
std::string HostsFile(const Scenario& scenario) {
  std::string text = "127.0.0.1\tlocalhost\n::1\tlocalhost ip6-localhost ip6-loopback\n";
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    text += scenario.network->addresses[i] + "\t" + scenario.robots[i].name + "\n";
  }
  return text;
}

}  // namespace

std::string RobotNetwork::Open(const Scenario& scenario) {
  if (!scenario.network) return {};
  addresses_ = scenario.network->addresses;
  const std::string hosts = HostsFile(scenario);
  for (std::size_t i = 0; i < addresses_.size(); ++i) {
    names_.push_back(scenario.robots[i].name);
    ComputerRequest request{.name = scenario.robots[i].name,
                            .address = addresses_[i],
                            .others = addresses_,
                            .hosts_file = hosts};
    request.others.erase(request.others.begin() + static_cast<std::ptrdiff_t>(i));
    auto made = MakeComputer(request);
    if (auto* why_not = std::get_if<NoComputer>(&made)) return why_not->Sentence();
    computers_.push_back(std::move(std::get<OwnComputer>(made)));
  }
  wire_.emplace(*scenario.network);
  return {};
}

std::vector<int> RobotNetwork::fds() const {
  std::vector<int> fds;
  for (const OwnComputer& computer : computers_) fds.push_back(computer.device.get());
  return fds;
}

void RobotNetwork::Take(std::size_t robot, VirtualTime at) {
  std::array<std::byte, kLargestPacket> packet;
  for (;;) {
    const ssize_t size = read(computers_[robot].device.get(), packet.data(), packet.size());
    if (size <= 0) return;
    wire_->Send(robot, std::span(packet).first(static_cast<std::size_t>(size)), at);
  }
}

// A packet that a kernel has no memory for is lost there.
void RobotNetwork::Arrive(VirtualTime now) {
  wire_->Arrive(now, [this](std::size_t robot, std::span<const std::byte> packet) {
    const ssize_t written = write(computers_[robot].device.get(), packet.data(), packet.size());
    static_cast<void>(written);
  });
}

std::string RobotNetwork::WriteCounts(const std::string& folder) const {
  const std::string path = folder + "/network.csv";
  std::error_code ignored;
  std::filesystem::remove(path, ignored);  // an earlier run's
  if (!present()) return {};
  errno = 0;
  std::ofstream csv(path);
  csv << "from,to,packets,bytes,lost,dropped\n";
  for (std::size_t from = 0; from < names_.size(); ++from) {
    for (std::size_t to = 0; to < names_.size(); ++to) {
      if (from == to) continue;
      const NetworkLink::Counts& counts = wire_->Between(from, to).counts();
      csv << names_[from] << ',' << names_[to] << ',' << counts.packets << ',' << counts.bytes
          << ',' << counts.lost << ',' << counts.dropped << '\n';
    }
  }
  csv.close();
  return csv ? std::string() : CannotBeWritten(path);
}

void RobotNetwork::MakeAt(const std::string& address, const std::function<void()>& make) const {
  const auto found = std::find(addresses_.begin(), addresses_.end(), address);
  if (found == addresses_.end() ||
      !InNetworkOf(computers_[static_cast<std::size_t>(found - addresses_.begin())], make)) {
    make();
  }
}

}  // namespace tcs
