// Where /proc tells of a descriptor: FOLDER followed by its number. Async-signal-safe.
#pragma once

#include <string.h>

namespace tcs::preload {

struct DescriptorPath {
  DescriptorPath(const char* folder, int fd) {
    char digits[12];
    int n = 0;
    do digits[n++] = static_cast<char>('0' + fd % 10);
    while ((fd /= 10) > 0);
    char* end = stpcpy(text, folder);
    while (n > 0) *end++ = digits[--n];
    *end = '\0';
  }

  char text[40];
};

}  // namespace tcs::preload
