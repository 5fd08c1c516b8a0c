#include "coordinator/errors/visible.h"

#include <array>
#include <cstdint>

namespace tcs {

namespace {

// The first character of `text`, which is not empty, and its bytes; none of them if it is no UTF-8.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

Character FirstOf(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) return {};
  std::uint32_t code = first & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  // Too long for what they say, halves of pairs, and beyond the last character.
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool is_half = code >= 0xd800 && code <= 0xdfff;
  return code < kLeast[bytes] || is_half || code > 0x10ffff ? Character{} : Character{code, bytes};
}

bool IsShown(std::uint32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool turns = code == 0x200e || code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
                     (code >= 0x2066 && code <= 0x2069);
  return !is_control && !turns;
}

std::string WithVisible(std::string_view text, bool keeps_line_ends) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string visible;
  visible.reserve(text.size());
  while (!text.empty()) {
    const auto [code, bytes] = FirstOf(text);
    const std::size_t taken = bytes == 0 ? 1 : bytes;
    if (bytes > 0 && (IsShown(code) || (code == '\n' && keeps_line_ends))) {
      visible += text.substr(0, bytes);
    } else if (bytes > 0 && (code == '\n' || code == '\t')) {
      visible += code == '\n' ? "\\n" : "\\t";
    } else {
      for (const char c : text.substr(0, taken)) {
        const auto value = static_cast<unsigned char>(c);
        visible += {'\\', 'x', kDigits[value >> 4], kDigits[value & 15]};
      }
    }
    text.remove_prefix(taken);
  }
  return visible;
}

}  // namespace

std::string Visible(std::string_view text) { return WithVisible(text, false); }

std::string VisibleLines(std::string_view text) { return WithVisible(text, true); }

}  // namespace tcs
