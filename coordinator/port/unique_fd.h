// A descriptor that its owner closes when the owner ends, or is given another descriptor. Closing
// keeps errno.
#pragma once

#include <errno.h>
#include <unistd.h>

#include <utility>

namespace tcs {

class UniqueFd {
 public:
  UniqueFd() = default;
  // Takes the descriptor over; a negative number is none.
  explicit UniqueFd(int fd) : fd_(fd < 0 ? -1 : fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(other.Release()) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    Reset(other.Release());
    return *this;
  }
  ~UniqueFd() { Reset(); }

  int get() const { return fd_; }  // -1: none
  explicit operator bool() const { return fd_ >= 0; }

  // Gives the descriptor away: the caller owns it.
  [[nodiscard]] int Release() { return std::exchange(fd_, -1); }
  // Closes the descriptor and takes `fd` over, which must not be the same.
  void Reset(int fd = -1) {
    const int old = std::exchange(fd_, fd < 0 ? -1 : fd);
    if (old < 0) return;
    const int saved = errno;
    close(old);
    errno = saved;
  }

 private:
  int fd_ = -1;
};

}  // namespace tcs
