// Reads of the processor's cycle counter (rdtsc, rdtscp) in a program's code, and how each of them
// can be replaced by a jump of five bytes to a place that reads another counter instead. `pause`,
// which programs execute while they look at memory again and again, is replaced in the same way
// where it is sought; "a read" stands for either here.
//
// Two ways are tried. Instructions around the read, and the read with them, go to that other place,
// if a jump's bytes hold whole instructions into which nothing leads. Or a jump of two bytes leads
// into unused bytes between functions, and a long jump leads on from there.
//
// Pure; async-signal-safe.
#pragma once

#include <emmintrin.h>

#include "shm/machine_code/functions.h"
#include "shm/machine_code/instruction.h"

namespace tcs::shm {

inline constexpr std::size_t kJumpSize = 5, kShortJumpSize = 2;

// How long the read of the counter at `at` is; 0: there is none.
inline std::size_t CounterReadSize(Code at, Code end) {
  if (end - at >= 2 && at[0] == 0x0f && at[1] == 0x31) return 2;
  if (end - at >= 3 && at[0] == 0x0f && at[1] == 0x01 && at[2] == 0xf9) return 3;
  return 0;
}

inline bool IsPause(Code at, Code end) { return end - at >= 2 && at[0] == 0xf3 && at[1] == 0x90; }

// The instructions that are to be replaced.
struct Sought {
  bool counter = true;  // reads of the counter
  bool pauses = false;

  // How long such an instruction at `at` is; 0: there is none.
  std::size_t SizeAt(Code at, Code end) const {
    if (pauses && IsPause(at, end)) return 2;
    return counter ? CounterReadSize(at, end) : 0;
  }
};

// True where the code after the read puts the two halves of the counter together, as compilers and
// people write it: there the bytes are the instruction, whatever function they are in.
inline bool TakesUpCounter(CodeRange code, Code read) {
  constexpr std::uint8_t kUpperHalf[] = {0x48, 0xc1, 0xe2, 0x20};  // shl $32, %rdx
  if (CounterReadSize(read, code.end) == 0) return false;
  Code at = read + CounterReadSize(read, code.end);
  for (int i = 0; i < 4 && code.Contains(at); ++i) {
    const Instruction one = Decode(at, code.end);
    if (one.size == sizeof kUpperHalf && memcmp(at, kUpperHalf, one.size) == 0) return true;
    if (one.size == 0 || (one.flow != Flow::kNext && one.flow != Flow::kJump)) return false;
    at = one.flow == Flow::kJump ? one.Target(at) : at + one.size;
  }
  return false;
}

// Calls `found` with each place whose bytes are those of a read, instructions or not, in order.
template <class Found>
void ForEachLookingLikeARead(CodeRange code, const Sought& sought, const Found& found) {
  const auto look = [&](Code at) {
    if (sought.SizeAt(at, code.end) != 0) found(at);
  };
  Code at = code.begin;
  const __m128i first = _mm_set1_epi8(0x0f), second = _mm_set1_epi8(0x31),
                second_of_p = _mm_set1_epi8(0x01);
  const __m128i first_of_pause = _mm_set1_epi8(sought.pauses ? static_cast<char>(0xf3) : 0x0f),
                second_of_pause = _mm_set1_epi8(sought.pauses ? static_cast<char>(0x90) : 0x31);
  for (; code.end - at >= 17; at += 16) {
    const __m128i these = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
    const __m128i next = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + 1));
    const __m128i is_second =
        _mm_or_si128(_mm_cmpeq_epi8(next, second), _mm_cmpeq_epi8(next, second_of_p));
    const __m128i is_pause =
        _mm_and_si128(_mm_cmpeq_epi8(these, first_of_pause), _mm_cmpeq_epi8(next, second_of_pause));
    int hits = _mm_movemask_epi8(
        _mm_or_si128(_mm_and_si128(_mm_cmpeq_epi8(these, first), is_second), is_pause));
    for (; hits != 0; hits &= hits - 1) look(at + __builtin_ctz(static_cast<unsigned>(hits)));
  }
  for (; at < code.end; ++at) look(at);
}

// Calls `found` with the target of everything that may be a jump or branch with 32 bits.
template <class Found>
void ForEachLongTarget(CodeRange code, const Found& found) {
  const __m128i jump = _mm_set1_epi8(static_cast<char>(0xe9)), two_bytes = _mm_set1_epi8(0x0f);
  const __m128i upper = _mm_set1_epi8(static_cast<char>(0xf0)),
                branch = _mm_set1_epi8(static_cast<char>(0x80));
  for (Code at = code.begin; code.end - at >= 32; at += 16) {
    const __m128i these = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
    const __m128i next = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + 1));
    const __m128i is_branch = _mm_and_si128(_mm_cmpeq_epi8(these, two_bytes),
                                            _mm_cmpeq_epi8(_mm_and_si128(next, upper), branch));
    int hits = _mm_movemask_epi8(_mm_or_si128(_mm_cmpeq_epi8(these, jump), is_branch));
    for (; hits != 0; hits &= hits - 1) {
      const Code opcode = at + __builtin_ctz(static_cast<unsigned>(hits));
      const Code to = opcode + (*opcode == 0x0f ? 2 : 1);
      std::int32_t relative;
      memcpy(&relative, to, sizeof relative);
      found(to + 4 + relative);
    }
  }
}

struct Replacement {
  Code read = nullptr;
  CodeRange moved;         // the read and the instructions that move with it, reads among them
  Code padding = nullptr;  // where the long jump goes; null: to the begin of `moved`

  // True where a jump to `target` would come into the midst of the replaced instructions.
  bool IsEnteredBy(Code target) const { return moved.begin < target && target < moved.end; }
};

