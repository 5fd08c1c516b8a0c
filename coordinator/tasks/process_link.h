// The connection of one process with the coordinator: the memory with the slots of its threads, and
// the pipe for its notifications. No other process has either, so that none can speak for this
// process, or take what it says. Lives from the process's first attach to its end, whatever the
// process executes meanwhile.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "coordinator/os/pipe.h"
#include "coordinator/port/unique_fd.h"
#include "shm/layout.h"

namespace tcs {

struct Task;

class ProcessLink {
 public:
  // Null: errno is set.
  static std::unique_ptr<ProcessLink> Make();
  ~ProcessLink();
  ProcessLink(const ProcessLink&) = delete;
  ProcessLink& operator=(const ProcessLink&) = delete;

  // The index of an empty slot, which is the task's from now on; -1: there is no more room.
  int TakeSlot(Task& task);
  // The slot is not given again soon: a last word of its thread may still be in the pipe.
  void FreeSlot(int index);
  // Null: the slot is no task's.
  Task* TaskAt(std::uint32_t index) const;
  shm::ThreadSlot& SlotAt(int index) const { return slots_[index]; }

  int memory_fd() const { return memory_fd_.get(); }
  int notify_fd() const { return notifications_.write_end.get(); }   // the process's end,
  int incoming_fd() const { return notifications_.read_end.get(); }  // our end, which never waits

 private:
  ProcessLink() = default;

  UniqueFd memory_fd_;
  Pipe notifications_;
  shm::ThreadSlot* slots_ = nullptr;
  std::vector<Task*> tasks_;  // by slot, of all slots that were ever used
  std::deque<int> freed_;     // the earliest first
};

}  // namespace tcs
