#include "libtcs_preload/cycle_counter/stand_ins.h"

#include <sys/mman.h>

#include "libtcs_preload/cycle_counter/entries.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/spinning/pauses.h"

namespace tcs::preload {

// At the begin of the memory, where its code finds the entries.
struct StandInMemory {
  void (*plain)() = tcs_read_counter;
  void (*with_processor)() = tcs_read_counter_and_processor;
  void (*pause)() = tcs_pause;
  StandInMemory* next = nullptr;
  std::size_t size = 0;
};

namespace {

using shm::Code;
using shm::CodeRange;
using shm::CodeWriter;

constexpr std::size_t kPage = 4096, kMostOfOne = 128;
constexpr std::int64_t kReach = 0x7000'0000;  // less than a jump's, by more than an image's slack

bool Reaches(const std::uint8_t* memory, std::size_t size, CodeRange image) {
  return memory + size - image.begin < kReach && image.end - memory < kReach;
}

std::uint8_t* Map(const std::uint8_t* where, std::size_t size, int how) {
  const long at = RawSyscall(SYS_mmap, reinterpret_cast<long>(where), static_cast<long>(size),
                             PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | how, -1, 0L);
  return at < 0 && at > -4096 ? nullptr : reinterpret_cast<std::uint8_t*>(at);
}

// Memory next to images is mostly taken, by others; so the steps become longer.
std::uint8_t* MapNear(CodeRange image, std::size_t size) {
  std::uint8_t* memory = Map(nullptr, size, 0);
  if (memory != nullptr && Reaches(memory, size, image)) return memory;
  if (memory != nullptr) RawSyscall(SYS_munmap, Arg(memory), static_cast<long>(size));
  const auto page_of = [](Code at) { return at - reinterpret_cast<std::uintptr_t>(at) % kPage; };
  for (std::ptrdiff_t step = 16 * kPage; step < kReach; step += step / 2 / kPage * kPage) {
    for (const Code where : {page_of(image.begin) - step, page_of(image.end) + step}) {
      if (reinterpret_cast<std::uintptr_t>(where) >
          reinterpret_cast<std::uintptr_t>(image.end) + static_cast<std::uintptr_t>(kReach)) {
        continue;  // below 0
      }
      memory = Map(where, size, MAP_FIXED_NOREPLACE);
      if (memory == nullptr) continue;
      if (Reaches(memory, size, image)) return memory;
      RawSyscall(SYS_munmap, Arg(memory), static_cast<long>(size));
    }
  }
  return nullptr;
}

// lea -128(%rsp), %rsp: the memory below the stack pointer is the function's. lea changes no flag.
constexpr std::uint8_t kPassRedZone[] = {0x48, 0x8d, 0x64, 0x24, 0x80};
constexpr std::uint8_t kBack[] = {0x48, 0x8d, 0xa4, 0x24, 0x80, 0, 0, 0};
constexpr std::uint8_t kCallAtAddress[] = {0xff, 0x15};

std::size_t EntryFor(Code read) {
  switch (read[1]) {
    case 0x90:
      return offsetof(StandInMemory, pause);
    case 0x31:
      return offsetof(StandInMemory, plain);
    default:
      return offsetof(StandInMemory, with_processor);
  }
}

}  // namespace

StandIns::StandIns(CodeRange image, std::size_t reads, const shm::Sought& sought)
    : sought_(sought) {
  size_ = (sizeof(StandInMemory) + reads * kMostOfOne + kPage - 1) / kPage * kPage;
  std::uint8_t* const at = MapNear(image, size_);
  if (at == nullptr) return;
  memory_ = reinterpret_cast<StandInMemory*>(at);
  *memory_ = StandInMemory{.size = size_};
  used_ = sizeof(StandInMemory);
}

Code StandIns::Add(const shm::Replacement& replacement) {
  std::uint8_t* const begin = reinterpret_cast<std::uint8_t*>(memory_);
  std::uint8_t* const place = begin + used_;
  CodeWriter writer(place, place, size_ - used_);
  shm::WriteStandIn(writer, replacement, sought_, [&](CodeWriter& code, Code read) {
    code.Bytes(kPassRedZone);
    code.Leading(kCallAtAddress, begin + EntryFor(read));
    code.Bytes(kBack);
  });
  if (!writer.is_sound()) return nullptr;
  used_ += writer.size();
  return place;
}

bool StandIns::Finish(StandInMemory** list) {
  memory_->next = *list;
  *list = memory_;
  return RawSyscall(SYS_mprotect, Arg(memory_), static_cast<long>(size_), PROT_READ | PROT_EXEC) ==
         0;
}

void Free(StandInMemory* first) {
  while (first != nullptr) {
    StandInMemory* const next = first->next;
    RawSyscall(SYS_munmap, Arg(first), static_cast<long>(first->size));
    first = next;
  }
}

}  // namespace tcs::preload
