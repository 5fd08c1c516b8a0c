#include "coordinator/calls/syscall_draws.h"

#include <errno.h>
#include <limits.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/tasks/client_values.h"
#include "shm/draws.h"

namespace tcs {

namespace {

constexpr std::uint64_t kMostBytes = 32 << 20;  // of one call; the kernel, too, may give fewer

enum class Source { kNone, kBytes, kUuid };

Source SourceOf(int fd) {
  struct stat status;
  if (fd < 0 || fstat(fd, &status) != 0) return Source::kNone;
  if (shm::IsRandomDevice(status)) return Source::kBytes;
  if (!shm::MayBeUuidFile(status)) return Source::kNone;
  char name[sizeof shm::kUuidFile];
  const ssize_t size = readlink(("/proc/self/fd/" + std::to_string(fd)).c_str(), name, sizeof name);
  const bool is_uuid = size > 0 && std::string_view(name, static_cast<std::size_t>(size)) ==
                                       std::string_view(shm::kUuidFile);
  return is_uuid ? Source::kUuid : Source::kNone;
}

// Where read or readv puts what it reads; none: the kernel refuses the call.
std::optional<std::vector<iovec>> BuffersOf(const Task& task, const TrappedCall& call) {
  if (call.number == SYS_read) {
    return std::vector<iovec>{{reinterpret_cast<void*>(call.args[1]), call.args[2]}};
  }
  const auto count = static_cast<int>(call.args[2]);
  if (count < 0 || count > IOV_MAX) return std::nullopt;
  std::vector<iovec> buffers(static_cast<std::size_t>(count));
  const std::size_t size = buffers.size() * sizeof buffers[0];
  if (count > 0 && !ReadMemory(task.process->pid, call.args[1], buffers.data(), size)) {
    return std::nullopt;
  }
  return buffers;
}

// Fills a piece of the client's memory. Returns how many bytes were filled before the memory ended.
std::uint64_t Draw(Task& task, std::uint64_t address, std::uint64_t size) {
  std::array<char, 65536> drawn;
  std::uint64_t done = 0;
  while (done < size) {
    const std::size_t n = std::min<std::uint64_t>(drawn.size(), size - done);
    task.process->draws.Fill(drawn.data(), n);
    if (!WriteMemory(task.process->pid, address + done, drawn.data(), n)) break;
    done += n;
  }
  return done;
}

std::int64_t ReadBytes(Task& task, const std::vector<iovec>& buffers) {
  std::uint64_t done = 0;
  for (const iovec& buffer : buffers) {
    const std::uint64_t size = std::min<std::uint64_t>(buffer.iov_len, kMostBytes - done);
    const std::uint64_t drawn = Draw(task, reinterpret_cast<std::uint64_t>(buffer.iov_base), size);
    done += drawn;
    if (drawn < size) return done > 0 ? static_cast<std::int64_t>(done) : -EFAULT;
  }
  return static_cast<std::int64_t>(done);
}

// The kernel makes an identifier, whose digits are drawn anew. The read counts for the client, too:
// both have the same open file.
std::int64_t ReadUuid(Task& task, int fd, const std::vector<iovec>& buffers) {
  std::uint64_t room = 0;
  for (const iovec& buffer : buffers) room += std::min<std::uint64_t>(buffer.iov_len, INT_MAX);
  char text[64];
  const ssize_t got = read(fd, text, std::min<std::uint64_t>(room, sizeof text));
  if (got <= 0) return got < 0 ? -errno : 0;
  const auto size = static_cast<std::size_t>(got);
  shm::DrawUuid(task.process->draws, text, size);
  std::size_t done = 0;
  for (const iovec& buffer : buffers) {
    const std::size_t n = std::min<std::size_t>(buffer.iov_len, size - done);
    const auto address = reinterpret_cast<std::uint64_t>(buffer.iov_base);
    if (n > 0 && !WriteMemory(task.process->pid, address, text + done, n)) return -EFAULT;
    done += n;
  }
  return got;
}

}  // namespace

std::int64_t SyscallDraws::GetRandom(Task& task, const TrappedCall& call) {
  const auto flags = static_cast<unsigned>(call.args[2]);
  constexpr unsigned kSources = GRND_RANDOM | GRND_INSECURE;
  if ((flags & ~(kSources | GRND_NONBLOCK)) != 0 || (flags & kSources) == kSources) return -EINVAL;
  return ReadBytes(task, {{reinterpret_cast<void*>(call.args[0]), call.args[1]}});
}

bool SyscallDraws::Read(Task& task, const TrappedCall& call, const RemoteDescriptor& fd) const {
  if (!run_.IsFixed() || (call.number != SYS_read && call.number != SYS_readv)) return false;
  const Source source = SourceOf(fd.fd());
  if (source == Source::kNone || !fd.CanBeRead()) return false;
  const std::optional<std::vector<iovec>> buffers = BuffersOf(task, call);
  if (!buffers.has_value()) return false;
  task.trap_result =
      source == Source::kBytes ? ReadBytes(task, *buffers) : ReadUuid(task, fd.fd(), *buffers);
  return true;
}

}  // namespace tcs