// Why a read cannot be replaced.
enum class NotReplaced : std::uint8_t {
  kNo,
  kWithAnother,  // the read is replaced: it goes with the read before it
  kIsNoInstruction,
  kCodeIsUnknown,
  kNoRoom
};

namespace machine_code {

// True where the bytes at `at` are surely the midst of an instruction: decoding comes into step
// with a function's instructions wherever it begins, after a few of them, and no way there leads to
// `at`. Spares decoding a long function from its begin for most places that only look like a read.
inline bool IsWithinAnother(CodeRange function, Code at) {
  constexpr int kWay = 128, kWays = 5;
  if (at - function.begin <= kWay) return false;
  for (int i = 0; i < kWays; ++i) {
    Code on_way = at - kWay + i;
    while (on_way < at) {
      const Instruction one = Decode(on_way, function.end);
      on_way += one.size == 0 ? 1 : one.size;
    }
    if (on_way == at) return false;
  }
  return true;
}

// True for an instruction that compilers put where nothing is executed.
inline bool IsFiller(Code at, const Instruction& one) {
  return one.size != 0 &&
         (one.opcode == 0x90 || one.opcode == 0xcc || (one.opcode == 0x1f && one.size > 2)) &&
         !IsPause(at, at + one.size);
}

// The instructions around a read, in a function that has been decoded from its begin to its end.
class Neighbourhood {
 public:
  static constexpr int kBefore = 5, kAfter = 6;

  Neighbourhood(CodeRange function, Code read) : function_(function), read_(read) {
    for (Code at = function.begin; at < function.end;) {
      const Instruction one = Decode(at, function.end);
      if (one.size == 0) return;
      if (at < read) {
        Push(at, one);
      } else if (at == read || (has_read_ && after_ < kAfter)) {
        has_read_ = true;
        if (at != read) ++after_;
        at_[kBefore + after_] = at;
        what_[kBefore + after_] = one;
      } else if (!has_read_) {
        is_whole_ = true;  // there the read is part of another instruction
        return;
      }
      leads_anywhere_ |= one.flow == Flow::kJumpAnywhere && one.relative_at == 0;
      at += one.size;
    }
    is_whole_ = true;
  }

  bool has_read() const { return has_read_; }
  bool is_whole() const { return is_whole_; }

  // The shortest range for a jump that begins `before` instructions before the read; an empty
  // range: there is none.
  CodeRange From(int before) const {
    if (before > before_) return {};
    const int read = kBefore, first = read - before;
    bool goes_on = true;
    for (int i = first; i <= read + after_; ++i) {
      const bool is_last = i >= read && at_[i] + what_[i].size >= at_[first] + kJumpSize;
      if (!goes_on && !IsFiller(at_[i], what_[i])) return {};
      // Instructions after a jump are not executed if nothing leads there.
      const bool may_jump = is_last || (i > read && goes_on);
      if (i != read && !CanMove(i, may_jump)) return {};
      goes_on &= what_[i].flow == Flow::kNext || what_[i].flow == Flow::kBranch;
      if (!is_last) continue;
      // Where a table of targets may lead is not known. Such a table leads to no place between a
      // read and the instruction that takes up its result.
      if (leads_anywhere_ && (before > 0 || i > read + 1)) return {};
      return {at_[first], at_[i] + what_[i].size};
    }
    return {};
  }

  // True if a branch of the function's leads into the midst of the range.
  bool IsEntered(const Replacement& replacement) const {
    for (Code at = function_.begin; at < function_.end;) {
      const Instruction one = Decode(at, function_.end);
      if (one.has_target && replacement.IsEnteredBy(one.Target(at))) return true;
      at += one.size;
    }
    return false;
  }

 private:
  void Push(Code at, const Instruction& one) {
    for (int i = 0; i + 1 < kBefore; ++i) {
      at_[i] = at_[i + 1];
      what_[i] = what_[i + 1];
    }
    at_[kBefore - 1] = at;
    what_[kBefore - 1] = one;
    before_ += before_ < kBefore ? 1 : 0;
  }

  bool CanMove(int i, bool may_jump) const {
    const Instruction& one = what_[i];
    return one.is_movable && (may_jump || one.flow == Flow::kNext || one.flow == Flow::kBranch);
  }

  const CodeRange function_;
  const Code read_;
  Code at_[kBefore + 1 + kAfter] = {};
  Instruction what_[kBefore + 1 + kAfter] = {};
  int before_ = 0, after_ = 0;
  bool has_read_ = false, is_whole_ = false, leads_anywhere_ = false;
};

// The part of a gap between functions that fills it up to the alignment of the next function, and
// is never executed.
inline CodeRange PaddingIn(CodeRange gap) {
  const auto past = reinterpret_cast<std::uintptr_t>(gap.begin);
  const Code most = gap.begin + ((~past + 1) & 15);
  const Code end = most < gap.end ? most : gap.end;
  Code at = gap.begin;
  while (at < end) {
    const Instruction one = Decode(at, end);
    if (!IsFiller(at, one)) break;
    at += one.size;
  }
  return {gap.begin, at};
}

// The place in the padding that has room for a long jump and that a short jump from the read
// reaches; null: there is none.
inline Code RoomFor(CodeRange padding, Code read, Code taken_until) {
  const Code at = padding.begin < taken_until ? taken_until : padding.begin;
  if (at > padding.end || static_cast<std::size_t>(padding.end - at) < kJumpSize) return nullptr;
  const std::ptrdiff_t way = at - (read + kShortJumpSize);
  return way >= -128 && way <= 127 ? at : nullptr;
}

}  // namespace machine_code

}  // namespace tcs::shm
