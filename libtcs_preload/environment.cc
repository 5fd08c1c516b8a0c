#include "libtcs_preload/environment.h"

#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>

#include <utility>

#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "shm/attach_protocol.h"

namespace tcs::preload {

namespace {

constexpr char kPreload[] = "LD_PRELOAD";
constexpr const char* kOwnLibraries[] = {"libtcs_preload.so", "libtcs_allocations.so"};
constexpr char kSeparators[] = ": ";

char g_own_libraries[4096];  // the part of LD_PRELOAD that is tcs's: "/there/libtcs_preload.so"
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

// Copies the texts that it is given, one behind the other.
class Copy {
 public:
  explicit Copy(char* to) : at_(to) { *at_ = '\0'; }
  void Put(const char* text, std::size_t length) {
    memcpy(at_, text, length);
    at_ += length;
    *at_ = '\0';
  }

 private:
  char* at_;
};

// How much room a copy takes.
class Count {
 public:
  void Put(const char*, std::size_t length) { size_ += length; }
  std::size_t size() const { return size_ + 1; }

 private:
  std::size_t size_ = 0;
};

// Whether a copy would be the same as a text.
class Comparison {
 public:
  explicit Comparison(const char* with) : at_(with) {}
  void Put(const char* text, std::size_t length) {
    is_same_ = is_same_ && strncmp(at_, text, length) == 0;
    if (is_same_) at_ += length;
  }
  bool IsSame() const { return is_same_ && *at_ == '\0'; }

 private:
  const char* at_;
  bool is_same_ = true;
};

// Puts the items of `list` that are tcs's, or the other ones, behind the items that are there
// already.
template <class To>
void PutItems(const char* list, bool ours, bool* has_items, To& to) {
  for (Item item = TakeItem(list); item.length != 0; item = TakeItem(list)) {
    if (item.IsOurs() != ours) continue;
    if (std::exchange(*has_items, true)) to.Put(":", 1);
    to.Put(item.text, item.length);
  }
}

// The entry with which a program is executed whose own entry is `value` (null: there is none). The
// program's own libraries come first: a sanitizer's runtime must, and of libraries that define the
// same function the first one passes calls on to ours.
template <class To>
void PutEntry(const char* value, To& to) {
  bool has_items = false;
  to.Put(kPreload, sizeof kPreload - 1);
  to.Put("=", 1);
  if (value != nullptr) PutItems(value, false, &has_items, to);
  PutItems(g_own_libraries, true, &has_items, to);
}

std::size_t CountOf(char* const* envp) {
  std::size_t count = 0;
  while (envp != nullptr && envp[count] != nullptr) ++count;
  return count;
}

}  // namespace

void RememberEnvironment(char** envp) {
  if (const char* preload = Find(envp, kPreload); preload != nullptr) {
    bool has_items = false;
    Count room;
    PutItems(preload + sizeof kPreload, true, &has_items, room);
    has_items = false;
    Copy own(g_own_libraries);
    if (room.size() <= sizeof g_own_libraries)
      PutItems(preload + sizeof kPreload, true, &has_items, own);
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

EnvironmentWithShim::EnvironmentWithShim(char* const* envp) : entries_(envp) {
  if (g_socket_entry[0] == '\0' || g_own_libraries[0] == '\0') return;
  if (!CanReadStrings(envp)) return;  // the kernel says what is wrong with it
  const char* preload = Find(envp, kPreload);
  const char* socket = Find(envp, shm::kSocketVariable);
  const char* aliases = Find(envp, shm::kAliasesVariable);
  const char* value = preload == nullptr ? nullptr : preload + sizeof kPreload;
  const bool has_aliases =
      g_aliases_entry[0] == '\0' || (aliases != nullptr && strcmp(aliases, g_aliases_entry) == 0);
  if (preload != nullptr && socket != nullptr && strcmp(socket, g_socket_entry) == 0 &&
      has_aliases) {
    Comparison own(preload);
    PutEntry(value, own);
    if (own.IsSame()) return;
  }
  Count room;
  PutEntry(value, room);
  const std::size_t entries_size = (CountOf(envp) + 4) * sizeof(char*);
  mapped_size_ = entries_size + room.size();
  const long made = RawSyscall(SYS_mmap, 0, static_cast<long>(mapped_size_), PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (made < 0 && made > -4096) return;
  mapped_ = reinterpret_cast<void*>(made);
  auto* const entries = static_cast<char**>(mapped_);
  char* const entry = static_cast<char*>(mapped_) + entries_size;
  Copy to(entry);
  PutEntry(value, to);
  std::size_t n = 0;
  for (; envp != nullptr && *envp != nullptr; ++envp) {
    if (*envp != preload && *envp != socket && *envp != aliases) entries[n++] = *envp;
  }
  entries[n++] = entry;
  entries[n++] = g_socket_entry;
  if (g_aliases_entry[0] != '\0') entries[n++] = g_aliases_entry;
  entries[n] = nullptr;
  entries_ = entries;
}

EnvironmentWithShim::~EnvironmentWithShim() {
  if (mapped_ != nullptr) RawSyscall(SYS_munmap, Arg(mapped_), static_cast<long>(mapped_size_));
}

}  // namespace tcs::preload
