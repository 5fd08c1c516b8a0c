// The string functions that the shim calls, as its own, hidden ones. The functions that its process
// finds first may be wrapped: by a sanitizer's runtime in the program, which cannot be called
// before it has set itself up, and the shim comes before all others.
//
// Async-signal-safe, and they allocate nothing.
#include <cstddef>

#define TCS_HIDDEN __attribute__((visibility("hidden")))

namespace tcs::preload {

// Under names of their own, for the headers declare the real ones otherwise.
TCS_HIDDEN std::size_t LengthOf(const char* text) __asm__("strlen");
TCS_HIDDEN std::size_t LengthUpTo(const char* text, std::size_t most) __asm__("strnlen");
TCS_HIDDEN int Compare(const char* a, const char* b) __asm__("strcmp");
TCS_HIDDEN int CompareUpTo(const char* a, const char* b, std::size_t most) __asm__("strncmp");
TCS_HIDDEN const char* FirstOf(const char* text, int character) __asm__("strchr");
TCS_HIDDEN const char* LastOf(const char* text, int character) __asm__("strrchr");
TCS_HIDDEN const char* Within(const char* text, const char* part) __asm__("strstr");
TCS_HIDDEN std::size_t SpanOf(const char* text, const char* set) __asm__("strspn");
TCS_HIDDEN std::size_t SpanOfOthers(const char* text, const char* set) __asm__("strcspn");

// The compiler is not to find that these functions are what they are, and call them.
#pragma GCC optimize("no-tree-loop-distribute-patterns")

std::size_t LengthUpTo(const char* text, std::size_t most) {
  std::size_t n = 0;
  while (n < most && text[n] != '\0') ++n;
  return n;
}

std::size_t LengthOf(const char* text) {
  std::size_t n = 0;
  while (text[n] != '\0') ++n;
  return n;
}

int CompareUpTo(const char* a, const char* b, std::size_t most) {
  for (std::size_t i = 0; i < most; ++i) {
    if (a[i] != b[i] || a[i] == '\0') {
      return static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i]);
    }
  }
  return 0;
}

int Compare(const char* a, const char* b) { return CompareUpTo(a, b, ~std::size_t{0}); }

const char* FirstOf(const char* text, int character) {
  for (;; ++text) {
    if (*text == static_cast<char>(character)) return text;
    if (*text == '\0') return nullptr;
  }
}

const char* LastOf(const char* text, int character) {
  const char* last = nullptr;
  for (;; ++text) {
    if (*text == static_cast<char>(character)) last = text;
    if (*text == '\0') return last;
  }
}

std::size_t SpanOfOthers(const char* text, const char* set) {
  std::size_t n = 0;
  while (FirstOf(set, text[n]) == nullptr) ++n;  // the end of the text is the last in each set
  return n;
}

std::size_t SpanOf(const char* text, const char* set) {
  std::size_t n = 0;
  while (text[n] != '\0' && FirstOf(set, text[n]) != nullptr) ++n;
  return n;
}

const char* Within(const char* text, const char* part) {
  const std::size_t size = LengthOf(part);
  for (;; ++text) {
    if (CompareUpTo(text, part, size) == 0) return text;
    if (*text == '\0') return nullptr;
  }
}

}  // namespace tcs::preload
