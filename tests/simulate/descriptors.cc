#include "tests/simulate/descriptors.h"

#include <errno.h>
#include <string.h>

#include <algorithm>
#include <utility>

#include "shm/check.h"

namespace tcs::simulate {

void Descriptors::BecameReady(int fd) {
  for (auto& [number, set] : sets_) {
    if (!set.awaited.contains(fd)) continue;
    if (std::find(set.ready.begin(), set.ready.end(), fd) == set.ready.end())
      set.ready.push_back(fd);
  }
}

void Descriptors::Open(int fd) {
  files_.erase(fd);
  pipes_.erase(fd);
  sets_.erase(fd);
  for (auto& [number, set] : sets_) set.awaited.erase(fd);
}

void Descriptors::Join(int writes, int reads) {
  Open(writes);
  Open(reads);
  pipes_[writes] = reads;
}

void Descriptors::Raise(int fd) {
  ++files_[fd].count;
  BecameReady(fd);
}

void Descriptors::Lower(int fd) {
  TCS_CHECK(files_[fd].count > 0);
  --files_[fd].count;
}

bool Descriptors::Take(int fd) { return std::exchange(files_[fd].count, 0) > 0; }

void Descriptors::Write(int fd, const void* from, std::size_t size) {
  const int reads = pipes_.at(fd);
  const auto* const begin = static_cast<const unsigned char*>(from);
  std::vector<unsigned char>& bytes = files_[reads].bytes;
  bytes.insert(bytes.end(), begin, begin + size);
  BecameReady(reads);
}

ssize_t Descriptors::Read(int fd, void* to, std::size_t size) {
  std::vector<unsigned char>& bytes = files_[fd].bytes;
  const std::size_t count = std::min(size, bytes.size());
  if (count == 0) {
    errno = EAGAIN;
    return -1;
  }
  memcpy(to, bytes.data(), count);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<ssize_t>(count);
}

bool Descriptors::IsReadable(int fd) const {
  if (const auto set = sets_.find(fd); set != sets_.end()) return HasEvents(set->second);
  const auto found = files_.find(fd);
  return found != files_.end() && found->second.IsReadable();
}

bool Descriptors::ChangeSet(int set, int operation, int fd, const epoll_event* event) {
  WaitSet& it = sets_[set];
  const bool is_there = it.awaited.contains(fd);
  if (is_there == (operation == EPOLL_CTL_ADD)) {
    errno = is_there ? EEXIST : ENOENT;
    return false;
  }
  if (operation == EPOLL_CTL_DEL) {
    it.awaited.erase(fd);
    return true;
  }
  it.awaited[fd] = *event;
  if (IsReadable(fd)) BecameReady(fd);
  return true;
}

bool Descriptors::IsReady(const WaitSet& set, int fd) const {
  return IsReadable(fd) && set.awaited.contains(fd);
}

bool Descriptors::HasEvents(const WaitSet& set) const {
  return std::any_of(set.ready.begin(), set.ready.end(), [&](int fd) { return IsReady(set, fd); });
}

std::size_t Descriptors::TakeEvents(int set, std::span<epoll_event> events) {
  WaitSet& it = sets_[set];
  std::erase_if(it.ready, [&](int fd) { return !IsReady(it, fd); });
  const std::size_t count = std::min(events.size(), it.ready.size());
  for (std::size_t i = 0; i < count; ++i) {
    const int fd = it.ready.front();
    it.ready.pop_front();
    it.ready.push_back(fd);
    events[i] = {.events = EPOLLIN, .data = it.awaited[fd].data};
  }
  return count;
}

}  // namespace tcs::simulate
