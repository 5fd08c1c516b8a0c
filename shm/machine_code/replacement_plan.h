// How all reads of the cycle counter, and pauses, in some code are replaced.
//
// Pure; async-signal-safe; memory is given by the caller.
#pragma once

#include "shm/machine_code/counter_reads.h"
#include "shm/machine_code/unlisted_functions.h"

namespace tcs::shm {

// How reads are replaced, one after the other as they lie in the code, so that none is in the way
// of another.
class ReplacementPlan {
 public:
  // `code`: the code that the reads are in.
  ReplacementPlan(CodeRange code, const UnwindTable& functions)
      : code_(code), functions_(functions) {}

  // `targets`: the places that other functions are known to jump to.
  NotReplaced Next(Code read, const Code* targets, std::size_t target_count,
                   Replacement* replacement) {
    CodeRange function = functions_.FunctionAt(read);
    if (function.IsEmpty() && TakesUpCounter(code_, read)) {
      function = FunctionWithoutEntry(code_, functions_, read);
    }
    return NextIn(function, read, targets, target_count, replacement);
  }

  // As Next, in a function that is known.
  NotReplaced NextIn(CodeRange function, Code read, const Code* targets, std::size_t target_count,
                     Replacement* replacement) {
    if (function.IsEmpty()) return NotReplaced::kCodeIsUnknown;
    const machine_code::Neighbourhood around(function, read);
    if (!around.has_read()) {
      return around.is_whole() ? NotReplaced::kIsNoInstruction : NotReplaced::kCodeIsUnknown;
    }
    if (!around.is_whole()) return NotReplaced::kCodeIsUnknown;
    if (read < taken_until_) return NotReplaced::kWithAnother;
    for (int before = 0; before <= machine_code::Neighbourhood::kBefore; ++before) {
      const Replacement one{read, around.From(before), nullptr};
      if (one.moved.IsEmpty() || one.moved.begin < taken_until_) continue;
      bool is_entered = around.IsEntered(one);
      for (std::size_t i = 0; i < target_count; ++i) is_entered |= one.IsEnteredBy(targets[i]);
      if (is_entered) continue;
      taken_until_ = one.moved.end;
      *replacement = one;
      return NotReplaced::kNo;
    }
    return IntoPadding(function, read, replacement);
  }

 private:
  NotReplaced IntoPadding(CodeRange function, Code read, Replacement* replacement) {
    const CodeRange gaps[] = {functions_.GapAfter(function), functions_.GapBefore(function)};
    for (const CodeRange& gap : gaps) {
      const CodeRange padding = machine_code::PaddingIn(gap);
      const Code room = machine_code::RoomFor(padding, read, padding_until_);
      if (room == nullptr) continue;
      padding_until_ = room + kJumpSize;
      taken_until_ = read + Sought{.counter = true, .pauses = true}.SizeAt(read, function.end);
      *replacement = {read, {read, taken_until_}, room};
      return NotReplaced::kNo;
    }
    return NotReplaced::kNoRoom;
  }

  const CodeRange code_;
  const UnwindTable& functions_;
  Code taken_until_ = nullptr, padding_until_ = nullptr;
};

// The memory that planning takes.
struct PlanRoom {
  static constexpr std::size_t kMostReads = 1024, kMostTargets = 256;

  Code reads[kMostReads];
  Replacement replacements[kMostReads];
  Code left[kMostReads];
  Code targets[kMostTargets];
};

// All replacements in some code, into which no other place in the code jumps.
class Replacements {
 public:
  explicit Replacements(PlanRoom& room, const Sought& sought = {}) : room_(room), sought_(sought) {}

  std::size_t count() const { return count_; }
  const Replacement& operator[](std::size_t i) const { return room_.replacements[i]; }

  // Calls `left` with each read of the counter that cannot be replaced.
  template <class Left>
  void Plan(CodeRange code, const UnwindTable& functions, const Left& left) {
    constexpr int kMostPlans = 8;
    read_count_ = target_count_ = 0;
    const auto leave = [&](Code at) {
      if (CounterReadSize(at, code.end) != 0) left(at);
    };
    ForEachLookingLikeARead(code, sought_, [&](Code at) {
      const CodeRange function = functions.FunctionAt(at);
      const bool may_be = function.IsEmpty() ? TakesUpCounter(code, at)
                                             : !machine_code::IsWithinAnother(function, at);
      if (!may_be) return;
      if (read_count_ == PlanRoom::kMostReads) return leave(at);
      room_.reads[read_count_++] = at;
    });
    bool is_entered = true;
    for (int i = 0; is_entered && i < kMostPlans; ++i) {
      PlanOnce(code, functions);
      is_entered = count_ > 0 && IsEntered(code);
    }
    for (std::size_t i = 0; i < left_count_; ++i) leave(room_.left[i]);
    for (std::size_t i = 0; is_entered && i < count_; ++i) leave(room_.replacements[i].read);
    if (is_entered) count_ = 0;
  }

 private:
  void PlanOnce(CodeRange code, const UnwindTable& functions) {
    count_ = left_count_ = 0;
    ReplacementPlan plan(code, functions);
    for (std::size_t i = 0; i < read_count_; ++i) {
      const Code read = room_.reads[i];
      Replacement one;
      const NotReplaced why = plan.Next(read, room_.targets, target_count_, &one);
      if (why == NotReplaced::kNo) {
        room_.replacements[count_++] = one;
        continue;
      }
      const bool is_read = why == NotReplaced::kCodeIsUnknown ? TakesUpCounter(code, read)
                                                              : why == NotReplaced::kNoRoom;
      if (is_read) room_.left[left_count_++] = read;
    }
  }

  // True if another place in the code jumps into a replacement; the next plan knows of such jumps.
  bool IsEntered(CodeRange code) {
    const std::size_t before = target_count_;
    const Code least = room_.replacements[0].moved.begin;
    const Code most = room_.replacements[count_ - 1].moved.end;
    ForEachLongTarget(code, [&](Code target) {
      if (target <= least || target >= most || target_count_ == PlanRoom::kMostTargets) return;
      if (Enters(target)) room_.targets[target_count_++] = target;
    });
    return target_count_ != before;
  }

  bool Enters(Code target) const {
    std::size_t low = 0, high = count_;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (room_.replacements[middle].moved.end <= target) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low < count_ && room_.replacements[low].IsEnteredBy(target);
  }

  PlanRoom& room_;
  const Sought sought_;
  std::size_t read_count_ = 0, count_ = 0, target_count_ = 0, left_count_ = 0;
};

}  // namespace tcs::shm
