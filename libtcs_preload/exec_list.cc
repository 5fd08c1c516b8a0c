// execl and its kin: the arguments become a vector.
#include <stdarg.h>
#include <unistd.h>

#include "libtcs_preload/guest.h"

extern char** environ;

namespace {

constexpr int kMaxArguments = 1024;

struct ArgumentVector {
  char* entries[kMaxArguments + 1];

  // Takes `first` and what follows up to the null; beyond kMaxArguments nothing is taken.
  void Take(const char* first, va_list rest) {
    int n = 0;
    for (const char* next = first; next != nullptr && n < kMaxArguments;
         next = va_arg(rest, const char*)) {
      entries[n++] = const_cast<char*>(next);
    }
    entries[n] = nullptr;
  }
};

}  // namespace

TCS_EXPORT int execl(const char* path, const char* arg, ...) noexcept {
  ArgumentVector argv;
  va_list rest;
  va_start(rest, arg);
  argv.Take(arg, rest);
  va_end(rest);
  return execve(path, argv.entries, environ);
}

TCS_EXPORT int execlp(const char* file, const char* arg, ...) noexcept {
  ArgumentVector argv;
  va_list rest;
  va_start(rest, arg);
  argv.Take(arg, rest);
  va_end(rest);
  return execvpe(file, argv.entries, environ);
}

TCS_EXPORT int execle(const char* path, const char* arg, ...) noexcept {
  ArgumentVector argv;
  va_list rest;
  va_start(rest, arg);
  argv.Take(arg, rest);
  char* const* envp = va_arg(rest, char* const*);
  va_end(rest);
  return execve(path, argv.entries, envp);
}
