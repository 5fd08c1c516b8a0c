// A robot's own computer, as far as the kernel can make one: a network with addresses and ports of
// its own, a host name, and files that name the other computers. Programs on such a computer need
// nothing preloaded for that, and see it however they ask.
//
// The computer's network has a loopback interface, and `eth0`, whose packets go to and come from
// the device that the computer's maker holds. TCP there waits for nothing in the host's time but
// the handshake's first second. TCP acknowledges at once, retransmits what acknowledgements show to
// be missing, and leaves to others what takes a timeout.
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
  std::vector<std::string> others;  // addresses that are reached over eth0
  std::string hosts_file;           // the text of its /etc/hosts
};

struct OwnComputer {
  UniqueFd network, host_name, files;  // the computer's namespaces
  UniqueFd device;                     // reads and writes one packet at a time; does not wait
};

// Why a robot cannot have a computer of its own here.
struct NoComputer {
  std::string step;  // the step that the kernel has refused
  int error = 0;     // the kernel's errno

  // One sentence, for the user who has asked for a run with such robots.
  std::string Sentence() const;
  // The remedy: a clause that begins with a verb.
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

// Makes a computer in a process made for that, and lets the computer go again. Nothing if that
// works.
[[nodiscard]] std::optional<NoComputer> WhyNoComputer();

// The calling process, which must be the only thread, becomes a process of that computer, and keeps
// its working directory. False: errno is set.
[[nodiscard]] bool EnterComputer(const OwnComputer& computer);

// Calls `make` while the calling thread is in that computer's network: sockets stay where they were
// made. False, with errno, if the thread could not enter.
[[nodiscard]] bool InNetworkOf(const OwnComputer& computer, const std::function<void()>& make);

}  // namespace tcs
