// When a datagram came, as the kernel tells it: between its sending and its reading, by the clock
// that both ends read.
#include <arpa/inet.h>
#include <linux/net_tstamp.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

struct Received {
  std::int64_t sent, stamp_ns;
};

template <class Take>
Received Receive(int fd, std::int64_t delay_ns, Take take) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  EXPECT(getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  const pid_t child = fork();
  if (child == 0) {
    usleep(static_cast<useconds_t>(delay_ns / 1000));
    const std::int64_t now = Now(CLOCK_REALTIME);
    const int from = socket(AF_INET, SOCK_DGRAM, 0);
    _exit(sendto(from, &now, sizeof now, 0, reinterpret_cast<sockaddr*>(&address), size) < 0);
  }
  Received received{};
  received.stamp_ns = take(&received.sent);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "the sender: %#x", status);
  return received;
}

int Socket() {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0, "bind");
  return fd;
}

void Expect(const Received& r, const char* what) {
  // Of a datagram that was waited for, and a clock of microseconds.
  const std::int64_t after = r.stamp_ns - r.sent;
  const std::int64_t most = g_mode == Mode::kNative ? kSecond : 5 * kMs;
  EXPECT(after >= -1000 && after < most, "%s: %lld ns after it was sent", what, (long long)after);
}

template <class Stamp>
void WithData(int option, int value, const char* what, Stamp stamp_of) {
  const int fd = Socket();
  EXPECT(setsockopt(fd, SOL_SOCKET, option, &value, sizeof value) == 0, "%s: %s", what,
         strerror(errno));
  auto take = [&](std::int64_t* sent) -> std::int64_t {
    iovec iov{sent, sizeof *sent};
    alignas(cmsghdr) char control[256];
    msghdr message{};
    message.msg_iov = &iov;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    EXPECT(recvmsg(fd, &message, 0) == sizeof *sent, "%s", strerror(errno));
    const cmsghdr* header = CMSG_FIRSTHDR(&message);
    if (header == nullptr) return 0;
    EXPECT(header->cmsg_type == option, "%s: type %d", what, header->cmsg_type);
    return stamp_of(CMSG_DATA(header));
  };
  // The kernel begins to keep stamps some real time after it was asked to, of which under tcs too
  // little may pass.
  Received received{};
  for (int i = 0; i < 50 && received.stamp_ns == 0; ++i) received = Receive(fd, 50 * kMs, take);
  EXPECT(received.stamp_ns != 0 || g_mode != Mode::kNative, "%s: no stamp", what);
  if (received.stamp_ns != 0) Expect(received, what);
  close(fd);
}

std::int64_t FromTimeval(const void* data) {
  timeval stamp;
  memcpy(&stamp, data, sizeof stamp);
  return stamp.tv_sec * kSecond + stamp.tv_usec * 1000;
}

std::int64_t FromTimespec(const void* data) {
  timespec stamp;
  memcpy(&stamp, data, sizeof stamp);
  return ToNs(stamp);
}

void Asked() {
  const int fd = Socket();
  timeval stamp{};
  ioctl(fd, SIOCGSTAMP, &stamp);  // has the kernel keep them from now on
  Expect(Receive(fd, 50 * kMs,
                 [&](std::int64_t* sent) {
                   EXPECT(recv(fd, sent, sizeof *sent, 0) == sizeof *sent, "%s", strerror(errno));
                   EXPECT(ioctl(fd, SIOCGSTAMP, &stamp) == 0, "%s", strerror(errno));
                   return FromTimeval(&stamp);
                 }),
         "SIOCGSTAMP");
  close(fd);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  WithData(SO_TIMESTAMP, 1, "SO_TIMESTAMP", FromTimeval);
  WithData(SO_TIMESTAMPNS, 1, "SO_TIMESTAMPNS", FromTimespec);
  WithData(SO_TIMESTAMPING, SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE,
           "SO_TIMESTAMPING", FromTimespec);
  Asked();
}
