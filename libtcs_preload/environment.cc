#include "libtcs_preload/environment.h"

#include <string.h>

#include "libtcs_preload/user_memory.h"
#include "shm/attach_protocol.h"

namespace tcs::preload {

namespace {

constexpr char kPreload[] = "LD_PRELOAD";
constexpr const char* kOwnLibraries[] = {"libtcs_preload.so", "libtcs_allocations.so"};
constexpr char kSeparators[] = ": ";

char g_own_libraries[4096];  // of LD_PRELOAD, what is tcs's: "/there/libtcs_preload.so"
char g_socket_entry[256];
char g_aliases_entry[4096];  // empty: there are none
bool g_remembered = false;

const char* Find(char* const* envp, const char* name) {
  const std::size_t length = strlen(name);
  for (; envp != nullptr && *envp != nullptr; ++envp) {
    if (strncmp(*envp, name, length) == 0 && (*envp)[length] == '=') return *envp;
  }
  return nullptr;
}

// An item of a list like LD_PRELOAD's.
struct Item {
  const char* text;
  std::size_t length;

  bool IsOurs() const {
    for (const char* name : kOwnLibraries) {
      const std::size_t size = strlen(name);
      if (length < size || memcmp(text + length - size, name, size) != 0) continue;
      if (length == size || text[length - size - 1] == '/') return true;
    }
    return false;
  }
};

// The first item of `list`, which moves behind it; of length 0 at the end.
Item TakeItem(const char*& list) {
  list += strspn(list, kSeparators);
  const Item item{list, strcspn(list, kSeparators)};
  list += item.length;
  return item;
}

// A list in a buffer. What does not fit makes all of it of no use.
class List {
 public:
  List(char* to, std::size_t size) : begin_(to), at_(to), end_(to + size) {}

  void Add(const Item& item) {
    if (has_items_) Put(":", 1);
    Put(item.text, item.length);
    has_items_ = true;
  }
  // The items of `list` that are tcs's, or those that are not.
  void Add(const char* list, bool ours) {
    for (Item item = TakeItem(list); item.length != 0; item = TakeItem(list)) {
      if (item.IsOurs() == ours) Add(item);
    }
  }
  void Put(const char* text, std::size_t length) {
    fits_ = fits_ && length < static_cast<std::size_t>(end_ - at_);
    if (!fits_) return;
    memcpy(at_, text, length);
    at_ += length;
    *at_ = '\0';
  }
  bool fits() const { return fits_; }
  void Clear() { *(at_ = begin_) = '\0', fits_ = true, has_items_ = false; }

 private:
  char *begin_, *at_, *end_;
  bool fits_ = true, has_items_ = false;
};

// Writes the entry with which a program is executed whose own is `value` (null: it has none). Its
// own libraries come first: a sanitizer's runtime must, and of those that define the same function
// the first one passes it on to ours.
void WriteEntry(const char* value, char* to, std::size_t size) {
  List list(to, size);
  const auto begin = [&] {
    list.Clear();
    list.Put(kPreload, sizeof kPreload - 1);
    list.Put("=", 1);
  };
  begin();
  if (value != nullptr) list.Add(value, false);
  list.Add(g_own_libraries, true);
  if (list.fits()) return;
  begin();  // without the shim it would be lost
  list.Add(g_own_libraries, true);
}

}  // namespace

void RememberEnvironment(char** envp) {
  if (const char* preload = Find(envp, kPreload); preload != nullptr) {
    List own(g_own_libraries, sizeof g_own_libraries);
    own.Add(preload + sizeof kPreload, true);
    if (!own.fits()) own.Clear();
  }
  const char* socket = Find(envp, shm::kSocketVariable);
  if (socket != nullptr && strlen(socket) < sizeof g_socket_entry) strcpy(g_socket_entry, socket);
  const char* aliases = Find(envp, shm::kAliasesVariable);
  if (aliases != nullptr && strlen(aliases) < sizeof g_aliases_entry) {
    strcpy(g_aliases_entry, aliases);
  }
  g_remembered = true;
}

bool EnvironmentRemembered() { return g_remembered; }

const char* AliasLines() {
  return g_aliases_entry[0] == '\0' ? "" : g_aliases_entry + sizeof shm::kAliasesVariable;
}

const char* SocketName() {
  return g_socket_entry[0] == '\0' ? nullptr : g_socket_entry + sizeof shm::kSocketVariable;
}

char* const* WithShim(char* const* envp, EnvironmentCopy& storage) {
  if (g_socket_entry[0] == '\0' || g_own_libraries[0] == '\0') return envp;
  if (!CanReadStrings(envp)) return envp;  // the kernel says what is wrong with it
  const char* preload = Find(envp, kPreload);
  const char* socket = Find(envp, shm::kSocketVariable);
  const char* aliases = Find(envp, shm::kAliasesVariable);
  const bool has_aliases =
      g_aliases_entry[0] == '\0' || (aliases != nullptr && strcmp(aliases, g_aliases_entry) == 0);
  WriteEntry(preload == nullptr ? nullptr : preload + sizeof kPreload, storage.preload,
             sizeof storage.preload);
  if (preload != nullptr && socket != nullptr && strcmp(preload, storage.preload) == 0 &&
      strcmp(socket, g_socket_entry) == 0 && has_aliases) {
    return envp;
  }
  std::size_t n = 0;
  for (; envp != nullptr && envp[0] != nullptr; ++envp) {
    if (envp[0] == preload || envp[0] == socket || envp[0] == aliases) continue;
    if (n == EnvironmentCopy::kMaxEntries) break;
    storage.entries[n++] = envp[0];
  }
  storage.entries[n++] = storage.preload;
  storage.entries[n++] = g_socket_entry;
  if (g_aliases_entry[0] != '\0') storage.entries[n++] = g_aliases_entry;
  storage.entries[n] = nullptr;
  return storage.entries;
}

}  // namespace tcs::preload
