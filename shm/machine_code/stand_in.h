// The code that stands elsewhere in memory for a read of the cycle counter and the instructions
// that were moved with it (counter_reads.h).
//
// Pure; async-signal-safe. Places are addresses of the image as it lies, or will lie, in memory:
// the bytes for them may be made up in another buffer first.
#pragma once

#include <cstdint>
#include <cstring>

#include "shm/machine_code/counter_reads.h"

namespace tcs::shm {

// The way from `from` to `target`; false if the target is too far away for 32 bits.
inline bool RelativeTo(Code target, Code from, std::int32_t* relative) {
  const std::int64_t way = target - from;
  *relative = static_cast<std::int32_t>(way);
  return *relative == way;
}

class CodeWriter {
 public:
  CodeWriter(std::uint8_t* out, Code place, std::size_t room)
      : out_(out), place_(place), room_(room) {}

  // False once something has not had room, or a target was too far away.
  bool is_sound() const { return is_sound_; }
  std::size_t size() const { return n_; }

  void Bytes(const std::uint8_t* bytes, std::size_t size) {
    if (size > room_ - n_) is_sound_ = false;
    if (!is_sound_) return;
    memcpy(out_ + n_, bytes, size);
    n_ += size;
  }
  template <std::size_t size>
  void Bytes(const std::uint8_t (&bytes)[size]) {
    Bytes(bytes, size);
  }

  // An opcode, and the way from behind it to the target.
  template <std::size_t size>
  void Leading(const std::uint8_t (&opcode)[size], Code target) {
    std::int32_t relative;
    if (!RelativeTo(target, place_ + n_ + size + sizeof relative, &relative)) is_sound_ = false;
    Bytes(opcode);
    Bytes(reinterpret_cast<const std::uint8_t*>(&relative), sizeof relative);
  }
  void Jump(Code target) { Leading({0xe9}, target); }

  // An instruction that stands at `from` now.
  void Move(const Instruction& one, Code from) {
    if (one.is_short && one.flow == Flow::kJump) return Jump(one.Target(from));
    if (one.is_short) {
      // Of jcc; a prefix before it is a hint only.
      return Leading({0x0f, static_cast<std::uint8_t>(0x10 + one.opcode)}, one.Target(from));
    }
    const std::size_t begun = n_;
    Bytes(from, one.size);
    if (one.relative_at == 0 || !is_sound_) return;
    std::int32_t relative;
    if (!RelativeTo(one.Target(from), place_ + n_, &relative)) is_sound_ = false;
    memcpy(out_ + begun + one.relative_at, &relative, sizeof relative);
  }

 private:
  std::uint8_t* const out_;
  const Code place_;
  const std::size_t room_;
  std::size_t n_ = 0;
  bool is_sound_ = true;
};

// Writes the stand-in, with what `write_read(writer, at)` writes in place of a read at `at`.
template <class WriteRead>
void WriteStandIn(CodeWriter& writer, const Replacement& replacement, const Sought& sought,
                  const WriteRead& write_read) {
  const CodeRange& moved = replacement.moved;
  bool goes_on = true;
  for (Code at = moved.begin; at < moved.end && goes_on;) {
    const Instruction one = Decode(at, moved.end);
    if (one.size == sought.SizeAt(at, moved.end)) {
      write_read(writer, at);
    } else {
      writer.Move(one, at);
    }
    goes_on = one.flow == Flow::kNext || one.flow == Flow::kBranch;
    at += one.size;
  }
  if (goes_on) writer.Jump(moved.end);
}

// Writes the bytes that lead to the stand-in. `write(place, bytes, size)` puts them where they
// belong; the last bytes make the replacement effective.
template <class Write>
bool LeadToStandIn(const Replacement& replacement, Code stand_in, const Write& write) {
  const Code jump_at =
      replacement.padding != nullptr ? replacement.padding : replacement.moved.begin;
  std::uint8_t jump[kJumpSize];
  CodeWriter writer(jump, jump_at, sizeof jump);
  writer.Jump(stand_in);
  if (!writer.is_sound()) return false;
  write(jump_at, jump, sizeof jump);
  if (replacement.padding == nullptr) return true;
  const std::uint8_t short_jump[kShortJumpSize] = {
      0xeb, static_cast<std::uint8_t>(jump_at - (replacement.read + kShortJumpSize))};
  write(replacement.read, short_jump, sizeof short_jump);
  return true;
}

}  // namespace tcs::shm
