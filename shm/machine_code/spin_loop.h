// Whether a place in a program's code is in a loop that does nothing but look at memory until
// another thread has changed it.
//
// Such a loop calls nothing and stores nothing, and looks at the same memory each time: no register
// that says where the memory is changes but by being read from memory itself. An exchange or a
// compare-and-exchange counts as a look: locks are tried in this way. Loops that go through memory,
// or that write results, are none. An instruction that is not known to be harmless is not taken for
// harmless.
//
// Pure; async-signal-safe.
#pragma once

#include "shm/machine_code/functions.h"
#include "shm/machine_code/instruction.h"

namespace tcs::shm {

namespace machine_code {

// General registers, as bits.
using Registers = std::uint32_t;

// The effect of an instruction of such a loop; `is_known` false: the instruction has no place in
// one.
struct LoopStep {
  bool is_known = false;
  bool looks = false;         // at memory
  Registers where = 0;        // the registers that say where the memory is
  Registers from_memory = 0;  // the register that has what was read
  Registers changes = 0;      // the registers with newly computed values
};

class LoopDecoder {
 public:
  LoopDecoder(Code at, std::size_t size) : at_(at), end_(at + size) {}

  LoopStep Decode() {
    std::uint8_t byte = Next();
    bool is_locked = false;
    for (;; byte = Next()) {
      if (byte == 0xf0) {
        is_locked = true;
      } else if (byte != 0x66 && byte != 0x2e && byte != 0x3e) {
        break;
      }
    }
    if (byte == 0xf3) return Harmless(Next() == 0x90);
    if ((byte & 0xf0) == 0x40) {
      rex_ = byte;
      byte = Next();
    }
    return byte == 0x0f ? TwoBytes(Next(), is_locked) : OneByte(byte, is_locked);
  }

 private:
  static constexpr unsigned kA = 0;  // the accumulator

  std::uint8_t Next() { return at_ < end_ ? *at_++ : 0; }
  static Registers Bit(unsigned reg) { return Registers{1} << reg; }
  static LoopStep Harmless(bool is_known) { return {.is_known = is_known}; }

  // Reads the instruction's operands: a register, and a register or memory.
  void ModRm() {
    const std::uint8_t mod_rm = Next();
    mod_ = mod_rm >> 6;
    reg_ = (mod_rm >> 3 & 7) | ((rex_ & 4) != 0 ? 8 : 0);
    rm_ = (mod_rm & 7) | ((rex_ & 1) != 0 ? 8 : 0);
    if (mod_ == 3) return;
    const bool has_index = (mod_rm & 7) == 4;
    if (has_index) {
      const std::uint8_t sib = Next();
      const unsigned index = (sib >> 3 & 7) | ((rex_ & 2) != 0 ? 8 : 0);
      const unsigned base = (sib & 7) | ((rex_ & 1) != 0 ? 8 : 0);
      if (index != 4) where_ |= Bit(index);
      if (mod_ != 0 || (sib & 7) != 5) where_ |= Bit(base);
    } else if (mod_ != 0 || (mod_rm & 7) != 5) {
      where_ |= Bit(rm_);
    }
  }

  LoopStep Looks() const { return {.is_known = true, .looks = mod_ != 3, .where = where_}; }
  // mov from a register or memory.
  LoopStep Loads() const {
    LoopStep step = Looks();
    (mod_ == 3 ? step.changes : step.from_memory) |= Bit(reg_);
    return step;
  }
  // Computes a register from itself and another operand.
  LoopStep Computes() const {
    LoopStep step = Looks();
    step.changes |= Bit(reg_);
    return step;
  }
  // Changes a register. Other forms of the instruction write to memory, and have no place in a
  // loop.
  LoopStep ChangesRegister() const {
    return {.is_known = mod_ == 3, .changes = mod_ == 3 ? Bit(rm_) : 0};
  }
  LoopStep Exchanges(unsigned into) const {
    LoopStep step = Looks();
    step.changes |= Bit(into);
    if (mod_ == 3) step.changes |= Bit(rm_);
    return step;
  }

