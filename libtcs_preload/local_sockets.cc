#include "libtcs_preload/local_sockets.h"

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

namespace {

using shm::NotificationKind;

constexpr unsigned long kMostLooks = 8;  // each look is a system call; a hold is some dozens

template <class T>
bool SocketOption(int fd, int option, T* value) {
  socklen_t size = sizeof *value;
  return RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, option, Arg(value), Arg(&size)) == 0;
}

bool IsLocal(const GuestThread& thread, int fd) {
  std::uint64_t cookie = 0;
  return SocketOption(fd, SO_COOKIE, &cookie) &&
         shm::RobotOf(shm::LocalSocketsOf(*g_run).by_cookie, cookie) == thread.slot->robot;
}

std::uint64_t NameOf(const GuestThread& thread, const void* address, socklen_t size) {
  if (address == nullptr || size > sizeof(sockaddr_un) || !CanRead(address, size)) return 0;
  return shm::NumberOfName(shm::HashOfName(address, size), thread.slot->robot,
                           g_header->names_by_robot != 0);
}

bool Reach(GuestThread& thread, std::uint32_t robot) {
  if (g_header->sync != shm::Sync::kConsistent) return false;
  Exchange(thread,
           {.kind = NotificationKind::kReaches, .args = {static_cast<std::int64_t>(robot)}});
  return true;
}

bool HasDescriptors(const msghdr& message) {
  if (message.msg_controllen < sizeof(cmsghdr) ||
      !CanRead(message.msg_control, message.msg_controllen)) {
    return false;
  }
  auto& given = const_cast<msghdr&>(message);
  for (const cmsghdr* part = CMSG_FIRSTHDR(&given); part != nullptr;
       part = CMSG_NXTHDR(&given, const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_RIGHTS) return true;
  }
  return false;
}

}  // namespace

bool IsSafeLook(const GuestThread& thread, int fd, std::int64_t now_ns, const SafeTimes& safe) {
  return now_ns <= safe.of_all || (now_ns <= safe.of_robot && IsLocal(thread, fd));
}

bool AreSafeLooks(const GuestThread& thread, const pollfd* fds, unsigned long count,
                  std::int64_t now_ns) {
  const SafeTimes safe = SafeTimesOf(thread);
  if (now_ns <= safe.of_all) return true;
  if (now_ns > safe.of_robot || count > kMostLooks) return false;
  for (unsigned long i = 0; i < count; ++i) {
    if (fds[i].fd >= 0 && !IsLocal(thread, fds[i].fd)) return false;
  }
  return true;
}

bool ReachesSafely(GuestThread& thread, const void* address, socklen_t size) {
  const std::uint64_t name = NameOf(thread, address, size);
  if (name == 0) return false;
  const std::uint32_t robot = shm::RobotOf(shm::LocalSocketsOf(*g_run).by_name, name);
  if (robot == shm::kNoRobot) return false;
  if (robot == thread.slot->robot) return NowNs(thread) <= thread.slot->clock.local_read_safe_ns;
  return Reach(thread, robot);
}

bool ReachesSafely(GuestThread& thread, const msghdr& message) {
  const bool is_safe = ReachesSafely(thread, message.msg_name, message.msg_namelen);
  return HasDescriptors(message) ? Reach(thread, thread.slot->robot) : is_safe;
}

}  // namespace tcs::preload

using namespace tcs::preload;

// The coordinator is told first: once the kernel has the name, others can send to it.
TCS_EXPORT int bind(int fd, const sockaddr* address, socklen_t size) {
  const Entered t;
  const std::uint64_t name = t != nullptr ? NameOf(*t, address, size) : 0;
  int type = 0;
  std::uint64_t cookie = 0;
  if (name != 0 && SocketOption(fd, SO_TYPE, &type) && type == SOCK_DGRAM &&
      SocketOption(fd, SO_COOKIE, &cookie)) {
    Exchange(*t, {.kind = NotificationKind::kBinds,
                  .args = {static_cast<std::int64_t>(cookie), static_cast<std::int64_t>(name)}});
  }
  return static_cast<int>(ToErrno(RawSyscall(SYS_bind, fd, Arg(address), size)));
}
