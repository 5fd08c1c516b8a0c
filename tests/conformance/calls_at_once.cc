// Calls that the kernel answers at once though there is nothing to read, no room to write and
// nobody to accept: what they ask for is nothing, or is wrong. Each by its symbol and made raw.
#include <fcntl.h>
#include <mqueue.h>
#include <netinet/in.h>
#include <pty.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/un.h>

#include <string>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

// `call` returns `wanted`, or fails with `error`, and no time passes. Called twice: what has been
// decided once is decided again.
template <class Call>
void AtOnce(const char* what, long wanted, int error, Call call) {
  for (int turn = 0; turn < 2; ++turn) {
    const std::int64_t start = Now();
    errno = 0;
    const long result = call();
    EXPECT(result == wanted && errno == error, "%s: %ld, %s", what, result, strerror(errno));
    const std::int64_t took = Now() - start;
    if (g_mode != Mode::kNative) EXPECT(took < 5 * kMs, "%s took %lld ns", what, (long long)took);
    if (g_mode == Mode::kFixed) EXPECT(took <= 4 * kCallNs, "%s took %lld", what, (long long)took);
  }
}

char g_buffer[64];
iovec g_empty[1100];  // of nothing, each
iovec g_whole{g_buffer, sizeof g_buffer};
volatile int g_wrong = -1;  // no constant, which the compiler would refuse

void Reads() {
  int ends[2], pair[2], full[2];
  EXPECT(pipe(ends) == 0 && pipe(full) == 0, "pipe");
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0, "socketpair");
  const int events = eventfd(0, 0);
  for (const int fd : {ends[0], pair[0]}) {
    AtOnce("read of nothing", 0, 0, [&] { return read(fd, g_buffer, 0); });
    AtOnce("raw read of nothing", 0, 0, [&] { return syscall(SYS_read, fd, g_buffer, 0); });
    AtOnce("readv of nothing", 0, 0, [&] { return readv(fd, g_empty, 3); });
    AtOnce("raw readv of nothing", 0, 0, [&] { return syscall(SYS_readv, fd, g_empty, 3); });
    AtOnce("readv into no buffer", 0, 0, [&] { return readv(fd, g_empty, 0); });
    AtOnce("readv into -1", -1, EINVAL, [&] { return readv(fd, &g_whole, g_wrong); });
    AtOnce("raw readv into -1", -1, EINVAL, [&] { return syscall(SYS_readv, fd, &g_whole, -1); });
    AtOnce("readv into too many", -1, EINVAL, [&] { return readv(fd, g_empty, 1025); });
    AtOnce("raw readv into too many", -1, EINVAL,
           [&] { return syscall(SYS_readv, fd, g_empty, 1025); });
  }
  AtOnce("read of a write end", -1, EBADF, [&] { return read(ends[1], g_buffer, 8); });
  AtOnce("raw read of a write end", -1, EBADF,
         [&] { return syscall(SYS_read, ends[1], g_buffer, 8); });
  AtOnce("readv of a write end", -1, EBADF, [&] { return readv(ends[1], &g_whole, 1); });
  AtOnce("raw readv of a write end", -1, EBADF,
         [&] { return syscall(SYS_readv, ends[1], &g_whole, 1); });
  AtOnce("read of too few events", -1, EINVAL, [&] { return read(events, g_buffer, 4); });
  AtOnce("raw read of too few events", -1, EINVAL,
         [&] { return syscall(SYS_read, events, g_buffer, 4); });

  fcntl(full[1], F_SETFL, O_NONBLOCK);
  while (write(full[1], g_buffer, sizeof g_buffer) > 0) {
  }
  fcntl(full[1], F_SETFL, 0);
  AtOnce("write of nothing", 0, 0, [&] { return write(full[1], g_buffer, 0); });
  AtOnce("raw write of nothing", 0, 0, [&] { return syscall(SYS_write, full[1], g_buffer, 0); });
  AtOnce("writev of nothing", 0, 0, [&] { return writev(full[1], g_empty, 3); });
  AtOnce("raw writev of nothing", 0, 0, [&] { return syscall(SYS_writev, full[1], g_empty, 3); });
  AtOnce("writev of -1", -1, EINVAL, [&] { return writev(full[1], &g_whole, g_wrong); });
  AtOnce("raw writev of -1", -1, EINVAL,
         [&] { return syscall(SYS_writev, full[1], &g_whole, -1); });
  AtOnce("write to a read end", -1, EBADF, [&] { return write(full[0], g_buffer, 8); });
  AtOnce("raw write to a read end", -1, EBADF,
         [&] { return syscall(SYS_write, full[0], g_buffer, 8); });
  for (const int fd : {ends[0], ends[1], pair[0], pair[1], full[0], full[1], events}) close(fd);
}

