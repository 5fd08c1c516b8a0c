// free_rider WAY SECONDS: computes for so long, by the kernel's clock, and tells tcs by its own
// memory that it has not. Prints how long it has computed, by the kernel.
//   note     says that it has stopped long before it says so
//   origin   calls what it has computed the way out of its gate, and its shim's own work
//   calls    the same, of a program that is in the kernel most of the time
//   clock    turns its clock back, and says that it has just been compared with the kernel's
//   honest   does nothing of the kind
#include <linux/futex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <cstdint>
#include <string_view>

#include "shm/attach_protocol.h"
#include "shm/clock_page.h"
#include "shm/layout.h"

namespace {

using namespace tcs::shm;

constexpr std::int64_t kPieceNs = 200'000;

ThreadSlot* g_slot = nullptr;
int g_notify_fd = -1;

long Own(long number, long a, long b, long c) {
  return syscall(number, a, b, c, 0, 0, long{kOwnCallMark});
}

// Without a system call.
void Compute() {
  const std::uint64_t begun_tsc = __rdtsc();
  while (__rdtsc() - begun_tsc < 400'000) {
  }
}

std::int64_t ComputedNs() {
  timespec now;
  Own(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, reinterpret_cast<long>(&now), 0);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

bool FindSlot() {
  FILE* maps = fopen("/proc/self/maps", "re");
  char line[512];
  while (maps != nullptr && fgets(line, sizeof line, maps) != nullptr) {
    unsigned long start;
    if (strstr(line, "/memfd:tcs (deleted)") == nullptr || sscanf(line, "%lx", &start) != 1)
      continue;
    g_slot = reinterpret_cast<ThreadSlot*>(start);
  }
  if (maps != nullptr) fclose(maps);
  for (int fd = 1023; fd > 2 && g_notify_fd < 0; --fd) {
    char link[64], name[64] = {};
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    if (readlink(link, name, sizeof name - 1) > 0 && strncmp(name, "pipe:", 5) == 0) {
      g_notify_fd = fd;
    }
  }
  return g_slot != nullptr && g_notify_fd >= 0;
}

// As the shim does it, but for the time that it has come to.
void Notify(std::int64_t time_ns) {
  ThreadSlot& slot = *g_slot;
  slot.gate.store(kGateClosed);
  slot.note.kind = NotificationKind::kHorizon;
  slot.note.time_ns = time_ns;
  slot.note.fd_count = 0;
  const PipeMessage message{0, 0};
  Own(SYS_write, g_notify_fd, reinterpret_cast<long>(&message), sizeof message);
  std::uint32_t closed = kGateClosed;
  slot.gate.compare_exchange_strong(closed, kGateWaiting);
  while (slot.gate.load() == kGateWaiting) {
    Own(SYS_futex, reinterpret_cast<long>(&slot.gate), FUTEX_WAIT, kGateWaiting);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || !FindSlot()) return 3;
  const std::string_view way = argv[1];
  const auto end_ns = ComputedNs() + static_cast<std::int64_t>(atof(argv[2]) * 1e9);
  ClockPage& page = g_slot->clock;
  std::int64_t last_ns = ComputedNs();
  while (last_ns < end_ns) {
    const std::int64_t begun_ns = page.base_time_ns;
    std::int64_t now_ns = ComputedNs();
    while (now_ns - last_ns < kPieceNs) {
      if (way != "calls") Compute();
      now_ns = ComputedNs();
    }
    const std::int64_t computed_ns = now_ns - last_ns;
    last_ns = now_ns;
    if (way == "note") Notify(begun_ns + 1'000);
    if (way == "origin" || way == "calls") page.host_cpu_origin_ns += computed_ns;
    if (way == "origin" || way == "calls" || way == "clock") {
      const std::uint64_t word = page.executed_adjust.load();
      page.executed_adjust.store(PackAdjust(word, AdjustValue(word) - computed_ns));
      page.last_check_tsc.store(__rdtsc());
    }
  }
  printf("%lld\n", static_cast<long long>(ComputedNs()));
}
