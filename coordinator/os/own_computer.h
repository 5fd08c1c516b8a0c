// A robot's own computer, as far as the kernel can make one: a network with addresses and ports of
// its own, a host name, and files that name the others. Programs on it need nothing preloaded for
// that, and see it however they ask.
//
// Its network has a loopback interface, and `eth0`, whose packets go to and come from the device
// that its maker holds. TCP on it waits for nothing in the host's time but the handshake's first
// second: it acknowledges at once, retransmits what acknowledgements show to be missing, and leaves
// what takes a timeout to others.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct ComputerRequest {
  std::string name;                 // of the host
  std::string address;              // IPv4, of eth0
  std::vector<std::string> others;  // addresses that are reached over it
  std::string hosts_file;           // the text of its /etc/hosts
};

struct OwnComputer {
  UniqueFd network, host_name, files;  // its namespaces
  UniqueFd device;                     // reads and writes one packet at a time; does not wait
};

// Why a robot cannot have a computer of its own here.
struct NoComputer {
  std::string step;  // what the kernel has refused
  int error = 0;     // its errno

  // One sentence, for whoever has asked for a run with such robots.
  std::string Sentence() const;
  // What would allow it: a clause that begins with a verb.
  std::string Mend() const;
};

// Whether the kernel lets this process make a computer without a user namespace. A child tries it.
[[nodiscard]] bool MayMakeNamespaces();

// Comes before MakeComputer, in a process that is the only thread: where the kernel refuses
// namespaces, computers are made in a user namespace, which the process enters for good. Nothing on
// success.
[[nodiscard]] std::optional<NoComputer> GetReadyForComputers();

// A computer that lasts as long as its descriptors and its processes.
[[nodiscard]] std::variant<OwnComputer, NoComputer> MakeComputer(const ComputerRequest& request);

// Makes one in a process made for that, and lets it go again. Nothing if it works.
[[nodiscard]] std::optional<NoComputer> WhyNoComputer();

// The calling process, which must be the only thread, becomes one of that computer. It keeps its
// working directory. False: errno is set.
[[nodiscard]] bool EnterComputer(const OwnComputer& computer);

// Calls `make` while the calling thread is in that computer's network: sockets stay where they were
// made. False, with errno, if it could not enter.
[[nodiscard]] bool InNetworkOf(const OwnComputer& computer, const std::function<void()>& make);

}  // namespace tcs
