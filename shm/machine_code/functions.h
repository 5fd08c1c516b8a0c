// Where the functions of a program or library begin and end, as its table for unwinding says
// (.eh_frame_hdr and .eh_frame: System V ABI for AMD64, and the Linux Standard Base).
//
// All addresses are those of an image as it lies in memory. Pure; async-signal-safe; wrong values
// in a table are never followed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tcs::shm {

using Code = const std::uint8_t*;

struct CodeRange {
  Code begin = nullptr, end = nullptr;

  bool IsEmpty() const { return begin >= end; }
  bool Contains(Code at) const { return begin <= at && at < end; }
  std::size_t size() const { return IsEmpty() ? 0 : static_cast<std::size_t>(end - begin); }
};

class UnwindTable {
 public:
  // Knows no function.
  UnwindTable() = default;
  // `header`: .eh_frame_hdr; `readable`: the memory that the header lies in; `image`: where
  // functions may be.
  UnwindTable(Code header, CodeRange readable, CodeRange image)
      : header_(header), readable_(readable), image_(image) {
    constexpr std::uint8_t kPlain32 = 0x03, kRelativeToHeader32 = 0x3b;
    if (!IsReadable(header, 12) || header[0] != 1 || (header[1] & 0x0f) != 0x0b ||
        header[2] != kPlain32 || header[3] != kRelativeToHeader32) {
      return;
    }
    const std::uint32_t count = Read<std::uint32_t>(header + 8);
    if (count <= readable.size() / 8 && IsReadable(header + 12, std::size_t{count} * 8)) {
      count_ = count;
    }
  }

  // The function that has the instruction at `at`; an empty range: none is known.
  CodeRange FunctionAt(Code at) const {
    const std::uint32_t i = FirstAfter(at);
    if (i == 0) return {};
    const CodeRange function = FunctionOf(i - 1);
    return function.Contains(at) ? function : CodeRange{};
  }

  // The range between two functions that `at` is in: padding, or code that the table does not know.
  CodeRange GapAround(Code at) const {
    const std::uint32_t next = FirstAfter(at);
    if (next == 0 || next == count_) return {};
    const CodeRange before = FunctionOf(next - 1);
    if (before.IsEmpty() || before.end > at) return {};
    return {before.end, Begin(next)};
  }

  // The range between a function's end and the begin of the next function; empty for the last
  // function, of which nothing can be said.
  CodeRange GapAfter(const CodeRange& function) const {
    const std::uint32_t next = FirstAfter(function.begin);
    if (next >= count_ || Begin(next) <= function.end) return {};
    return {function.end, Begin(next)};
  }
  CodeRange GapBefore(const CodeRange& function) const {
    const std::uint32_t i = FirstAfter(function.begin);
    if (i < 2) return {};
    const CodeRange before = FunctionOf(i - 2);
    if (before.IsEmpty() || before.end >= function.begin) return {};
    return {before.end, function.begin};
  }

 private:
  template <class T>
  static T Read(Code at) {
    T value;
    memcpy(&value, at, sizeof value);
    return value;
  }

  bool IsReadable(Code at, std::size_t size) const {
    return readable_.begin <= at && at <= readable_.end &&
           size <= static_cast<std::size_t>(readable_.end - at);
  }

  Code Begin(std::uint32_t i) const {
    return header_ + Read<std::int32_t>(header_ + 12 + std::size_t{i} * 8);
  }

  std::uint32_t FirstAfter(Code at) const {
    std::uint32_t low = 0, high = count_;
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      (Begin(middle) <= at ? low : high) = Begin(middle) <= at ? middle + 1 : middle;
    }
    return low;
  }

  CodeRange FunctionOf(std::uint32_t i) const {
    const Code entry = header_ + Read<std::int32_t>(header_ + 16 + std::size_t{i} * 8);
    if (!IsReadable(entry, 24)) return {};
    const Code to_common = entry + 4;
    const Code common = to_common - Read<std::uint32_t>(to_common);
    // An address relative to its own place, in 32 bits or in 64.
    constexpr int kRelative32 = 0x1b, kRelative64 = 0x1c;
    const int encoding = EncodingOf(common);
    const Code begin = Begin(i);
    std::uint64_t size = 0;
    if (encoding == kRelative32 && entry + 8 + Read<std::int32_t>(entry + 8) == begin) {
      size = Read<std::uint32_t>(entry + 12);
    } else if (encoding == kRelative64 && entry + 8 + Read<std::int64_t>(entry + 8) == begin) {
      size = Read<std::uint64_t>(entry + 16);
    }
    if (size == 0 || !image_.Contains(begin)) return {};
    if (size > static_cast<std::size_t>(image_.end - begin)) return {};
    return {begin, begin + size};
  }

  // How an entry with the common part `common` writes addresses; -1: not known.
  int EncodingOf(Code common) const {
    constexpr std::size_t kMost = 48;
    if (!IsReadable(common, kMost) || Read<std::uint32_t>(common + 4) != 0) return -1;
    const std::uint8_t version = common[8];
    const Code end = common + kMost;
    const Code names = common + 9;
    Code at = names;
    while (at < end && *at != 0) ++at;
    ++at;
    if (names[0] != 'z') return -1;
    at = PastNumber(PastNumber(at, end), end);         // of alignments
    at = version == 1 ? at + 1 : PastNumber(at, end);  // the return address's register
    at = PastNumber(at, end);                          // the size of what follows
    for (Code name = names + 1; at < end && *name != 0; ++name) {
      switch (*name) {
        case 'R':
          return *at;
        case 'L':
          ++at;
          break;
        case 'P':
          at += 1 + ((*at & 0x0f) == 0 || (*at & 0x07) == 4 ? 8 : 4);
          break;
        case 'S':
        case 'B':
          break;
        default:
          return -1;
      }
    }
    return -1;
  }

  static Code PastNumber(Code at, Code end) {
    while (at < end && (*at & 0x80) != 0) ++at;
    return at + 1;
  }

  Code header_ = nullptr;
  CodeRange readable_, image_;
  std::uint32_t count_ = 0;
};

}  // namespace tcs::shm
