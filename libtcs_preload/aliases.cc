// The names of files in calls that open them, or ask about them.
#include "libtcs_preload/aliases.h"

#include <string.h>

#include "libtcs_preload/environment.h"
#include "libtcs_preload/user_memory.h"

namespace tcs::preload {

namespace {

constexpr int kMostAliases = 64;

struct Alias {
  char file[32];
  const char* name;
  std::size_t size;
};
Alias g_aliases[kMostAliases];
int g_count = -1;  // not looked yet

// The result is the same each time, so that threads may compute it at once.
int Count() {
  if (g_count >= 0) return g_count;
  int count = 0;
  for (const char* line = AliasLines(); *line != '\0' && count < kMostAliases;) {
    const char* space = strchr(line, ' ');
    const char* end = strchr(line, '\n');
    if (space == nullptr || end == nullptr || space > end) break;
    const auto size = static_cast<std::size_t>(space - line);
    if (size < sizeof g_aliases[count].file) {
      memcpy(g_aliases[count].file, line, size);
      g_aliases[count].file[size] = '\0';
      g_aliases[count].name = space + 1;
      g_aliases[count].size = static_cast<std::size_t>(end - space - 1);
      ++count;
    }
    line = end + 1;
  }
  return g_count = count;
}

}  // namespace

const char* FileOf(const char* path) {
  const int count = Count();
  if (count == 0 || path == nullptr) return path;
  const char* const list[] = {path, nullptr};
  if (!CanReadStrings(list) || path[0] != '/') return path;
  for (int i = 0; i < count; ++i) {
    const Alias& alias = g_aliases[i];
    if (strncmp(path, alias.name, alias.size) == 0 && path[alias.size] == '\0') return alias.file;
  }
  return path;
}

}  // namespace tcs::preload
