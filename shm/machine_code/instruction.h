// How long an instruction of x86-64 is, and where it leads: as much as is needed to replace some of
// a program's instructions by a jump.
//
// Pure; async-signal-safe; never reads past `end`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tcs::shm {

enum class Flow : std::uint8_t {
  kNext,          // the next instruction follows
  kBranch,        // or the one at its target: jcc, loop, xbegin
  kJump,          // to its target
  kCall,          // of its target, or of what a register or the memory says
  kJumpAnywhere,  // to what a register or the memory says
  kEnd            // nothing follows: ret, ud2, int3, hlt
};

struct Instruction {
  std::uint8_t size = 0;  // 0: no instruction that is known, or not all of it is there
  Flow flow = Flow::kNext;
  // Where its 32 bits relative to the next instruction are, of an operand in memory or of a target;
  // 0: there are none.
  std::uint8_t relative_at = 0;
  bool has_target = false;
  // True of jmp and jcc in their short form, whose target is 8 bits.
  bool is_short = false;
  bool is_movable = true;   // by changing the above alone: it then does the same elsewhere
  std::uint8_t opcode = 0;  // the last byte of it
  std::int32_t relative = 0;

  // For an instruction at `at`.
  const std::uint8_t* Target(const std::uint8_t* at) const { return at + size + relative; }
};

namespace machine_code {

// The bytes that follow an opcode.
enum : std::uint8_t {
  kModRm = 1,
  kByte = 2,      // an immediate of a byte
  kWord = 4,      // of two
  kWhole = 8,     // of four; two with the operand-size prefix
  kFull = 16,     // of eight with REX.W, else the same
  kAddress = 32,  // as long as an address
  kUnknown = 64
};

using OpcodeMap = std::array<std::uint8_t, 256>;

constexpr void Fill(OpcodeMap& map, int first, int last, std::uint8_t what) {
  for (int i = first; i <= last; ++i) map[static_cast<std::size_t>(i)] = what;
}

constexpr OpcodeMap OneByteMap() {
  OpcodeMap map{};
  for (int row = 0; row < 0x40; row += 8) {
    Fill(map, row, row + 3, kModRm);
    map[static_cast<std::size_t>(row + 4)] = kByte;
    map[static_cast<std::size_t>(row + 5)] = kWhole;
    Fill(map, row + 6, row + 7, kUnknown);
  }
  Fill(map, 0x60, 0x62, kUnknown);
  map[0x63] = kModRm;
  map[0x68] = kWhole;
  map[0x69] = kModRm | kWhole;
  map[0x6a] = kByte;
  map[0x6b] = kModRm | kByte;
  Fill(map, 0x70, 0x7f, kByte);
  map[0x80] = map[0x83] = kModRm | kByte;
  map[0x81] = kModRm | kWhole;
  map[0x82] = kUnknown;
  Fill(map, 0x84, 0x8f, kModRm);
  map[0x9a] = kUnknown;
  Fill(map, 0xa0, 0xa3, kAddress);
  map[0xa8] = kByte;
  map[0xa9] = kWhole;
  Fill(map, 0xb0, 0xb7, kByte);
  Fill(map, 0xb8, 0xbf, kFull);
  map[0xc0] = map[0xc1] = map[0xc6] = kModRm | kByte;
  map[0xc2] = map[0xca] = kWord;
  map[0xc7] = kModRm | kWhole;
  map[0xc8] = kWord | kByte;
  map[0xcd] = kByte;
  map[0xce] = kUnknown;
  Fill(map, 0xd0, 0xd3, kModRm);
  Fill(map, 0xd4, 0xd6, kUnknown);
  Fill(map, 0xd8, 0xdf, kModRm);
  Fill(map, 0xe0, 0xe7, kByte);
  map[0xe8] = map[0xe9] = kWhole;
  map[0xea] = kUnknown;
  map[0xeb] = kByte;
  map[0xf6] = map[0xf7] = map[0xfe] = map[0xff] = kModRm;
  return map;
}

// After 0f.
constexpr OpcodeMap TwoByteMap() {
  OpcodeMap map{};
  Fill(map, 0x00, 0xff, kModRm);
  map[0x04] = map[0x0a] = map[0x0c] = kUnknown;
  Fill(map, 0x05, 0x0b, 0);
  map[0x0a] = kUnknown;
  map[0x0e] = 0;
  map[0x0f] = kModRm | kByte;  // 3DNow!
  Fill(map, 0x24, 0x27, kUnknown);
  Fill(map, 0x30, 0x37, 0);
  map[0x36] = kUnknown;
  Fill(map, 0x38, 0x3f, kUnknown);  // two of them lead to further maps
  Fill(map, 0x70, 0x73, kModRm | kByte);
  map[0x77] = 0;
  Fill(map, 0x7a, 0x7b, kUnknown);
  Fill(map, 0x80, 0x8f, kWhole);
  Fill(map, 0xa0, 0xa2, 0);
  Fill(map, 0xa8, 0xaa, 0);
  map[0xa4] = map[0xac] = map[0xba] = kModRm | kByte;
  map[0xc2] = kModRm | kByte;
  Fill(map, 0xc4, 0xc6, kModRm | kByte);
  Fill(map, 0xc8, 0xcf, 0);
  return map;
}

inline constexpr OpcodeMap kOneByte = OneByteMap(), kTwoByte = TwoByteMap();

// The bytes that follow an opcode of a vector instruction (VEX, EVEX), by its map.
constexpr std::uint8_t OfVector(unsigned map, std::uint8_t opcode) {
  switch (map) {
    case 1:
      return opcode == 0x77                       ? 0
             : (opcode >= 0x80 && opcode <= 0x8f) ? std::uint8_t{kUnknown}
                                                  : kTwoByte[opcode];
    case 2:
    case 5:
    case 6:
      return kModRm;
    case 3:
      return kModRm | kByte;
    default:
      return kUnknown;
  }
}

// The bytes that follow an opcode of AMD's XOP.
constexpr std::uint8_t OfXop(unsigned map) {
  return map == 8 ? kModRm | kByte : map == 9 ? kModRm : map == 10 ? kModRm | kWhole : kUnknown;
}

class Decoder {
 public:
  Decoder(const std::uint8_t* at, const std::uint8_t* end)
      : at_(at),
        left_(static_cast<std::size_t>(end - at) < kMost ? static_cast<std::size_t>(end - at)
                                                         : kMost) {}

