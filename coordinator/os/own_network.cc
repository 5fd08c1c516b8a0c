#include "coordinator/os/own_network.h"

#include <errno.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>

#include "coordinator/os/real_time_facts.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

bool Put(const char* path, const std::string& text) {
  const UniqueFd fd(open(path, O_WRONLY | O_CLOEXEC));
  return fd && write(fd.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

// A process that has no right to make a network has that right in a user namespace, where its user
// and group stay what they are.
bool MakeNetwork() {
  if (unshare(CLONE_NEWNET) == 0) return true;
  const std::string user = std::to_string(geteuid()), group = std::to_string(getegid());
  return errno == EPERM && unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0 &&
         Put("/proc/self/setgroups", "deny") &&
         Put("/proc/self/uid_map", user + " " + user + " 1") &&
         Put("/proc/self/gid_map", group + " " + group + " 1");
}

// With the interface come 127.0.0.1 and its routes. Multicast goes there, too: programs that find
// each other by multicast have no other interface.
bool RaiseLoopback() {
  const UniqueFd fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!fd) return false;
  ifreq request{};
  strcpy(request.ifr_name, "lo");
  bool up = ioctl(fd.get(), SIOCGIFFLAGS, &request) == 0;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_MULTICAST);
  up = up && ioctl(fd.get(), SIOCSIFFLAGS, &request) == 0;
  rtentry route{};
  const auto address = [](std::uint32_t host_order) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_addr.s_addr = htonl(host_order);
    sockaddr result;
    memcpy(&result, &in, sizeof result);
    return result;
  };
  route.rt_dst = address(0xe0000000);  // 224.0.0.0/4
  route.rt_genmask = address(0xf0000000);
  route.rt_flags = RTF_UP;
  route.rt_dev = request.ifr_name;
  return up && ioctl(fd.get(), SIOCADDRT, &route) == 0;
}

constexpr int kLosesRealTime = 255;  // not an errno

// The exit status of a process that tries that: 0, an errno, or kLosesRealTime.
[[noreturn]] void Try() {
  const bool had_real_time = AskForRealTime().error == 0;
  if (!EnterOwnNetwork().empty()) _exit(errno == 0 ? EPERM : errno);
  // A user namespace takes away what root and capabilities gave, and leaves what limits allow.
  _exit(had_real_time && AskForRealTime().error != 0 ? kLosesRealTime : 0);
}

}  // namespace

std::string EnterOwnNetwork() { return MakeNetwork() && RaiseLoopback() ? "" : strerror(errno); }

std::string WhyNoOwnNetwork() {
  const pid_t pid = fork();
  if (pid == 0) Try();
  int status = 0;
  while (pid > 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (pid < 0) return strerror(errno);
  if (!WIFEXITED(status)) return "the attempt was killed";
  if (WEXITSTATUS(status) == kLosesRealTime) return "real-time priority would be lost in it";
  return WEXITSTATUS(status) == 0 ? "" : strerror(WEXITSTATUS(status));
}

}  // namespace tcs
