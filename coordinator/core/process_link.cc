#include "coordinator/core/process_link.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <new>

#include "coordinator/os/shared_memory.h"

namespace tcs {

namespace {

constexpr std::size_t kKeptAfterEnd = 64;

}  // namespace

std::unique_ptr<ProcessLink> ProcessLink::Make() {
  std::unique_ptr<ProcessLink> link(new ProcessLink);
  const SharedMemory memory = MakeSharedMemory("tcs", shm::kProcessMemorySize);
  if (memory.fd < 0) return nullptr;
  link->memory_fd_ = memory.fd;
  link->slots_ = static_cast<shm::ThreadSlot*>(memory.at);
  if (pipe2(link->pipe_, O_CLOEXEC) != 0) return nullptr;
  fcntl(link->pipe_[0], F_SETFL, O_NONBLOCK);
  return link;
}

ProcessLink::~ProcessLink() {
  if (slots_ != nullptr) munmap(slots_, shm::kProcessMemorySize);
  for (const int fd : {memory_fd_, pipe_[0], pipe_[1]}) {
    if (fd >= 0) close(fd);
  }
}

int ProcessLink::TakeSlot(Task& task) {
  int index = static_cast<int>(tasks_.size());
  if (freed_.size() > kKeptAfterEnd || tasks_.size() == shm::kSlotCount) {
    if (freed_.empty()) return -1;
    index = freed_.front();
    freed_.pop_front();
  } else {
    tasks_.push_back(nullptr);
  }
  tasks_[static_cast<std::size_t>(index)] = &task;
  new (&slots_[index]) shm::ThreadSlot{};
  return index;
}

void ProcessLink::FreeSlot(int index) {
  tasks_[static_cast<std::size_t>(index)] = nullptr;
  freed_.push_back(index);
}

Task* ProcessLink::TaskAt(std::uint32_t index) const {
  return index < tasks_.size() ? tasks_[index] : nullptr;
}

}  // namespace tcs