  LoopStep OneByte(std::uint8_t opcode, bool is_locked) {
    if (opcode >= 0x70 && opcode <= 0x7f) return Harmless(true);
    if (opcode == 0xeb || opcode == 0xe9 || opcode == 0x90) return Harmless(true);
    if (opcode == 0xa8 || opcode == 0xa9) return Harmless(true);  // test
    const unsigned row = opcode & 7;
    if (opcode < 0x40) {
      const bool compares = opcode >= 0x38;
      if (row == 4 || row == 5) return {.is_known = true, .changes = compares ? 0 : Bit(kA)};
      if (row > 5) return {};
      ModRm();
      if (compares) return Looks();
      return row >= 2 ? Computes() : ChangesRegister();
    }
    if (opcode >= 0xb0 && opcode <= 0xbf) {
      return {.is_known = true, .changes = Bit((opcode & 7) | ((rex_ & 1) != 0 ? 8 : 0))};
    }
    ModRm();
    switch (opcode) {
      case 0x63:
      case 0x8a:
      case 0x8b:
        return Loads();
      case 0x80:
      case 0x81:
      case 0x83:
        return (reg_ & 7) == 7 ? Looks() : ChangesRegister();
      case 0x84:
      case 0x85:
        return Looks();
      case 0x86:
      case 0x87:
        return Exchanges(reg_);
      case 0x88:
      case 0x89:
      case 0xc0:
      case 0xc1:
      case 0xc6:
      case 0xc7:
      case 0xd0:
      case 0xd1:
        return is_locked ? LoopStep{} : ChangesRegister();
      case 0x8d:
        return {.is_known = true, .changes = Bit(reg_)};
      case 0xf6:
      case 0xf7:
        return (reg_ & 7) < 2 ? Looks() : LoopStep{};
      case 0xfe:
      case 0xff:
        return (reg_ & 7) < 2 ? ChangesRegister() : LoopStep{};
      default:
        return {};
    }
  }

  LoopStep TwoBytes(std::uint8_t opcode, bool is_locked) {
    if (opcode >= 0x80 && opcode <= 0x8f) return Harmless(true);
    ModRm();
    if (opcode == 0x1f) return Harmless(true);
    if (opcode >= 0x40 && opcode <= 0x4f) return Computes();
    if (opcode >= 0x90 && opcode <= 0x9f) return ChangesRegister();
    switch (opcode) {
      case 0xb0:
      case 0xb1:
        return is_locked ? Exchanges(kA) : LoopStep{};
      case 0xb6:
      case 0xb7:
      case 0xbe:
      case 0xbf:
        return Loads();
      default:
        return {};
    }
  }

  Code at_;
  const Code end_;
  std::uint8_t rex_ = 0;
  unsigned mod_ = 3, reg_ = 0, rm_ = 0;
  Registers where_ = 0;
};

// Looks for ways from a place back to it.
template <class CanRead>
class LoopSearch {
 public:
  LoopSearch(const CanRead& can_read, Code start) : can_read_(can_read), start_(start) {}

  // Without recursion: the stack may be small.
  bool Finds() {
    Place places[kLongest];
    places[0].at = start_;
    for (int length = 1, steps = 0; length > 0 && steps < kMostSteps; ++steps) {
      Place& last = places[length - 1];
      Place next;
      if (!GoOn(last, &next)) {
        --length;
      } else if (next.at == start_) {
        if (IsSpin(next.way)) return true;
      } else if (length < kLongest) {
        places[length++] = next;
      }
    }
    return false;
  }

 private:
  static constexpr int kLongest = 24, kMostSteps = 256;
  static constexpr std::size_t kMostSize = 15;  // of an instruction

  // All steps on a way taken together.
  struct Way {
    bool looks = false;
    Registers where = 0;    // said where with the values that they had at the way's begin
    Registers written = 0;  // have other values since
    Registers fresh = 0;    // have values read on the way, each time from the same memory
  };

  static bool IsSpin(const Way& way) { return way.looks && (way.where & way.written) == 0; }

  static void Take(const LoopStep& step, Way* way) {
    way->looks |= step.looks;
    way->where |= step.where & ~way->fresh;
    way->written |= step.from_memory | step.changes;
    way->fresh = (way->fresh | step.from_memory) & ~step.changes;
  }

  struct Place {
    Code at = nullptr;
    Way way;        // there
    int tried = 0;  // of the ways that lead on from there
  };

  // The next way on from `from`; false: there is no further one.
  bool GoOn(Place& from, Place* next) const {
    if (!can_read_(from.at, kMostSize)) return false;
    const Instruction one = shm::Decode(from.at, from.at + kMostSize);
    if (one.size == 0) return false;
    const LoopStep step = LoopDecoder(from.at, one.size).Decode();
    if (!step.is_known) return false;
    const bool may_go_on = one.flow == Flow::kNext || one.flow == Flow::kBranch;
    if (from.tried == 0 && !may_go_on) ++from.tried;
    if (from.tried == 2 || (from.tried == 1 && !one.has_target)) return false;
    next->at = from.tried++ == 0 ? from.at + one.size : one.Target(from.at);
    next->way = from.way;
    Take(step, &next->way);
    return true;
  }

  const CanRead& can_read_;
  const Code start_;
};

}  // namespace machine_code

// `at`: of an instruction. `can_read(place, size)`: whether code may be read there.
template <class CanRead>
bool IsInSpinLoop(Code at, const CanRead& can_read) {
  return machine_code::LoopSearch<CanRead>(can_read, at).Finds();
}

}  // namespace tcs::shm