  Instruction Decode() {
    std::uint8_t follows = Opcode();
    if (!is_sound_ || (follows & kUnknown) != 0) return {};
    if ((follows & kModRm) != 0) follows |= ModRm();
    // On Intel's processors a branch has 32 bits whatever the prefix says; a branch with one is not
    // moved.
    const bool is_target = is_two_byte_ ? IsLongBranch() : opcode_ == 0xe8 || opcode_ == 0xe9;
    std::size_t immediate = 0;
    if ((follows & kByte) != 0) immediate += 1;
    if ((follows & kWord) != 0) immediate += 2;
    if ((follows & kWhole) != 0) immediate += has_operand_size_ && !is_target && !is_wide_ ? 2 : 4;
    if ((follows & kFull) != 0) immediate += is_wide_ ? 8 : has_operand_size_ ? 2 : 4;
    if ((follows & kAddress) != 0) immediate += has_address_size_ ? 4 : 8;
    const std::size_t immediate_at = n_;
    n_ += immediate;
    if (!is_sound_ || n_ > left_) return {};
    instruction_.size = static_cast<std::uint8_t>(n_);
    instruction_.opcode = opcode_;
    if (!is_vector_) (is_two_byte_ ? FlowOfTwoByte(immediate_at) : FlowOfOneByte(immediate_at));
    if (instruction_.relative_at != 0) {
      memcpy(&instruction_.relative, at_ + instruction_.relative_at, 4);
    }
    return instruction_;
  }

 private:
  static constexpr std::size_t kMost = 15;

  std::uint8_t Next() {
    if (n_ < left_) return at_[n_++];
    is_sound_ = false;
    return 0;
  }

  // Reads the prefixes and the opcode; returns what follows the opcode.
  std::uint8_t Opcode() {
    std::uint8_t byte = Next();
    for (; IsPrefix(byte); byte = Next()) {
      has_operand_size_ |= byte == 0x66;
      has_address_size_ |= byte == 0x67;
      has_repeat_ |= byte == 0xf2 || byte == 0xf3;
      if (!is_sound_) return kUnknown;
    }
    if ((byte & 0xf0) == 0x40) {
      is_wide_ = (byte & 8) != 0;
      byte = Next();
    }
    if (byte == 0xc4 || byte == 0xc5 || byte == 0x62) return Vector(byte);
    if (byte == 0x8f && n_ < left_ && (at_[n_] & 0x1f) >= 8) return Xop();
    opcode_ = byte;
    if (byte != 0x0f) return kOneByte[byte];
    is_two_byte_ = true;
    opcode_ = Next();
    if (opcode_ == 0x38 || opcode_ == 0x3a) {
      is_vector_ = true;  // like a vector instruction it leads nowhere
      const std::uint8_t follows = opcode_ == 0x38 ? kModRm : kModRm | kByte;
      opcode_ = Next();
      return follows;
    }
    // AMD's extrq and insertq, of two bytes.
    if (opcode_ == 0x78 && (has_operand_size_ || has_repeat_)) return kModRm | kWord;
    return kTwoByte[opcode_];
  }

  static bool IsPrefix(std::uint8_t byte) {
    return byte == 0x66 || byte == 0x67 || byte == 0xf2 || byte == 0xf3 || byte == 0xf0 ||
           byte == 0x2e || byte == 0x36 || byte == 0x3e || byte == 0x26 || byte == 0x64 ||
           byte == 0x65;
  }

