#include "coordinator/os/cpu_claim.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <unistd.h>

#include <vector>

#include "coordinator/os/say.h"

namespace tcs {

namespace {

constexpr useconds_t kRetryUs = 20'000;

// Highest first.
std::vector<int> AllowedCpus() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<int> cpus;
  for (int cpu = CPU_SETSIZE - 1; cpu >= 0; --cpu) {
    if (CPU_ISSET(cpu, &allowed)) cpus.push_back(cpu);
  }
  return cpus;
}

// Its descriptor; -1 if another process holds the claim, -2 if it cannot be made.
int TryToClaim(int cpu) {
  const std::string folder = "/sys/devices/system/cpu/cpu" + std::to_string(cpu);
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return -2;
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  const bool held = errno == EWOULDBLOCK;
  close(fd);
  return held ? -1 : -2;
}

}  // namespace

int LastAllowedCpu() {
  const std::vector<int> cpus = AllowedCpus();
  return cpus.empty() ? 0 : cpus.front();
}

CpuClaim ClaimCpu() {
  std::vector<int> cpus = AllowedCpus();
  if (cpus.size() > 1) cpus.pop_back();
  for (bool said = false;; usleep(kRetryUs)) {
    for (const int cpu : cpus) {
      const int fd = TryToClaim(cpu);
      if (fd != -1) return {cpu, fd < 0 ? -1 : fd};
    }
    if (!said) {
      Say("other runs of tcsim have the processors; waiting for one of them");
    }
    said = true;
  }
}

}  // namespace tcs
