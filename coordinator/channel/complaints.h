// What is wrong with what comes over a channel, said on stderr: the first time, and again whenever
// there has been ten times as much of it. A program that errs does so a thousand times a second.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>

namespace tcs {

class Complaints {
 public:
  // `what` is the rest of a sentence about the channel.
  void Say(const std::string& channel, const std::string& what) {
    const std::int64_t count = ++counts_[channel];
    if (!IsPowerOfTen(count)) return;
    const std::string so_far = count == 1 ? "" : fmt::format(" ({} so far)", count);
    fmt::print(stderr, "tcsim: channel {}: {}{}\n", channel, what, so_far);
  }

 private:
  static bool IsPowerOfTen(std::int64_t count) {
    while (count >= 10 && count % 10 == 0) count /= 10;
    return count == 1;
  }

  std::map<std::string, std::int64_t> counts_;
};

}  // namespace tcs
