#include "coordinator/os/own_computer.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <climits>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>

#include "coordinator/os/netlink.h"
#include "coordinator/os/own_network.h"
#include "coordinator/os/passed_fd.h"

namespace tcs {

namespace {

// Steps that have a mend of their own.
constexpr char kTun[] = "/dev/net/tun", kSettingsStep[] = "/proc/sys/net";
constexpr char kNamespacesStep[] = "unshare", kOwnMountsStep[] = "mount --make-rslave /";
// Obstacles that may be in the way of a user namespace.
constexpr char kUserStep[] = "user namespace", kFilterStep[] = "a seccomp filter on unshare";
constexpr char kChrootStep[] = "user namespace, in a chroot";
constexpr char kMostStep[] = "user.max_user_namespaces";
constexpr char kSwitchStep[] = "kernel.unprivileged_userns_clone";
constexpr char kAppArmorStep[] = "kernel.apparmor_restrict_unprivileged_userns";

constexpr int kOwnNamespaces = CLONE_NEWNET | CLONE_NEWUTS | CLONE_NEWNS;
constexpr char kDevice[] = "eth0";
constexpr std::uint32_t kDeviceQueue = 32768;  // packets; more than one call sends
// Longer than any wait of the host's: the kernel's own limit.
constexpr std::uint32_t kNoTimeoutMs = 120'000;
constexpr std::uint32_t kHostsOfNet = 0xff;  // as network/wire.cc has them

// A request about the interface of that name.
ifreq RequestFor(const char* name) {
  ifreq request{};
  snprintf(request.ifr_name, sizeof request.ifr_name, "%s", name);
  return request;
}

// Settings for things that the host's time would have a part in, and for what makes up for them. A
// kernel without one of these settings does not have what the setting turns off, either.
struct Setting {
  const char* path;
  const char* value;
};
constexpr Setting kSettings[] = {
    {"ipv4/tcp_congestion_control", "reno"},
    {"ipv4/tcp_sack", "0"},
    {"ipv4/tcp_timestamps", "0"},
    {"ipv4/tcp_early_retrans", "0"},
    {"ipv4/tcp_recovery", "0"},
    {"ipv4/tcp_frto", "0"},
    {"ipv4/tcp_ecn", "0"},
    {"ipv4/tcp_autocorking", "0"},
    {"ipv4/tcp_no_metrics_save", "1"},
    {"ipv4/tcp_slow_start_after_idle", "0"},
    {"ipv4/tcp_moderate_rcvbuf", "0"},
    {"ipv4/tcp_rmem", "4096 4194304 6291456"},
    {"ipv4/tcp_invalid_ratelimit", "0"},
    {"ipv4/icmp_ratelimit", "0"},
    {"ipv4/conf/all/rp_filter", "0"},
    {"ipv4/conf/default/rp_filter", "0"},
    // The computer's eth0 would otherwise announce itself now and then.
    {"ipv6/conf/default/disable_ipv6", "1"},
};

bool Put(const std::string& path, const std::string& text) {
  const UniqueFd fd(open(path.c_str(), O_WRONLY | O_CLOEXEC));
  return fd && write(fd.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

// False where no setting can be changed, as in a container: TCP would go by the host's clock.
bool ChangeSettings() {
  for (const Setting& setting : kSettings) {
    if (!Put(std::string("/proc/sys/net/") + setting.path, setting.value) && errno == EROFS) {
      return false;
    }
  }
  // The groups that may send an echo request without being root; a user namespace has only the
  // process's own group.
  const std::string own = std::to_string(getegid());
  if (!Put("/proc/sys/net/ipv4/ping_group_range", "0 2147483647")) {
    Put("/proc/sys/net/ipv4/ping_group_range", own + " " + own);
  }
  return true;
}

// The message of the new computer to its maker: which step has failed, or a descriptor.
struct Told {
  int error = 0;
  char step[60] = "";
};

// Makes the computer from inside, in a process of its own. A step that fails returns false with
// errno.
class Maker {
 public:
  explicit Maker(const ComputerRequest& request) : request_(request) {}

  // The step that failed; null: none.
  const char* Make(UniqueFd* device) {
    if (unshare(kOwnNamespaces) != 0) return kNamespacesStep;
    if (sethostname(request_.name.data(), request_.name.size()) != 0) return "sethostname";
    if (!ChangeSettings()) return kSettingsStep;
    *device = MakeDevice();
    if (!*device) return kTun;
    Netlink netlink;
    const int index = static_cast<int>(if_nametoindex(kDevice));
    errno = netlink.KeepPackets(index, kDeviceQueue);
    if (errno == 0) errno = netlink.SendSegmentsOneByOne(index);
    if (errno != 0) return "setting up the interface";
    if (!Raise("lo") || !Raise(kDevice)) return "raising the interfaces";
    if (!GiveAddresses(netlink, index)) return "addresses and routes";
    // Mounts that are made here stay here. In a chroot whose / is no mount point the kernel refuses
    // this.
    if (mount(nullptr, "/", nullptr, MS_REC | MS_SLAVE, nullptr) != 0) return kOwnMountsStep;
    return GiveFiles() ? nullptr : "mounting /etc/hosts";
  }

 private:
  UniqueFd MakeDevice() {
    UniqueFd fd(open(kTun, O_RDWR | O_NONBLOCK | O_CLOEXEC));
    ifreq wanted = RequestFor(kDevice);
    wanted.ifr_flags = IFF_TUN | IFF_NO_PI;
    if (!fd || ioctl(fd.get(), TUNSETIFF, &wanted) != 0) return {};
    return fd;
  }

  bool Raise(const char* name) {
    const UniqueFd fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    ifreq wanted = RequestFor(name);
    if (ioctl(fd.get(), SIOCGIFFLAGS, &wanted) != 0) return false;
    wanted.ifr_flags = static_cast<short>(wanted.ifr_flags | IFF_UP);
    return ioctl(fd.get(), SIOCSIFFLAGS, &wanted) == 0;
  }

  bool GiveAddresses(Netlink& netlink, int device) {
    const auto parsed = [](const std::string& text) {
      in_addr address{};
      inet_pton(AF_INET, text.c_str(), &address);
      return address;
    };
    const in_addr own = parsed(request_.address);
    const Netlink::RouteMetrics to_robots{.least_timeout_ms = kNoTimeoutMs,
                                          .acknowledges_at_once = true};
    errno = netlink.AddAddress(device, own);
    if (errno == 0) errno = netlink.SendWithoutQueue(device);
    for (const std::string& other : request_.others) {
      if (errno == 0) errno = netlink.AddRoute(device, parsed(other), 32, own, to_robots);
    }
    if (errno == 0) errno = netlink.AddRoute(device, parsed("224.0.0.0"), 4, own, {});
    const in_addr to_all = parsed("255.255.255.255"), to_net{own.s_addr | htonl(kHostsOfNet)};
    for (const in_addr to : {to_all, to_net}) {
      if (errno == 0) errno = netlink.AddBroadcast(device, to, own);
    }
    return errno == 0;
  }

  // The files are written where nobody else looks, then shown in the places of the host's files.
  bool GiveFiles() {
    constexpr char kPlace[] = "/tmp";
    if (mount("tmpfs", kPlace, "tmpfs", MS_NOSUID | MS_NODEV, "mode=0755") != 0) return false;
    const bool shown =
        Show(kPlace, "hosts", request_.hosts_file) &&
        (access("/etc/hostname", F_OK) != 0 || Show(kPlace, "hostname", request_.name + "\n"));
    const int error = errno;
    const bool left = umount2(kPlace, MNT_DETACH) == 0;
    if (!shown) errno = error;
    return shown && left;
  }

  static bool Show(const std::string& folder, const std::string& name, const std::string& text) {
    const std::string path = folder + "/" + name;
    {
      const UniqueFd fd(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
      if (!fd || fchmod(fd.get(), 0644) != 0 ||
          write(fd.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
        return false;
      }
    }
    return mount(path.c_str(), ("/etc/" + name).c_str(), nullptr, MS_BIND, nullptr) == 0;
  }

  const ComputerRequest& request_;
};

void Tell(int socket, Told told, int fd) {
  const PassedMessage message(&told, sizeof told, std::span(&fd, fd < 0 ? 0 : 1));
  sendmsg(socket, message.get(), MSG_NOSIGNAL);
}

Told ToldOf(const NoComputer& why) {
  Told told{.error = why.error};
  snprintf(told.step, sizeof told.step, "%s", why.step.c_str());
  return told;
}

constexpr const char* kNamespaces[] = {"/proc/self/ns/net", "/proc/self/ns/uts",
                                       "/proc/self/ns/mnt"};

[[noreturn]] void MakeIn(int socket, const ComputerRequest& request) {
  UniqueFd device;
  if (const char* step = Maker(request).Make(&device); step != nullptr) {
    Tell(socket, ToldOf({step, errno}), -1);
    _exit(1);
  }
  Tell(socket, {}, device.get());
  for (const char* path : kNamespaces) {
    const UniqueFd fd(open(path, O_RDONLY | O_CLOEXEC));
    Tell(socket, ToldOf({path, fd ? 0 : errno}), fd.get());
  }
  _exit(0);
}

char FirstCharOf(const char* path) {
  char first = 0;
  std::ifstream(path) >> first;
  return first;
}

// True, for one, in a chroot into an ordinary folder.
bool IsRootNoMountPoint() {
  std::ifstream mounts("/proc/self/mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    std::string id, parent, device, root, point;
    std::stringstream(line) >> id >> parent >> device >> root >> point;
    if (point == "/") return false;
  }
  return true;
}

// The step that names what is in the way.
const char* WhyNoUserNamespace(int error) {
  if (error == ENOSPC) {
    return FirstCharOf("/proc/sys/user/max_user_namespaces") == '0' ? kMostStep : kNamespacesStep;
  }
  // The kernel never refuses a call that leaves no namespace: only a filter does.
  if (unshare(0) != 0) return kFilterStep;
  if (FirstCharOf("/proc/sys/kernel/unprivileged_userns_clone") == '0') return kSwitchStep;
  if (FirstCharOf("/proc/sys/kernel/apparmor_restrict_unprivileged_userns") == '1') {
    return kAppArmorStep;
  }
  return IsRootNoMountPoint() ? kChrootStep : kUserStep;
}

}  // namespace

std::string NoComputer::Sentence() const {
  return "this host does not let a robot have a network of its own (" + step + ": " +
         strerror(error) + "); " + Mend() + ", or leave `network` out of the scenario";
}

std::string NoComputer::Mend() const {
  // Root that is refused this has lost the capability.
  const std::string as_root =
      geteuid() == 0 ? "start it with CAP_SYS_ADMIN, or " : "run tcsim as root, or ";
  if (step == kSettingsStep) return "mount /proc/sys for writing, in a container with --privileged";
  if (step == kOwnMountsStep && error == EINVAL) {
    return "call `mount --rbind / /` and start tcsim by `chroot /.. tcsim`, because / is no mount "
           "point in this chroot, or outside call `mount --rbind DIR DIR` before the chroot into "
           "DIR";
  }
  if (step == kFilterStep) {
    return "start tcsim outside of the filter, in a container with --privileged or with a profile "
           "that permits unshare and mount (docker: --security-opt seccomp=FILE)";
  }
  if (step == kChrootStep) return "run tcsim as root, or outside of the chroot";
  if (step == kMostStep) return as_root + "let root call `sysctl -w user.max_user_namespaces=1000`";
  if (step == kSwitchStep) {
    return as_root + "let root call `sysctl -w kernel.unprivileged_userns_clone=1`";
  }
  if (step == kAppArmorStep) {
    return as_root + "let root call `sysctl -w kernel.apparmor_restrict_unprivileged_userns=0`";
  }
  if (step == kNamespacesStep && error == ENOSPC) {
    return "let root call `sysctl -w user.max_net_namespaces=1000 user.max_mnt_namespaces=1000 "
           "user.max_uts_namespaces=1000`";
  }
  if (step != kTun) return as_root + "allow user namespaces, in a container with --privileged";
  if (error == EACCES || error == EPERM) {
    return (geteuid() == 0 ? "" : "run tcsim as root, or ") +
           std::string(
               "let everybody open it (chmod 666 /dev/net/tun), in a container with "
               "--privileged");
  }
  return "load the module tun (modprobe tun), in a container add --device /dev/net/tun";
}

bool MayMakeNamespaces() {
  const pid_t pid = fork();
  if (pid == 0) _exit(unshare(kOwnNamespaces) == 0 ? 0 : 1);
  int status = -1;
  while (pid > 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return pid > 0 && status == 0;
}

std::optional<NoComputer> GetReadyForComputers() {
  if (MayMakeNamespaces() || EnterOwnNetwork().empty()) return std::nullopt;
  const int error = errno;
  return NoComputer{WhyNoUserNamespace(error), error};
}

std::variant<OwnComputer, NoComputer> MakeComputer(const ComputerRequest& request) {
  std::optional<SocketPair> sockets = SocketPair::Make();
  const pid_t pid = sockets ? fork() : -1;
  if (pid == 0) {
    sockets->ours.Reset();
    MakeIn(sockets->theirs.get(), request);
  }
  Told told{.error = errno, .step = "fork"};
  OwnComputer computer;
  if (pid > 0) {
    sockets->theirs.Reset();
    for (UniqueFd* fd :
         {&computer.device, &computer.network, &computer.host_name, &computer.files}) {
      told = {.error = EPROTO, .step = "its first process"};
      *fd = std::move(ReceivePassed(sockets->ours.get(), &told, sizeof told, 0).fd);
      if (!*fd) break;
    }
    while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (!computer.files) return NoComputer{told.step, told.error};
  return computer;
}

std::optional<NoComputer> WhyNoComputer() {
  std::optional<SocketPair> sockets = SocketPair::Make();
  const pid_t pid = sockets ? fork() : -1;
  if (pid == 0) {
    std::optional<NoComputer> why = GetReadyForComputers();
    if (!why) {
      auto made = MakeComputer({.name = "robot", .address = "10.42.0.1", .hosts_file = ""});
      if (auto* refused = std::get_if<NoComputer>(&made)) why = std::move(*refused);
    }
    Told told;
    if (why) told = ToldOf(*why);
    Tell(sockets->theirs.get(), told, -1);
    _exit(0);
  }
  if (pid < 0) return NoComputer{"fork", errno};
  sockets->theirs.Reset();
  Told told{.error = EPROTO, .step = "its first process"};
  const ssize_t size = recv(sockets->ours.get(), &told, sizeof told, 0);
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (size == static_cast<ssize_t>(sizeof told) && told.error == 0) return std::nullopt;
  return NoComputer{told.step, told.error};
}

bool EnterComputer(const OwnComputer& computer) {
  char folder[PATH_MAX];
  const bool has_folder = getcwd(folder, sizeof folder) != nullptr;
  return setns(computer.network.get(), CLONE_NEWNET) == 0 &&
         setns(computer.host_name.get(), CLONE_NEWUTS) == 0 &&
         setns(computer.files.get(), CLONE_NEWNS) == 0 && (!has_folder || chdir(folder) == 0);
}

bool InNetworkOf(const OwnComputer& computer, const std::function<void()>& make) {
  const UniqueFd own(open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC));
  if (!own || setns(computer.network.get(), CLONE_NEWNET) != 0) return false;
  make();
  const int error = errno;
  const bool is_back = setns(own.get(), CLONE_NEWNET) == 0;
  errno = error;
  return is_back;
}

}  // namespace tcs
