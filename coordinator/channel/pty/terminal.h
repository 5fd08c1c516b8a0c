// A pseudo-terminal that stands for a device: its far end, where the device would be, and the near
// one, which a program opens. Both are held, so that it is never hung up.
//
// The kernel hands over what is written to one end by a worker of its own. Here it is there when
// the call returns, as far as the program's settings let it be seen at all.
//
// Owns its descriptors, which are close-on-exec. One thread at a time.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class Terminal {
 public:
  // Raw, as `stty raw -echo` leaves it, and set to `baud`. Or why there is none: strerror's words.
  [[nodiscard]] static std::variant<Terminal, std::string> Open(int baud);

  // For epoll: readable once a program has written something.
  int fd() const { return far_.get(); }
  // What programs open: "/dev/pts/3".
  const std::string& path() const { return path_; }

  // Writes to the program. Bytes for which the terminal has no room, because no program reads, are
  // lost.
  void Write(std::string_view bytes) const;
  // All that programs have written.
  std::string Read() const;

  // What programs have set it to.
  int Baud() const;
  // Whether a process of this user's other than this one has it open.
  bool IsOpen() const;

 private:
  Terminal(UniqueFd far, UniqueFd near, std::string path)
      : far_(std::move(far)), near_(std::move(near)), path_(std::move(path)) {}

  UniqueFd far_, near_;
  std::string path_;
};

}  // namespace tcs
