#include "libtcs_preload/cycle_counter/image_reads.h"

#include <sys/mman.h>

#include "libtcs_preload/raw_syscall.h"
#include "shm/machine_code/replacement_plan.h"

namespace tcs::preload {

namespace {

using shm::Code;
using shm::CodeRange;

constexpr std::size_t kPage = 4096;

// Memory for the plan, from the kernel: the program's allocator may not be asked, and its stack may
// be small.
class Room {
 public:
  Room() {
    const long at =
        RawSyscall(SYS_mmap, 0, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at > 0) room_ = reinterpret_cast<shm::PlanRoom*>(at);
  }
  ~Room() {
    if (room_ != nullptr) RawSyscall(SYS_munmap, Arg(room_), kSize);
  }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  shm::PlanRoom* get() const { return room_; }

 private:
  static constexpr long kSize = (sizeof(shm::PlanRoom) + kPage - 1) / kPage * kPage;

  shm::PlanRoom* room_ = nullptr;
};

// A part of a segment can be written while this object lives.
class Writable {
 public:
  Writable(CodeRange part, const Elf64_Phdr& segment)
      : begin_(part.begin - reinterpret_cast<std::uintptr_t>(part.begin) % kPage),
        size_(static_cast<std::size_t>(part.end - begin_)),
        protection_(PROT_READ | PROT_EXEC | ((segment.p_flags & PF_W) != 0 ? PROT_WRITE : 0)),
        is_writable_(Protect(PROT_READ | PROT_WRITE | PROT_EXEC)) {}
  ~Writable() {
    if (is_writable_) Protect(protection_);
  }
  Writable(const Writable&) = delete;
  Writable& operator=(const Writable&) = delete;

  explicit operator bool() const { return is_writable_; }

 private:
  bool Protect(int protection) const {
    return RawSyscall(SYS_mprotect, Arg(begin_), static_cast<long>(size_), protection) == 0;
  }

  const Code begin_;
  const std::size_t size_;
  const int protection_;
  const bool is_writable_;
};

// Notes a read that is not replaced, after all.
void Leave(const shm::Replacement& one, LeftReads* left) {
  if (!shm::IsPause(one.read, one.moved.end)) left->Add(one.read);
}

void Replace(const shm::Replacements& found, const shm::Sought& sought, CodeRange image,
             CodeRange code, const Elf64_Phdr& segment, LeftReads* left, StandInMemory** memory) {
  StandIns stand_ins(image, found.count(), sought);
  const auto leave = [&] {
    for (std::size_t i = 0; i < found.count(); ++i) Leave(found[i], left);
  };
  if (!stand_ins.is_there()) return leave();
  const Writable writable(code, segment);
  if (!writable) return leave();
  // No thread executes the code before it is complete.
  for (std::size_t i = 0; i < found.count(); ++i) {
    const Code stand_in = stand_ins.Add(found[i]);
    const bool leads = stand_in != nullptr &&
                       shm::LeadToStandIn(found[i], stand_in,
                                          [](Code at, const std::uint8_t* bytes, std::size_t size) {
                                            memcpy(const_cast<std::uint8_t*>(at), bytes, size);
                                          });
    if (!leads) Leave(found[i], left);
  }
  stand_ins.Finish(memory);
}

void ReplaceIn(const shm::Image& image, const shm::Sought& sought,
               const shm::UnwindTable& functions, CodeRange code, const Elf64_Phdr& segment,
               LeftReads* left, StandInMemory** memory) {
  const Room room;
  if (room.get() == nullptr) return;
  shm::Replacements found(*room.get(), sought);
  found.Plan(code, functions, [left](Code read) { left->Add(read); });
  if (found.count() > 0) Replace(found, sought, image.Whole(), code, segment, left, memory);
}

}  // namespace

StandInMemory* ReplaceReads(const shm::Image& image, const shm::Sought& sought, LeftReads* left) {
  StandInMemory* memory = nullptr;
  const shm::UnwindTable functions = image.Functions();
  image.ForEachCode([&](CodeRange code, const Elf64_Phdr& segment) {
    ReplaceIn(image, sought, functions, code, segment, left, &memory);
  });
  return memory;
}

}  // namespace tcs::preload
