#include "libtcs_preload/socket_timestamps.h"

#include <linux/sockios.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/time.h>
#include <time.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// As asm-generic/socket.h numbers them; the newer ones for programs with 64-bit times, which are
// all here.
constexpr int kStamp = 29, kStampNs = 35, kStamping = 37;
constexpr int kNewStamp = 63, kNewStampNs = 64, kNewStamping = 65;

std::int64_t RealtimeNs(GuestThread& t) { return NowNs(t) + OffsetNs(Clock::kRealtime); }

template <class T>
void Put(void* to, const T& value) {
  memcpy(to, &value, sizeof value);
}

void Replace(GuestThread& t, const cmsghdr& header, unsigned char* data) {
  const std::size_t size = header.cmsg_len - CMSG_LEN(0);
  const std::int64_t now = RealtimeNs(t);
  switch (header.cmsg_type) {
    case kStamp:
    case kNewStamp:
      if (size >= sizeof(timeval)) Put(data, ToTimeval(now));
      break;
    case kStampNs:
    case kNewStampNs:
      if (size >= sizeof(timespec)) Put(data, ToTimespec(now));
      break;
    case kStamping:
    case kNewStamping:
      // A time of the kernel's own and two of the hardware's; 0 where there is none.
      for (std::size_t at = 0; at + sizeof(timespec) <= size; at += sizeof(timespec)) {
        timespec stamp;
        memcpy(&stamp, data + at, sizeof stamp);
        if (ToNs(stamp) != 0) Put(data + at, ToTimespec(now));
      }
      break;
    default:
      break;
  }
}

}  // namespace

namespace tcs::preload {

void ReplaceTimestamps(msghdr* message) {
  if (message->msg_control == nullptr || message->msg_controllen == 0) return;
  GuestThread* t = Current();
  if (t == nullptr) return;
  for (cmsghdr* header = CMSG_FIRSTHDR(message); header != nullptr;
       header = CMSG_NXTHDR(message, header)) {
    if (header->cmsg_level == SOL_SOCKET && header->cmsg_len >= CMSG_LEN(0)) {
      Replace(*t, *header, CMSG_DATA(header));
    }
  }
}

}  // namespace tcs::preload

// SIOCGSTAMP is of the data that was received last. Devices compute by themselves, and their calls
// wait for that.
TCS_EXPORT int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  const long result = RawSyscall(SYS_ioctl, fd, static_cast<long>(request), Arg(argument));
  EndIoctl();
  if (result == 0 && (request == SIOCGSTAMP_OLD || request == SIOCGSTAMPNS_OLD ||
                      request == SIOCGSTAMP_NEW || request == SIOCGSTAMPNS_NEW)) {
    if (GuestThread* t = Current(); t != nullptr) {
      const bool micro = request == SIOCGSTAMP_OLD || request == SIOCGSTAMP_NEW;
      if (micro) Put(argument, ToTimeval(RealtimeNs(*t)));
      if (!micro) Put(argument, ToTimespec(RealtimeNs(*t)));
    }
  }
  return static_cast<int>(ToErrno(result));
}
