// Samples on the stream between the gateway's two processes: a header, then the sample as CDR.
//
// Both ends are the same program, so a header is a struct as it lies in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace tcs::gateway {

struct Frame {
  std::uint32_t end = 0;          // the place of the sample's topic on the command line
  std::int64_t timestamp_ns = 0;  // DDS's source timestamp
  std::vector<std::byte> cdr;
};

class Frames {
 public:
  // A stream socket, which stays open.
  explicit Frames(int fd) : fd_(fd) {}

  // Callable from any thread. False: there is nobody at the other end any more.
  bool Send(std::uint32_t end, std::int64_t timestamp_ns, std::span<const std::byte> cdr);
  // For one thread, which waits. None: there is nobody at the other end any more.
  std::optional<Frame> Receive();

 private:
  bool ReadWhole(void* to, std::size_t size) const;

  int fd_;
  std::mutex mutex_;  // a frame at a time
};

}  // namespace tcs::gateway
