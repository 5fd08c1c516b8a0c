#include "coordinator/os/descriptor_broker.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "coordinator/os/passed_fd.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/port/proc_files.h"
#include "shm/attach_protocol.h"

namespace tcs {

namespace {

// The waits for an answer: of a broker that does not run, and of one that other processes of the
// host keep from running.
constexpr std::int64_t kMostWaitMs = 2'000, kMostStarvedMs = 60'000;
constexpr int kMostUnasked = 256;  // messages at a time: a flood is not listened to for ever

std::int64_t NowMs() { return HostClockNs(CLOCK_MONOTONIC) / 1'000'000; }

// False if no descriptor is ready by then.
template <std::size_t count>
bool PollUntil(pollfd (&fds)[count], std::int64_t until_ms) {
  for (;;) {
    const auto left_ms = static_cast<int>(std::max<std::int64_t>(0, until_ms - NowMs()));
    const int ready = poll(fds, count, left_ms);
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

}  // namespace

DescriptorBroker::DescriptorBroker(UniqueFd ours, UniqueFd theirs, std::function<void()> is_lost)
    : socket_(std::move(ours)), clients_end_(std::move(theirs)), is_lost_(std::move(is_lost)) {}

std::unique_ptr<DescriptorBroker> DescriptorBroker::Make(std::function<void()> is_lost) {
  std::optional<SocketPair> sockets = SocketPair::Make();
  const int on = 1;
  if (!sockets.has_value() ||
      setsockopt(sockets->ours.get(), SOL_SOCKET, SO_PASSCRED, &on, sizeof on) != 0) {
    return nullptr;
  }
  return std::unique_ptr<DescriptorBroker>(new DescriptorBroker(
      std::move(sockets->ours), std::move(sockets->theirs), std::move(is_lost)));
}

// A broker has said that it is there. Any other process of this run that sends that is taken for a
// broker, and is killed like one. A process that is not of this run is not.
void DescriptorBroker::Adopt(pid_t sender) {
  if (sender <= 0 || !DescendsFrom(sender, getpid())) return;
  Kill();
  pidfd_.Reset(OpenPidfd(sender));
  pid_ = pidfd_ ? sender : 0;
}

// Takes what has come unasked: the first message of a new broker. Answers that nobody waits for any
// more are dropped.
void DescriptorBroker::Hear() {
  for (int message = 0; message < kMostUnasked; ++message) {
    shm::BrokerAnswer answer{};
    const Passed passed = ReceivePassed(socket_.get(), &answer, sizeof answer, MSG_DONTWAIT);
    if (passed.size <= 0) return;
    if (passed.size == sizeof answer && answer.serial == 0) Adopt(passed.sender);
  }
}

bool DescriptorBroker::Is(pid_t pid) {
  Hear();
  return pid_ != 0 && pid == pid_;
}

UniqueFd DescriptorBroker::Await(std::uint32_t serial) {
  const std::int64_t starved_ms = NowMs() + kMostStarvedMs;
  std::int64_t until_ms = NowMs() + kMostWaitMs;
  for (;;) {
    pollfd fds[] = {{socket_.get(), POLLIN, 0}, {pidfd_.get(), POLLIN, 0}};
    if (NowMs() > until_ms || !PollUntil(fds, until_ms)) {
      const char state = ThreadState(pid_);
      if ((state == 'R' || state == 'D') && NowMs() < starved_ms) {
        until_ms = NowMs() + kMostWaitMs;
        continue;
      }
      // The broker may have answered just now, and sleep again.
      if (!PollUntil(fds, NowMs())) {
        errno = ETIMEDOUT;
        return {};
      }
    }
    if ((fds[0].revents & POLLIN) == 0) {
      errno = ESRCH;
      return {};
    }
    shm::BrokerAnswer answer{};
    Passed passed = ReceivePassed(socket_.get(), &answer, sizeof answer, MSG_DONTWAIT);
    if (passed.size == sizeof answer && answer.serial == 0) Adopt(passed.sender);
    if (passed.size == 0 || (passed.size > 0 && answer.serial == 0)) {
      errno = ESRCH;
      return {};
    }
    if (passed.size != sizeof answer || answer.serial != serial) continue;
    errno = answer.error != 0 ? answer.error : EBADF;
    return std::move(passed.fd);
  }
}

UniqueFd DescriptorBroker::CopyOf(int number) {
  Hear();
  if (!pidfd_) {
    errno = ESRCH;
    return {};
  }
  if (++serial_ == 0) ++serial_;
  const shm::BrokerRequest request{number, serial_};
  const bool is_sent =
      send(socket_.get(), &request, sizeof request, MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof request;
  UniqueFd copy = is_sent ? Await(serial_) : UniqueFd();
  if (copy || (is_sent && errno != ETIMEDOUT && errno != ESRCH)) return copy;
  // The broker may have been gone before it was asked.
  const int error = errno == EPIPE ? ESRCH : errno;
  End();
  is_lost_();
  errno = error;
  return {};
}

void DescriptorBroker::End() {
  Hear();
  Kill();
}

void DescriptorBroker::Kill() {
  pid_ = 0;
  const UniqueFd pidfd = std::move(pidfd_);
  if (!pidfd) return;
  KillByPidfd(pidfd.get());
  pollfd gone[] = {{pidfd.get(), POLLIN, 0}};
  PollUntil(gone, NowMs() + kMostWaitMs);
  siginfo_t info;
  waitid(P_PIDFD, static_cast<id_t>(pidfd.get()), &info, WEXITED | WNOHANG | __WALL);
}

}  // namespace tcs
