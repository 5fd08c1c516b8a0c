#include "libtcs_preload/dds/say.h"

#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace tcs::dds {

void Say(const char* format, ...) {
  char line[512] = "tcs: ";
  constexpr std::size_t kRoom = sizeof(line) - 2;
  va_list arguments;
  va_start(arguments, format);
  const int said = std::vsnprintf(line + 5, kRoom - 5, format, arguments);
  va_end(arguments);
  std::size_t size = std::min(kRoom - 1, 5 + static_cast<std::size_t>(std::max(said, 0)));
  line[size++] = '\n';
  if (write(STDERR_FILENO, line, size) < 0) return;
}

}  // namespace tcs::dds
