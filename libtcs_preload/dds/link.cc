// The process's way to all others that speak DDS: through the coordinator, and through memory that
// the two of them share.
#include "libtcs_preload/dds/link.h"

#include <dlfcn.h>
#include <string.h>
#include <sys/mman.h>

#include "libtcs_preload/attach.h"
#include "libtcs_preload/datagram_notes.h"
#include "libtcs_preload/dds/shim_link.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/dds_exchange.h"

using namespace tcs::preload;
using tcs::shm::DdsArea;
using tcs::shm::NotificationKind;

namespace {

DdsArea* g_area = nullptr;
std::int32_t g_owner = 0;  // the process that has joined: a child of fork has the area mapped, too
std::int64_t g_behind_ns = 0;
__thread bool t_delivers __attribute__((tls_model("initial-exec"))) = false;

char* Outbox() { return reinterpret_cast<char*>(g_area) + tcs::shm::kDdsHeaderSize; }
const char* Inbox() { return Outbox() + tcs::shm::kDdsBoxSize; }

DdsArea* MapArea(std::uint32_t process) {
  const int fd = OpenDdsArea();
  if (fd < 0) return nullptr;
  const long at = RawSyscall(SYS_mmap, 0, static_cast<long>(tcs::shm::kDdsAreaSize),
                             PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0L);
  RawSyscall(SYS_close, fd);
  if (at < 0 && at > -4096) return nullptr;
  auto* area = reinterpret_cast<DdsArea*>(at);
  return area->process == process ? area : nullptr;
}

std::uint32_t Join() {
  const Entered t;
  if (t == nullptr) return 0;
  const Reply reply = Exchange(*t, Request{.kind = NotificationKind::kDdsJoin});
  const auto process = static_cast<std::uint32_t>(reply.values[0]);
  if (reply.values[0] > 0) {
    g_owner = t->slot->pid;
    g_behind_ns = t->slot->cores > 1 ? reply.values[1] : 0;
    g_area = MapArea(process);
  }
  if (g_area != nullptr) return process;
  static const char kLine[] =
      "tcs: the run's shared memory has no room for this program's DDS, so its DDS uses sockets.\n";
  RawSyscall(SYS_write, STDERR_FILENO, Arg(kLine), sizeof kLine - 1);
  TellOfSockets(tcs::shm::WhySockets::kNoRoom);
  return 0;
}

bool Send(const iovec* parts, int count) {
  std::size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  if (size > tcs::shm::kDdsBoxSize) return false;
  const Entered t;
  if (t == nullptr) return true;  // the run is over
  char* to = Outbox();
  // The outbox is the parent's, which may be writing there. The coordinator says what is lost.
  if (t->slot->pid != g_owner) size = count = 0;
  for (int i = 0; i < count; ++i) {
    memcpy(to, parts[i].iov_base, parts[i].iov_len);
    to += parts[i].iov_len;
  }
  NoteSent(*t);
  Exchange(*t,
           Request{.kind = NotificationKind::kDdsSend, .args = {static_cast<std::int64_t>(size)}});
  return true;
}

void Taken(const tcs::shm::TakenSamples& samples) {
  GuestThread* t = Current();
  if (t == nullptr) return;
  NoteReceived(*t);
  if (NotesActivity()) NoteSamplesTaken(*t, samples);
}

bool AnyIsFull() { return g_area != nullptr && g_area->full_count.load() != 0; }

bool IsFull(std::uint32_t process) { return g_area != nullptr && g_area->IsFull(process); }

bool AwaitRoom(std::uint32_t process, std::int64_t until_ns) {
  const Entered t;
  if (t == nullptr || g_area == nullptr) return false;
  Exchange(*t,
           Request{.kind = NotificationKind::kDdsRoom, .deadline_ns = until_ns, .args = {process}});
  return !IsShutDown();
}

std::size_t Wait(const std::byte** messages) {
  t_delivers = true;
  *messages = reinterpret_cast<const std::byte*>(Inbox());
  for (;;) {
    GuestThread* t = Current();
    if (t == nullptr || IsShutDown()) return 0;
    const Reply reply = Exchange(*t, Request{.kind = NotificationKind::kDdsWait});
    if (IsShutDown()) return 0;  // the answer is to an earlier call
    if (reply.values[0] > 0) return static_cast<std::size_t>(reply.values[0]);
  }
}

void AwaitDeliverer(GuestThread& t) {
  if (g_area->delivers.load() == 0 && g_area->due_ns.load() > NowNs(t)) return;
  Exchange(t, Request{.kind = NotificationKind::kDdsSync});
}

void Sync() {
  const Entered t;
  if (t == nullptr || g_area == nullptr || t_delivers) return;
  HoldForRead(*t);
  AwaitDeliverer(*t);
}

void Settle() {
  const Entered t;
  if (t != nullptr && g_area != nullptr && !t_delivers) AwaitDeliverer(*t);
}

std::int64_t BehindNs() { return g_behind_ns; }

std::int64_t NowOfThread() {
  GuestThread* t = Current();
  return t == nullptr ? 0 : NowNs(*t);
}

}  // namespace

namespace tcs::preload {

const dds::Link kDdsLink{Join, Send,   AnyIsFull, IsFull,   AwaitRoom,   Wait,
                         Sync, Settle, Taken,     BehindNs, NowOfThread, LookUp};

const char* DdsLibrary(char (&path)[kDdsPathSize]) {
  static const char kName[] = "libtcs_dds.so";
  GuestThread* t = Current();
  Dl_info self{};
  if (t == nullptr || t->slot->dds_endpoints == 0) return nullptr;
  if (dladdr(reinterpret_cast<const void*>(&kDdsLink), &self) == 0) return nullptr;
  const char* const slash = strrchr(self.dli_fname, '/');
  const std::size_t folder =
      slash == nullptr ? 0 : static_cast<std::size_t>(slash + 1 - self.dli_fname);
  if (folder + sizeof kName > kDdsPathSize) return nullptr;
  memcpy(path, self.dli_fname, folder);
  memcpy(path + folder, kName, sizeof kName);
  return path;
}

void TellOfSockets(shm::WhySockets why) {
  static bool told = false;
  const Entered t;
  if (t == nullptr || told) return;
  told = true;
  Exchange(
      *t, Request{.kind = NotificationKind::kDdsSockets, .args = {static_cast<std::int64_t>(why)}});
}

}  // namespace tcs::preload
