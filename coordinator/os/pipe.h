// A pipe, whose ends are closed with it, and at exec.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <optional>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct Pipe {
  UniqueFd read_end, write_end;

  // None: errno is set.
  static std::optional<Pipe> Make() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
    return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
  }
};

}  // namespace tcs
