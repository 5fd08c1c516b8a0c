// Posting is to look like sending to the program, errors included, so the kernel is asked first
// whether it would send: by a send of as many bytes from memory that nobody can read. The kernel
// then makes all its checks of a socket, an address and a size, gives the socket a port where it
// has none, and finds nothing to send (EFAULT).
#include <errno.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/udp.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/uio.h>

#include <cstddef>
#include <iterator>

#include "libtcs_preload/own_receivers.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "shm/clock_page.h"
#include "shm/command_ring.h"

namespace tcs::preload {

namespace {

// Other flags do more than to send.
constexpr int kKnownFlags = MSG_DONTWAIT | MSG_NOSIGNAL;
constexpr std::size_t kMostParts = 16;

std::atomic<void*> g_unreadable;  // a page; null: the page has not been needed

template <class T>
bool Has(int fd, int level, int option, T value) {
  T is{};
  socklen_t size = sizeof is;
  return RawSyscall(SYS_getsockopt, fd, level, option, Arg(&is), Arg(&size)) == 0 && is == value;
}

// Whether the socket is of the kind, and in the network, that the receivers are of. A cookie is one
// socket's for ever, and neither kind nor network ever changes; so a socket is asked once.
bool IsOfTheirKind(GuestThread& thread, int fd, std::uint64_t network) {
  std::uint64_t cookie = 0;
  socklen_t size = sizeof cookie;
  if (RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_COOKIE, Arg(&cookie), Arg(&size)) != 0) {
    return false;
  }
  for (const std::uint64_t known : thread.posting_sockets) {
    if (known == cookie) return true;
  }
  const bool is_unix = Has(fd, SOL_SOCKET, SO_DOMAIN, AF_UNIX);
  const bool is_udp =
      Has(fd, SOL_SOCKET, SO_DOMAIN, AF_INET) && Has(fd, SOL_SOCKET, SO_PROTOCOL, IPPROTO_UDP);
  if ((!is_unix && !is_udp) || !Has(fd, SOL_SOCKET, SO_TYPE, SOCK_DGRAM) ||
      !Has(fd, SOL_SOCKET, SO_NETNS_COOKIE, network)) {
    return false;
  }
  thread.posting_sockets[thread.posting_socket++ % std::size(thread.posting_sockets)] = cookie;
  return true;
}

// True for a UDP socket that sends at once, and does no more: the socket puts nothing together, is
// not bound to a device, and notes no times.
bool SendsAtOnce(int fd) {
  int queued = 0;
  return RawSyscall(SYS_ioctl, fd, SIOCOUTQ, Arg(&queued)) == 0 && queued == 0 &&
         Has(fd, IPPROTO_UDP, UDP_CORK, 0) && Has(fd, SOL_SOCKET, SO_BINDTOIFINDEX, 0) &&
         Has(fd, SOL_SOCKET, SO_TIMESTAMPING, 0);
}

// The places of the bytes of a message. They are read once: other threads of the program may change
// the list of them.
struct Parts {
  iovec at[kMostParts];
  std::size_t count = 0;
  std::size_t size = 0;  // of all parts; 0 where they are not all there, or too many
};

void Read(const msghdr& message, Parts* parts) {
  const std::size_t count = message.msg_iovlen;
  if (count > kMostParts || !CanRead(message.msg_iov, count * sizeof(iovec))) return;
  memcpy(parts->at, message.msg_iov, count * sizeof(iovec));
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const iovec& part = parts->at[i];
    if (part.iov_len > shm::CommandRing::kMostSize || !CanRead(part.iov_base, part.iov_len)) return;
    size += part.iov_len;
  }
  parts->count = count;
  parts->size = size;
}

// Null: there is none.
void* Unreadable() {
  void* page = g_unreadable.load(std::memory_order_acquire);
  if (page != nullptr) return page;
  constexpr long kSize = static_cast<long>(kPageSize);
  const long at = RawSyscall(SYS_mmap, 0, kSize, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1L, 0L);
  if (at < 0 && at > -4096) return nullptr;
  if (!g_unreadable.compare_exchange_strong(page, reinterpret_cast<void*>(at))) {
    RawSyscall(SYS_munmap, at, kSize);  // another thread was faster
    return page;
  }
  return reinterpret_cast<void*>(at);
}

// The kernel's answer to a send of `size` bytes that it cannot read: -EFAULT if all else is well.
long Try(int fd, const msghdr& message, std::size_t size, int flags) {
  static_assert(shm::CommandRing::kMostSize <= kPageSize);
  void* page = Unreadable();
  if (page == nullptr) return -EAGAIN;
  return RawSocketCall(SYS_sendto, fd, Arg(page), size, flags | MSG_DONTWAIT, Arg(message.msg_name),
                       static_cast<long>(message.msg_namelen));
}

void Put(GuestThread& thread, int receiver, const Parts& parts) {
  const shm::ClockPage& page = thread.slot->clock;
  const shm::CommandRing::Head head{
      page.last_shown_ns.load(std::memory_order_relaxed), shm::RunTime(page, shm::ReadClock(page)),
      static_cast<std::uint32_t>(receiver), static_cast<std::uint32_t>(parts.size)};
  shm::CommandRing& ring = thread.slot->command_ring;
  shm::PostInto(ring, head, [&](std::uint64_t position) {
    for (std::size_t i = 0; i < parts.count; ++i) {
      const iovec& part = parts.at[i];
      shm::CopyIntoRing(ring, position, part.iov_base, part.iov_len);
      position += part.iov_len;
    }
  });
}

// Whether the message is one that can be posted, as far as that is seen without the kernel.
bool MayBePosted(const GuestThread& thread, int receiver, const msghdr& message, int flags) {
  const shm::OwnReceivers& receivers = shm::OwnReceiversOf(*g_run);
  if (receiver == shm::kNoReceiver || receivers.network == 0 || IsShutDown()) return false;
  if (shm::HasFile(receivers.addresses[receiver])) return false;
  // In a handler that has interrupted an exchange, or another post.
  if (thread.depth != 0 || thread.posts) return false;
  return (flags & ~kKnownFlags) == 0 && message.msg_controllen == 0;
}

}  // namespace

bool Post(GuestThread& thread, int fd, int receiver, const msghdr& message, int flags,
          long* result) {
  if (!MayBePosted(thread, receiver, message, flags)) return false;
  const shm::OwnReceivers& receivers = shm::OwnReceiversOf(*g_run);
  Parts parts;
  Read(message, &parts);
  const std::size_t size = parts.size;
  if (!shm::HasRoomFor(thread.slot->command_ring, size)) return false;
  if (!IsOfTheirKind(thread, fd, receivers.network)) return false;
  sa_family_t family;
  memcpy(&family, receivers.addresses[receiver].bytes, sizeof family);
  if (family != AF_UNIX && !SendsAtOnce(fd)) return false;
  *result = Try(fd, message, size, flags);
  if (*result == -EAGAIN || *result == -EINTR) return false;
  if (*result != -EFAULT) return true;
  thread.posts = true;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  // A handler may have posted meanwhile.
  const bool has_room = shm::HasRoomFor(thread.slot->command_ring, size);
  if (has_room) Put(thread, receiver, parts);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  thread.posts = false;
  *result = static_cast<long>(size);
  return has_room;
}

}  // namespace tcs::preload
