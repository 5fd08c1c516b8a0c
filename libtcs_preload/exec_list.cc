// execl and its kin: the arguments become a vector.
#include <stdarg.h>
#include <unistd.h>

#include <cstddef>

#include "libtcs_preload/guest.h"

extern char** environ;

namespace {

// `first` and what follows up to the null, in `to`, which has room for so many and a null.
void Take(const char* first, va_list rest, std::size_t count, char** to) {
  to[0] = const_cast<char*>(first);
  for (std::size_t i = 1; i <= count; ++i) to[i] = va_arg(rest, char*);
  to[count] = nullptr;
}

}  // namespace

// The vector `argv` of what follows `first`, on the caller's stack, as large as it has to be;
// `rest` is behind its null then.
#define TCS_TAKE_ARGUMENTS(first)                                                            \
  va_list rest;                                                                              \
  va_start(rest, first);                                                                     \
  std::size_t count = 0;                                                                     \
  for (const char* next = first; next != nullptr; next = va_arg(rest, const char*)) ++count; \
  va_end(rest);                                                                              \
  auto* const argv = static_cast<char**>(__builtin_alloca((count + 1) * sizeof(char*)));     \
  va_start(rest, first);                                                                     \
  Take(first, rest, count, argv)

TCS_EXPORT int execl(const char* path, const char* arg, ...) noexcept {
  TCS_TAKE_ARGUMENTS(arg);
  va_end(rest);
  return execve(path, argv, environ);
}

TCS_EXPORT int execlp(const char* file, const char* arg, ...) noexcept {
  TCS_TAKE_ARGUMENTS(arg);
  va_end(rest);
  return execvpe(file, argv, environ);
}

TCS_EXPORT int execle(const char* path, const char* arg, ...) noexcept {
  TCS_TAKE_ARGUMENTS(arg);
  char* const* envp = va_arg(rest, char* const*);
  va_end(rest);
  return execve(path, argv, envp);
}
