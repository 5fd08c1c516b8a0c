#include "coordinator/dump/outside.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/dump/kernel.h"
#include "coordinator/os/descendants.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/unique_fd.h"
#include "shm/layout.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

const char* WordsFor(shm::NotificationKind kind) {
  using Kind = shm::NotificationKind;
  switch (kind) {
    case Kind::kNone:
      return "nothing";
    case Kind::kHorizon:
      return "to go on at its horizon";
    case Kind::kRead:
      return "to read";
    case Kind::kWrite:
    case Kind::kReaches:
      return "to write";
    case Kind::kIdle:
      return "to sleep";
    case Kind::kWaitFds:
      return "to wait for descriptors";
    case Kind::kWaitChild:
      return "to wait for a child";
    case Kind::kWaitObject:
      return "to wait for a System V object or a listener";
    case Kind::kDdsWait:
    case Kind::kDdsSync:
      return "to wait for DDS messages";
    case Kind::kDdsRoom:
      return "to wait for room for its DDS messages";
    case Kind::kYield:
      return "to let others run";
    case Kind::kSpins:
      return "to see what others write to memory";
    case Kind::kKernelWait:
      return "for a call in which the kernel may hold it";
    case Kind::kCall:
    case Kind::kPreempted:
      return "to go on with a call";
    default:
      return "for something else";
  }
}

Json DescribedSlot(const shm::ThreadSlot& slot) {
  const std::uint32_t gate = slot.gate.load();
  const auto never = [](std::int64_t ns) { return ns == shm::kNeverNs ? Json(nullptr) : Json(ns); };
  return {{"asked", WordsFor(slot.note.kind)},
          {"at_ns", slot.note.time_ns},
          {"until_ns", never(slot.note.deadline_ns)},
          {"shown_ns", slot.clock.last_shown_ns.load()},
          {"horizon_ns", slot.clock.horizon_ns},
          {"gate", gate == shm::kGateOpen      ? "open"
                   : gate == shm::kGateWaiting ? "waiting"
                                               : "closed"}};
}

// The slots that are in use in a process's memory, by their threads. Holes in the memory are left
// alone: a hole that is mapped and read would become memory.
void AddSlotsIn(int memory, std::map<pid_t, Json>* slots) {
  constexpr auto kSlot = static_cast<off_t>(sizeof(shm::ThreadSlot));
  // As bytes: the slot is another process's, which may write it meanwhile.
  alignas(shm::ThreadSlot) unsigned char bytes[sizeof(shm::ThreadSlot)];
  const auto size = static_cast<off_t>(shm::kProcessMemorySize);
  for (off_t at = 0; at + kSlot <= size;) {
    const off_t data = lseek(memory, at, SEEK_DATA);
    if (data < 0) return;
    at = std::max(at, data / kSlot * kSlot);
    if (pread(memory, bytes, sizeof bytes, at) != kSlot) return;
    const auto& slot = *reinterpret_cast<const shm::ThreadSlot*>(bytes);
    if (slot.tid > 0) (*slots)[slot.tid] = DescribedSlot(slot);
    at += kSlot;
  }
}

std::map<pid_t, Json> SlotsOf(pid_t coordinator) {
  std::map<pid_t, Json> slots;
  const std::string folder = fmt::format("/proc/{}/fd", coordinator);
  DIR* descriptors = opendir(folder.c_str());
  if (descriptors == nullptr) return slots;
  while (const dirent* entry = readdir(descriptors)) {
    const std::string path = folder + "/" + entry->d_name;
    char text[64];
    const ssize_t size = readlink(path.c_str(), text, sizeof text);
    const bool is_processes = size > 0 && std::string_view(text, static_cast<std::size_t>(size)) ==
                                              "/memfd:tcs (deleted)";
    if (!is_processes) continue;
    const UniqueFd memory(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (memory) AddSlotsIn(memory.get(), &slots);
  }
  closedir(descriptors);
  return slots;
}

}  // namespace

Json SeenFromOutside(const FoundRun& run) {
  const std::map<pid_t, Json> slots = SlotsOf(run.coordinator);
  Json processes = Json::array();
  for (const pid_t pid : DescendantsOf(run.coordinator)) {
    Json threads = Json::array();
    bool has_slot = false;
    for (const pid_t tid : ThreadsOf(pid)) {
      Json thread = {{"tid", tid}, {"kernel", KernelStateOf(pid, tid)}};
      const auto slot = slots.find(tid);
      if (slot != slots.end()) thread["slot"] = slot->second;
      has_slot |= slot != slots.end();
      threads.push_back(std::move(thread));
    }
    processes.push_back({{"pid", pid},
                         {"name", KernelNameOf(pid)},
                         {"registered", has_slot},
                         {"threads", std::move(threads)}});
  }
  return {{"processes", std::move(processes)}};
}

}  // namespace tcs
