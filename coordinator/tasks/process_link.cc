#include "coordinator/tasks/process_link.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <new>
#include <optional>
#include <utility>

#include "coordinator/os/shared_memory.h"

namespace tcs {

namespace {

constexpr std::size_t kKeptAfterEnd = 64;

}  // namespace

std::unique_ptr<ProcessLink> ProcessLink::Make() {
  std::unique_ptr<ProcessLink> link(new ProcessLink);
  SharedMemory memory = MakeSharedMemory("tcs", shm::kProcessMemorySize);
  if (!memory.fd) return nullptr;
  link->memory_fd_ = std::move(memory.fd);
  link->slots_ = static_cast<shm::ThreadSlot*>(memory.at);
  std::optional<Pipe> pipe = Pipe::Make();
  if (!pipe.has_value()) return nullptr;
  link->notifications_ = std::move(*pipe);
  fcntl(link->incoming_fd(), F_SETFL, O_NONBLOCK);
  return link;
}

ProcessLink::~ProcessLink() {
  if (slots_ != nullptr) munmap(slots_, shm::kProcessMemorySize);
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
