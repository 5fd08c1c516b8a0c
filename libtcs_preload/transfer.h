// Moving all of some buffers, as a call that may wait does it, in parts that need not wait.
#pragma once

#include <errno.h>
#include <sys/uio.h>

#include <cstddef>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_wait.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/own_work.h"

namespace tcs::preload {

// The rest of some buffers. The object reads their list only when asked for bytes(), or when some
// bytes have been used: then the kernel has read the list, too, so the memory is there.
class Rest {
 public:
  Rest(const iovec* iov, std::size_t count) : iov_(iov), count_(count) {}
  std::size_t bytes() {
    if (counted_) return bytes_;
    for (std::size_t i = 0; i < count_; ++i) bytes_ += iov_[i].iov_len;
    counted_ = true;
    return bytes_;
  }

  // The whole rest, or, where something has been used already, as much as fits into the copy.
  const iovec* Next(std::size_t* count) {
    if (offset_ == 0) {
      *count = count_;
      return iov_;
    }
    *count = count_ < kCopied ? count_ : kCopied;
    for (std::size_t i = 0; i < *count; ++i) copy_[i] = iov_[i];
    copy_[0].iov_base = static_cast<char*>(copy_[0].iov_base) + offset_;
    copy_[0].iov_len -= offset_;
    return copy_;
  }

  void Use(std::size_t bytes) {
    bytes_ = this->bytes() - bytes;
    offset_ += bytes;
    while (count_ > 0 && offset_ >= iov_->iov_len) {
      offset_ -= iov_->iov_len;
      ++iov_;
      --count_;
    }
  }

 private:
  static constexpr std::size_t kCopied = 16;  // the stack may be a small one
  const iovec* iov_;
  std::size_t count_, offset_ = 0, bytes_ = 0;
  bool counted_ = false;
  iovec copy_[kCopied];
};

// `part(fd, iov, count)` does what it can at once (-EAGAIN: nothing), the rest is waited for,
// unless the descriptor is not to wait, which is asked only then: mostly all is done at once.
// `part` takes `form_ticks` more than the call that the program has made (AsProgram). A part that
// the descriptor does not have (-EOPNOTSUPP), or that fails although the descriptor is ready, is
// left to `whole(fd)`. Returns what the call returns to its caller, or -errno.
template <class Part, class Whole>
long TransferAll(GuestThread& thread, int fd, short events, int timeout_option, Rest& rest,
                 std::uint64_t form_ticks, Part part, Whole whole) {
  const int saved = errno;
  CallFile file(thread, fd);
  std::int64_t deadline_ns = -1;
  bool may_wait = false, is_last = false;  // last: the time is over
  const auto all = [&] { return AsProgram(thread, [&] { return whole(file.fd()); }); };
  for (long done = 0;;) {
    std::size_t count = 0;
    const iovec* iov = rest.Next(&count);
    const long n = AsProgram(
        thread, [&] { return part(file.fd(), iov, count); }, form_ticks);
    if (n > 0) {
      done += n;
      rest.Use(static_cast<std::size_t>(n));
      if (rest.bytes() == 0) return done;
      continue;
    }
    const bool can_part = n != -EOPNOTSUPP || done > 0;
    if (n != -EAGAIN && can_part) return done > 0 ? done : n;
    if (!may_wait && IsNonBlocking(file.fd())) {
      if (!can_part) return all();
      AnswerByLook(thread);
      return done > 0 ? done : -EAGAIN;
    }
    may_wait = true;
    const bool is_hidden = (events & POLLIN) != 0 && IsHidden(thread, OutsideOf(file.fd()));
    if ((!can_part || done == 0) && !is_hidden && PollNow(file.fd(), events)) {
      // Or the call waits for what cannot be polled: room in the queue of the socket that it sends
      // to.
      return can_part ? WaitInKernel(thread, true, all) : all();
    }
    if (is_last) return done > 0 ? done : -EAGAIN;
    if (deadline_ns < 0) {
      deadline_ns =
          timeout_option != 0 ? SocketDeadline(thread, fd, timeout_option) : shm::kNeverNs;
    }
    const FdState state = AwaitEvent(file, events, deadline_ns, false);
    is_last = state == FdState::kTimedOut;
    if (state == FdState::kFailed) {
      const int error = errno;
      errno = saved;
      return done > 0 ? done : -error;
    }
  }
}

}  // namespace tcs::preload
