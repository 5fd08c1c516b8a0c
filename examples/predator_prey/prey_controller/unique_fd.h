// A file descriptor that is closed with its owner.
#pragma once

#include <unistd.h>

namespace predator_prey {

class UniqueFd {
 public:
  explicit UniqueFd(int fd) : fd_(fd) {}
  ~UniqueFd() {
    if (fd_ >= 0) ::close(fd_);
  }
  UniqueFd(UniqueFd&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  UniqueFd& operator=(UniqueFd&&) = delete;

  int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace predator_prey