  std::uint8_t Vector(std::uint8_t form) {
    is_vector_ = true;
    unsigned map = 1;
    if (form != 0xc5) {
      const std::uint8_t first = Next();
      map = form == 0x62 ? first & 7 : first & 0x1f;
      Next();
      if (form == 0x62) Next();
    } else {
      Next();
    }
    has_operand_size_ = false;
    opcode_ = Next();
    return OfVector(map, opcode_);
  }

  std::uint8_t Xop() {
    is_vector_ = true;
    const unsigned map = Next() & 0x1f;
    Next();
    has_operand_size_ = false;
    opcode_ = Next();
    return OfXop(map);
  }

  // Reads ModRM; returns what follows besides, as the register in it says.
  std::uint8_t ModRm() {
    mod_rm_ = Next();
    const unsigned mod = mod_rm_ >> 6, memory = mod_rm_ & 7;
    if (mod != 3) {
      const unsigned base = memory == 4 ? Next() & 7 : memory;
      if (mod == 0 && memory == 5) {
        instruction_.relative_at = static_cast<std::uint8_t>(n_);
        instruction_.is_movable = !has_address_size_;
      }
      if (mod == 2 || (mod == 0 && base == 5)) n_ += 4;
      if (mod == 1) n_ += 1;
    }
    const unsigned reg = mod_rm_ >> 3 & 7;
    if (is_vector_ || is_two_byte_ || reg > 1) return 0;
    if (opcode_ == 0xf6) return kByte;
    return opcode_ == 0xf7 ? kWhole : 0;
  }

  bool IsLongBranch() const { return !is_vector_ && opcode_ >= 0x80 && opcode_ <= 0x8f; }

  void TargetAt(std::size_t at, Flow flow, bool is_short) {
    instruction_.flow = flow;
    instruction_.has_target = true;
    instruction_.is_short = is_short;
    instruction_.is_movable = !has_operand_size_ && !has_repeat_ && flow != Flow::kCall;
    if (is_short) {
      instruction_.relative = static_cast<std::int8_t>(at_[at]);
    } else {
      instruction_.relative_at = static_cast<std::uint8_t>(at);
    }
  }

  void Leads(Flow flow) {
    instruction_.flow = flow;
    instruction_.is_movable = false;
  }

  void FlowOfOneByte(std::size_t immediate_at) {
    const unsigned reg = mod_rm_ >> 3 & 7;
    switch (opcode_) {
      case 0xe8:
        return TargetAt(immediate_at, Flow::kCall, false);
      case 0xe9:
        return TargetAt(immediate_at, Flow::kJump, false);
      case 0xeb:
        return TargetAt(immediate_at, Flow::kJump, true);
      case 0xc7:
        if (mod_rm_ != 0xf8) return;
        TargetAt(immediate_at, Flow::kBranch, false);  // xbegin
        instruction_.is_movable = false;
        return;
      case 0xff:
        if (reg == 2 || reg == 3) Leads(Flow::kCall);
        if (reg == 4 || reg == 5) Leads(Flow::kJumpAnywhere);
        return;
      case 0xca:
      case 0xcb:
      case 0xcc:
      case 0xcf:
      case 0xf1:
      case 0xf4:
        return Leads(Flow::kEnd);
      case 0xcd:
        return Leads(Flow::kNext);
      case 0xc2:
      case 0xc3:
        instruction_.flow = Flow::kEnd;
        return;
      default:
        break;
    }
    if (opcode_ >= 0x70 && opcode_ <= 0x7f) TargetAt(immediate_at, Flow::kBranch, true);
    if (opcode_ >= 0xe0 && opcode_ <= 0xe3) {
      TargetAt(immediate_at, Flow::kBranch, true);
      instruction_.is_movable = false;  // the instruction has no long form
    }
  }

  void FlowOfTwoByte(std::size_t immediate_at) {
    if (IsLongBranch()) return TargetAt(immediate_at, Flow::kBranch, false);
    if (opcode_ == 0x0b || opcode_ == 0xb9 || opcode_ == 0xff) return Leads(Flow::kEnd);
    // syscall and sysenter remember where they are.
    if (opcode_ == 0x05 || opcode_ == 0x34) Leads(Flow::kNext);
  }

  const std::uint8_t* const at_;
  const std::size_t left_;
  std::size_t n_ = 0;
  bool is_sound_ = true;
  bool has_operand_size_ = false, has_address_size_ = false, has_repeat_ = false;
  bool is_wide_ = false, is_two_byte_ = false, is_vector_ = false;
  std::uint8_t opcode_ = 0, mod_rm_ = 0;
  Instruction instruction_;
};

}  // namespace machine_code

// The instruction at `at`, before `end`.
inline Instruction Decode(const std::uint8_t* at, const std::uint8_t* end) {
  return machine_code::Decoder(at, end).Decode();
}

}  // namespace tcs::shm
