#include "libtcs_preload/select_sets.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>

#include <algorithm>
#include <iterator>

#include "libtcs_preload/outside.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"

namespace tcs::preload {

namespace {

constexpr short kEvents[] = {POLLIN, POLLOUT, POLLPRI};  // of the sets

// How many descriptors the kernel has room for in this process's table: of larger sets it looks at
// no more, and touches no more of the program's memory.
std::size_t RoomForDescriptors() {
  constexpr char kLine[] = "\nFDSize:";
  const long file =
      RawSyscall(SYS_openat, AT_FDCWD, Arg("/proc/thread-self/status"), O_RDONLY | O_CLOEXEC);
  if (file < 0) return FD_SETSIZE;
  char text[1024];
  const long size = RawSyscall(SYS_read, file, Arg(text), sizeof text - 1);
  RawSyscall(SYS_close, file);
  text[size > 0 ? size : 0] = '\0';
  const char* c = strstr(text, kLine);
  if (c == nullptr) return FD_SETSIZE;
  c += sizeof kLine - 1;
  while (*c == '\t' || *c == ' ') ++c;
  std::size_t room = 0;
  for (; *c >= '0' && *c <= '9'; ++c) room = room * 10 + static_cast<std::size_t>(*c - '0');
  return room;
}

}  // namespace

SelectSets::SelectSets(int count, fd_set* read, fd_set* write, fd_set* except)
    : user_{read, write, except}, count_(count < 0 ? 0 : static_cast<std::size_t>(count)) {
  if (count < 0) {
    error_ = EINVAL;
    return;
  }
  if (count_ > kOrdinary) {
    const std::size_t room = RoomForDescriptors();
    if (count_ > room) count_ = room;
  }
  words_ = (count_ + kWordBits - 1) / kWordBits;
  if (!MakeRoom()) {
    error_ = ENOMEM;
    return;
  }
  const std::size_t size = words_ * sizeof(std::uint64_t);
  for (int set = 0; set < kSets; ++set) {
    if (user_[set] == nullptr) continue;
    if (!CanRead(user_[set], size)) error_ = EFAULT;
    if (error_ == 0) memcpy(Set(wanted_, set), user_[set], size);
  }
  if (error_ == 0 && !MakeRoomForWanted()) error_ = ENOMEM;
}

SelectSets::Mapping::~Mapping() {
  if (memory_ != nullptr) RawSyscall(SYS_munmap, Arg(memory_), static_cast<long>(size_));
}

void* SelectSets::Mapping::Make(std::size_t size) {
  if (memory_ != nullptr) return memory_;
  const long made = RawSyscall(SYS_mmap, 0, static_cast<long>(size), PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (made < 0 && made > -4096) return nullptr;
  size_ = size;
  return memory_ = reinterpret_cast<void*>(made);
}

bool SelectSets::MakeRoom() {
  wanted_ = ordinary_sets_;
  if (count_ > kOrdinary) {
    wanted_ =
        static_cast<std::uint64_t*>(mapped_sets_.Make(2 * kSets * words_ * sizeof(std::uint64_t)));
  }
  if (wanted_ == nullptr) return false;
  found_ = wanted_ + kSets * words_;
  return true;
}

bool SelectSets::MakeRoomForWanted() {
  std::size_t count = 0;
  for (std::size_t word = 0; word < words_; ++word) {
    std::uint64_t any = 0;
    for (int set = 0; set < kSets; ++set) {
      if (user_[set] != nullptr) any |= Set(wanted_, set)[word];
    }
    count += static_cast<std::size_t>(__builtin_popcountll(any));
  }
  fds_ = count <= kFew ? ordinary_fds_
                       : static_cast<pollfd*>(mapped_fds_.Make(count * sizeof(pollfd)));
  return fds_ != nullptr;
}

bool SelectSets::Wants(int set, std::size_t fd) const {
  return user_[set] != nullptr && (Set(wanted_, set)[fd / kWordBits] >> (fd % kWordBits) & 1) != 0;
}

long SelectSets::Probe() {
  long sets[kSets];
  for (int set = 0; set < kSets; ++set) {
    std::uint64_t* copy = Set(found_, set);
    sets[set] = user_[set] == nullptr ? 0 : Arg(copy);
    if (user_[set] != nullptr) {
      memcpy(copy, Set(wanted_, set), words_ * sizeof(std::uint64_t));
    }
  }
  timeval now{};
  return RawSyscall(SYS_select, static_cast<long>(count_), sets[0], sets[1], sets[2], Arg(&now));
}

long SelectSets::ProbeAgain() {
  if (const long found = Probe(); found != -EBADF) return found;
  const auto bit = [this](std::uint64_t* sets, int set, int fd) -> std::uint64_t& {
    return Set(sets, set)[static_cast<std::size_t>(fd) / kWordBits];
  };
  unsigned long count = 0;
  Wanted(&count);
  for (unsigned long i = 0; i < count; ++i) {
    const int fd = fds_[i].fd;
    const bool is_closed = RawSyscall(SYS_fcntl, fd, F_GETFD) == -EBADF;
    fds_[i].revents = is_closed ? fds_[i].events : 0;
    for (int set = 0; is_closed && set < kSets; ++set) {
      bit(wanted_, set, fd) &= ~(std::uint64_t{1} << (fd % kWordBits));
    }
  }
  long found = Probe();
  for (unsigned long i = 0; found >= 0 && i < count; ++i) {
    for (int set = 0; set < kSets; ++set) {
      if ((fds_[i].revents & kEvents[set]) == 0) continue;
      bit(found_, set, fds_[i].fd) |= std::uint64_t{1} << (fds_[i].fd % kWordBits);
      ++found;
    }
  }
  return found;
}

// Hides what is to be read, and what is exceptional; of a connection that is being made the room to
// write, too.
long SelectSets::WithoutHidden(GuestThread& thread, long found) {
  if (found <= 0 || !IsAnythingOutside()) return found;
  for (std::size_t fd = 0; fd < count_; ++fd) {
    const std::uint64_t bit = std::uint64_t{1} << (fd % kWordBits);
    const auto is_found = [&](int set) {
      return user_[set] != nullptr && (Set(found_, set)[fd / kWordBits] & bit) != 0;
    };
    if (!is_found(0) && !is_found(1) && !is_found(2)) continue;
    const Hides hides = HiddenOf(thread, OutsideOf(static_cast<int>(fd)));
    for (int set = 0; set < kSets; ++set) {
      const bool hides_set = set == 1 ? hides == Hides::kAll : hides != Hides::kNothing;
      if (!hides_set || !is_found(set)) continue;
      Set(found_, set)[fd / kWordBits] &= ~bit;
      --found;
    }
  }
  return found;
}

const pollfd* SelectSets::Wanted(unsigned long* count) {
  *count = 0;
  for (std::size_t fd = 0; fd < count_; ++fd) {
    short events = 0;
    for (int set = 0; set < kSets; ++set) {
      if (Wants(set, fd)) events |= kEvents[set];
    }
    if (events != 0) fds_[(*count)++] = pollfd{static_cast<int>(fd), events, 0};
  }
  return fds_;
}

int SelectSets::PutBack() {
  const std::size_t size = words_ * sizeof(std::uint64_t);
  for (int set = 0; set < kSets; ++set) {
    if (user_[set] == nullptr) continue;
    if (!CanOverwrite(user_[set], size)) return EFAULT;
    memcpy(user_[set], Set(found_, set), size);
  }
  return 0;
}

}  // namespace tcs::preload