void Terminals() {
  int master, slave;
  char name[64];
  if (openpty(&master, &slave, name, nullptr, nullptr) != 0) return;
  const int writable = open(name, O_WRONLY | O_NOCTTY);
  AtOnce("read of nothing", 0, 0, [&] { return read(slave, g_buffer, 0); });
  AtOnce("raw read of nothing", 0, 0, [&] { return syscall(SYS_read, slave, g_buffer, 0); });
  AtOnce("read of a terminal to write", -1, EBADF, [&] { return read(writable, g_buffer, 8); });
  AtOnce("raw read of a terminal to write", -1, EBADF,
         [&] { return syscall(SYS_read, writable, g_buffer, 8); });
  for (const int fd : {writable, slave, master}) close(fd);
}

// What cannot be accepted on or received from.
void Sockets() {
  const int datagrams = socket(AF_INET, SOCK_DGRAM, 0), stream = socket(AF_INET, SOCK_STREAM, 0),
            listener = socket(AF_INET, SOCK_STREAM, 0), local = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT(bind(datagrams, reinterpret_cast<sockaddr*>(&any), sizeof any) == 0, "bind");
  EXPECT(bind(listener, reinterpret_cast<sockaddr*>(&any), sizeof any) == 0, "bind");
  EXPECT(listen(listener, 4) == 0, "listen");
  const sockaddr_un unnamed{AF_UNIX, ""};
  EXPECT(bind(local, reinterpret_cast<const sockaddr*>(&unnamed), 2) == 0, "bind");
  EXPECT(listen(local, 1) == 0, "listen");
  int pair[2], ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) == 0 && pipe(ends) == 0, "pairs");
  const auto raw_accept = [](int fd) { return syscall(SYS_accept, fd, nullptr, nullptr); };
  for (const int fd : {datagrams, pair[0]}) {
    AtOnce("accept of datagrams", -1, EOPNOTSUPP, [&] { return accept(fd, nullptr, nullptr); });
    AtOnce("raw accept of datagrams", -1, EOPNOTSUPP, [&] { return raw_accept(fd); });
  }
  AtOnce("accept on no listener", -1, EINVAL, [&] { return accept(stream, nullptr, nullptr); });
  AtOnce("raw accept on no listener", -1, EINVAL, [&] { return raw_accept(stream); });
  AtOnce("accept on a pipe", -1, ENOTSOCK, [&] { return accept(ends[0], nullptr, nullptr); });
  AtOnce("raw accept on a pipe", -1, ENOTSOCK, [&] { return raw_accept(ends[0]); });
  AtOnce("accept4 with no such flag", -1, EINVAL,
         [&] { return accept4(listener, nullptr, nullptr, 0x40); });
  AtOnce("raw accept4 with no such flag", -1, EINVAL,
         [&] { return syscall(SYS_accept4, listener, nullptr, nullptr, 0x40); });

  AtOnce("recv from a listener", -1, ENOTCONN, [&] { return recv(listener, g_buffer, 8, 0); });
  AtOnce("raw recv from a listener", -1, ENOTCONN,
         [&] { return syscall(SYS_recvfrom, listener, g_buffer, 8, 0, nullptr, nullptr); });
  AtOnce("recv of nothing from a listener", -1, ENOTCONN,
         [&] { return recv(listener, g_buffer, 0, 0); });
  AtOnce("read from a listener", -1, ENOTCONN, [&] { return read(listener, g_buffer, 8); });
  AtOnce("raw read from a listener", -1, ENOTCONN,
         [&] { return syscall(SYS_read, listener, g_buffer, 8); });
  AtOnce("recv from a local listener", -1, EINVAL, [&] { return recv(local, g_buffer, 8, 0); });
  AtOnce("read from a local listener", -1, EINVAL, [&] { return read(local, g_buffer, 8); });
  AtOnce("send to a listener", -1, EPIPE,
         [&] { return send(listener, g_buffer, 8, MSG_NOSIGNAL); });
  AtOnce("raw send to a listener", -1, EPIPE,
         [&] { return syscall(SYS_sendto, listener, g_buffer, 8, MSG_NOSIGNAL, nullptr, 0); });
  AtOnce("errors of a socket", -1, EAGAIN,
         [&] { return recv(datagrams, g_buffer, 8, MSG_ERRQUEUE); });
  AtOnce("raw errors of a socket", -1, EAGAIN, [&] {
    return syscall(SYS_recvfrom, datagrams, g_buffer, 8, MSG_ERRQUEUE, nullptr, nullptr);
  });
  AtOnce("urgent datagrams", -1, EOPNOTSUPP, [&] { return recv(pair[0], g_buffer, 8, MSG_OOB); });
  AtOnce("raw urgent datagrams", -1, EOPNOTSUPP,
         [&] { return syscall(SYS_recvfrom, pair[0], g_buffer, 8, MSG_OOB, nullptr, nullptr); });
  msghdr message{};
  message.msg_iov = g_empty;
  message.msg_iovlen = 1025;
  AtOnce("recvmsg into too many", -1, EMSGSIZE, [&] { return recvmsg(datagrams, &message, 0); });
  AtOnce("raw recvmsg into too many", -1, EMSGSIZE,
         [&] { return syscall(SYS_recvmsg, datagrams, &message, 0); });
  mmsghdr messages{};
  timespec wrong{-1, 0};
  AtOnce("recvmmsg of none", 0, 0, [&] { return recvmmsg(datagrams, &messages, 0, 0, nullptr); });
  AtOnce("raw recvmmsg of none", 0, 0,
         [&] { return syscall(SYS_recvmmsg, datagrams, &messages, 0, 0, nullptr); });
  AtOnce("recvmmsg until before the start", -1, EINVAL,
         [&] { return recvmmsg(datagrams, &messages, 1, 0, &wrong); });
  AtOnce("connect to nothing", -1, EINVAL,
         [&] { return connect(stream, reinterpret_cast<sockaddr*>(&any), 1); });
  AtOnce("raw connect to nothing", -1, EINVAL,
         [&] { return syscall(SYS_connect, stream, reinterpret_cast<sockaddr*>(&any), 1); });
  for (const int fd : {datagrams, stream, listener, local, pair[0], pair[1], ends[0], ends[1]}) {
    close(fd);
  }
}

void Queues() {
  const std::string name = "/tcs_at_once_" + std::to_string(getpid());
  mq_attr attributes{};
  attributes.mq_maxmsg = 1;
  attributes.mq_msgsize = 8;
  const mqd_t out = mq_open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600, &attributes);
  const mqd_t in = mq_open(name.c_str(), O_RDONLY);
  EXPECT(out >= 0 && in >= 0, "mq_open: %s", strerror(errno));
  mq_unlink(name.c_str());
  AtOnce("receiving where it is sent", -1, EBADF,
         [&] { return mq_receive(out, g_buffer, 8, nullptr); });
  AtOnce("receiving too little", -1, EMSGSIZE,
         [&] { return mq_receive(in, g_buffer, 4, nullptr); });
  EXPECT(mq_send(out, "x", 1, 0) == 0, "mq_send");
  AtOnce("sending where it is received", -1, EBADF, [&] { return mq_send(in, "x", 1, 0); });
  AtOnce("sending too much", -1, EMSGSIZE, [&] { return mq_send(out, g_buffer, 9, 0); });
  mq_close(in);
  mq_close(out);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  signal(SIGPIPE, SIG_IGN);
  Reads();
  Terminals();
  Sockets();
  Queues();
}
