// A pseudo-terminal that stands for a device: the far end is where the device would be, and a
// program opens the near end. The object holds both ends, so that the terminal is never hung up.
//
// A worker of the kernel hands over the bytes that are written to one end. Here the bytes are there
// when the call returns, as far as the program's settings let them be seen at all.
//
// Owns its descriptors, which are close-on-exec. Used by one thread at a time.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class Terminal {
 public:
  // A raw terminal, as `stty raw -echo` leaves it, set to `baud`. Or why there is none: strerror's
  // words.
  [[nodiscard]] static std::variant<Terminal, std::string> Open(int baud);

  // For epoll: readable once a program has written something.
  int fd() const { return far_.get(); }
  // The path that programs open: "/dev/pts/3".
  const std::string& path() const { return path_; }

  // Writes to the program. Bytes for which the terminal has no room, because no program reads, are
  // lost.
  void Write(std::string_view bytes) const;
  // All bytes that programs have written.
  std::string Read() const;

  // The rate that programs have set the terminal to.
  int Baud() const;
  // Whether a process of this user's other than this one has the terminal open.
  bool IsOpen() const;

 private:
  Terminal(UniqueFd far, UniqueFd near, std::string path)
      : far_(std::move(far)), near_(std::move(near)), path_(std::move(path)) {}

  UniqueFd far_, near_;
  std::string path_;
};

}  // namespace tcs
