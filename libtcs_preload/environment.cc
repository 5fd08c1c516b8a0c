#include "libtcs_preload/environment.h"

#include <string.h>

#include "libtcs_preload/user_memory.h"
#include "shm/attach_protocol.h"

namespace tcs::preload {

namespace {

constexpr char kPreload[] = "LD_PRELOAD";
char g_preload_entry[4096];
char g_socket_entry[256];
bool g_remembered = false;

const char* Find(char* const* envp, const char* name) {
  const std::size_t length = strlen(name);
  for (; envp != nullptr && *envp != nullptr; ++envp) {
    if (strncmp(*envp, name, length) == 0 && (*envp)[length] == '=') return *envp;
  }
  return nullptr;
}

void Keep(const char* entry, char* to, std::size_t size) {
  if (entry != nullptr && strlen(entry) < size) strcpy(to, entry);
}

}  // namespace

void RememberEnvironment(char** envp) {
  Keep(Find(envp, kPreload), g_preload_entry, sizeof g_preload_entry);
  Keep(Find(envp, shm::kSocketVariable), g_socket_entry, sizeof g_socket_entry);
  g_remembered = true;
}

bool EnvironmentRemembered() { return g_remembered; }

const char* SocketName() {
  return g_socket_entry[0] == '\0' ? nullptr : g_socket_entry + sizeof shm::kSocketVariable;
}

char* const* WithShim(char* const* envp, EnvironmentCopy& storage) {
  if (g_socket_entry[0] == '\0' || g_preload_entry[0] == '\0') return envp;
  if (!CanReadStrings(envp)) return envp;  // the kernel says what is wrong with it
  const char* preload = Find(envp, kPreload);
  const char* socket = Find(envp, shm::kSocketVariable);
  if (preload != nullptr && socket != nullptr && strcmp(preload, g_preload_entry) == 0 &&
      strcmp(socket, g_socket_entry) == 0) {
    return envp;
  }
  std::size_t n = 0;
  for (; envp != nullptr && envp[0] != nullptr; ++envp) {
    if (envp[0] == preload || envp[0] == socket) continue;
    if (n == EnvironmentCopy::kMaxEntries) break;
    storage.entries[n++] = envp[0];
  }
  storage.entries[n++] = g_preload_entry;
  storage.entries[n++] = g_socket_entry;
  storage.entries[n] = nullptr;
  return storage.entries;
}

}  // namespace tcs::preload
