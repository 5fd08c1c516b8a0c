// The random numbers that programs draw from the system under fixed accounting: numbers that
// repeat, in place of the kernel's. The shim draws for the calls that it sees, the coordinator for
// the calls that are trapped.
#pragma once

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tcs::shm {

// splitmix64: the state is a counter, so that a handler that draws between two draws does no harm.
class Draws {
 public:
  // Streams of neighbouring seeds begin far apart.
  void Seed(std::uint64_t seed) { State().store(Mix(seed)); }

  std::uint64_t Next() { return Mix(State().fetch_add(kStep) + kStep); }

  void Fill(void* buffer, std::size_t size) {
    auto* out = static_cast<char*>(buffer);
    while (size > 0) {
      const std::uint64_t word = Next();
      const std::size_t n = size < sizeof word ? size : sizeof word;
      std::memcpy(out, &word, n);
      out += n;
      size -= n;
    }
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;

  static std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::atomic_ref<std::uint64_t> State() { return std::atomic_ref(state_); }

  std::uint64_t state_ = 0;
};

// The kernel's devices: /dev/random and /dev/urandom, under whatever name.
inline bool IsRandomDevice(const struct stat& status) {
  return S_ISCHR(status.st_mode) &&
         (status.st_rdev == makedev(1, 8) || status.st_rdev == makedev(1, 9));
}

// A file that the kernel makes a new identifier for at each read.
inline constexpr char kUuidFile[] = "/proc/sys/kernel/random/uuid";

// Whether the file can be kUuidFile. Only its name, which costs a call to ask for, tells for sure.
inline bool MayBeUuidFile(const struct stat& status) {
  return S_ISREG(status.st_mode) && status.st_size == 0 && (status.st_mode & 0777) == 0444;
}

// Draws the digits of an identifier of version 4 anew. `at`: where in the identifier `text` begins.
inline void DrawUuid(Draws& draws, char* text, std::size_t size, std::size_t at = 0) {
  constexpr std::size_t kVersionDigit = 14, kVariantDigit = 19;
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_digit = (text[i] >= '0' && text[i] <= '9') || (text[i] >= 'a' && text[i] <= 'f');
    if (!is_digit || at + i == kVersionDigit) continue;
    const std::uint64_t word = draws.Next();
    text[i] = at + i == kVariantDigit ? "89ab"[word & 3] : "0123456789abcdef"[word & 15];
  }
}

}  // namespace tcs::shm
