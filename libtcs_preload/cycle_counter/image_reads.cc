#include "libtcs_preload/cycle_counter/image_reads.h"

#include <sys/mman.h>

#include "libtcs_preload/cycle_counter/stand_ins.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

using shm::Code;
using shm::CodeRange;
using shm::NotReplaced;
using shm::Replacement;

constexpr std::size_t kPage = 4096;

// Replacements of a segment, in memory of their own while it is worked on: the program's allocator
// may not be asked, and its stack may be small.
class Found {
 public:
  Found() {
    const long at =
        RawSyscall(SYS_mmap, 0, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at > 0) list_ = reinterpret_cast<List*>(at);
  }
  ~Found() {
    if (list_ != nullptr) RawSyscall(SYS_munmap, Arg(list_), kSize);
  }
  Found(const Found&) = delete;
  Found& operator=(const Found&) = delete;

  bool is_there() const { return list_ != nullptr; }
  std::size_t count() const { return count_; }
  const Replacement& operator[](std::size_t i) const { return list_->replacements[i]; }

  // How all of it can be replaced; what cannot be is in `left`.
  void Plan(CodeRange code, const shm::UnwindTable& functions, LeftReads* left) {
    count_ = 0;
    shm::ReplacementPlan plan(functions);
    shm::ForEachLookingLikeARead(code, [&](Code read) {
      Replacement one;
      const CodeRange function = functions.FunctionAt(read);
      const NotReplaced why = plan.Next(function, read, list_->targets, target_count_, &one);
      const bool has_room = count_ < kMostReads;
      if (why == NotReplaced::kNo && has_room) list_->replacements[count_++] = one;
      const bool is_read = why == NotReplaced::kCodeIsUnknown ? shm::TakesUpCounter(read, code.end)
                                                              : why == NotReplaced::kNoRoom;
      if (is_read || (why == NotReplaced::kNo && !has_room)) left->Add(read);
    });
  }

  // True if something elsewhere in the code jumps into what is to be replaced; the next plan knows.
  bool IsEntered(CodeRange code) {
    const std::size_t before = target_count_;
    const Code least = list_->replacements[0].moved.begin;
    const Code most = list_->replacements[count_ - 1].moved.end;
    shm::ForEachLongTarget(code, [&](Code target) {
      if (target <= least || target >= most) return;
      if (target_count_ < kMostTargets && Enters(target)) list_->targets[target_count_++] = target;
    });
    return target_count_ != before;
  }

 private:
  static constexpr std::size_t kMostReads = 1024, kMostTargets = 256;
  struct List {
    Replacement replacements[kMostReads];
    Code targets[kMostTargets];
  };
  static constexpr long kSize = (sizeof(List) + kPage - 1) / kPage * kPage;

  bool Enters(Code target) const {
    std::size_t low = 0, high = count_;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (list_->replacements[middle].moved.end <= target) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low < count_ && list_->replacements[low].IsEnteredBy(target);
  }

  List* list_ = nullptr;
  std::size_t count_ = 0, target_count_ = 0;
};

// A part of a segment can be written while this lives.
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

void Replace(const Found& found, CodeRange image, CodeRange code, const Elf64_Phdr& segment,
             LeftReads* left) {
  StandIns stand_ins(image, found.count());
  const auto leave = [&] {
    for (std::size_t i = 0; i < found.count(); ++i) left->Add(found[i].read);
  };
  if (!stand_ins.is_there()) return leave();
  const Writable writable(code, segment);
  if (!writable) return leave();
  // Nobody executes the code before it is as a whole.
  for (std::size_t i = 0; i < found.count(); ++i) {
    const Code stand_in = stand_ins.Add(found[i]);
    const bool leads = stand_in != nullptr &&
                       shm::LeadToStandIn(found[i], stand_in,
                                          [](Code at, const std::uint8_t* bytes, std::size_t size) {
                                            memcpy(const_cast<std::uint8_t*>(at), bytes, size);
                                          });
    if (!leads) left->Add(found[i].read);
  }
  stand_ins.Finish();
}

void ReplaceIn(const shm::Image& image, const shm::UnwindTable& functions, CodeRange code,
               const Elf64_Phdr& segment, LeftReads* left) {
  bool looks_like_one = false;
  shm::ForEachLookingLikeARead(code, [&](Code) { looks_like_one = true; });
  if (!looks_like_one) return;
  Found found;
  if (!found.is_there()) return;
  LeftReads not_planned;
  constexpr int kMostPlans = 8;
  for (int i = 0;; ++i) {
    not_planned = {};
    found.Plan(code, functions, &not_planned);
    if (found.count() == 0 || !found.IsEntered(code)) break;
    if (i == kMostPlans) return;
  }
  if (not_planned.count > 0) {
    left->first = left->count == 0 ? not_planned.first : left->first;
    left->count += not_planned.count;
  }
  if (found.count() > 0) Replace(found, image.Whole(), code, segment, left);
}

}  // namespace

void ReplaceReads(const shm::Image& image, LeftReads* left) {
  const shm::UnwindTable functions = image.Functions();
  image.ForEachCode([&](CodeRange code, const Elf64_Phdr& segment) {
    ReplaceIn(image, functions, code, segment, left);
  });
}

}  // namespace tcs::preload
