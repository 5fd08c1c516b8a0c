#include "coordinator/os/cpu_claim.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "coordinator/os/claim_order.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/say.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

// The time between two looks of the run that is the next one, and the longest such time: runs
// further behind look less often.
constexpr useconds_t kRetryUs = 20'000, kMostRetryUs = 200'000;
// Of so many looks, one is at whether the runs ahead are stopped.
constexpr int kLooksPerStopLook = 10;
// A process that only looks (IsClaimed) has the lock for an instant.
constexpr int kLookers = 3;
constexpr useconds_t kLookUs = 200;
// Seconds after which a run that waits says again which runs it waits for.
constexpr time_t kSayAgainAfter = 30;

std::string FolderOf(int cpu) { return "/sys/devices/system/cpu/cpu" + std::to_string(cpu); }

UniqueFd OpenFolderOf(int cpu) {
  return UniqueFd(open(FolderOf(cpu).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

// A lock belongs to all processes that have inherited the descriptor on which it was taken. The map
// has a descriptor for each CPU, for the processes that this one forks; in those, until they have
// claimed a CPU.
std::map<int, UniqueFd> g_shared_folders;
constexpr std::size_t kMostShared = 256;

// None: another process holds the claim. Without a descriptor: the claim cannot be made.
std::optional<UniqueFd> TryToClaim(int cpu) {
  const auto shared = g_shared_folders.find(cpu);
  UniqueFd fd = shared == g_shared_folders.end()
                    ? OpenFolderOf(cpu)
                    : UniqueFd(fcntl(shared->second.get(), F_DUPFD_CLOEXEC, 0));
  for (int looker = 0; fd; ++looker, usleep(kLookUs)) {
    if (flock(fd.get(), LOCK_EX | LOCK_NB) == 0) return fd;
    if (errno != EWOULDBLOCK) return UniqueFd();
    if (looker == kLookers) return std::nullopt;
  }
  return fd;
}

// The process that holds the lock on the CPU's folder; 0: none, or none that this process can see.
pid_t HolderOf(int cpu) {
  struct stat folder;
  if (stat(FolderOf(cpu).c_str(), &folder) != 0) return 0;
  std::ifstream locks("/proc/locks");
  const std::string inode = ":" + std::to_string(folder.st_ino);
  // 1: FLOCK  ADVISORY  WRITE 1234 00:16:5678 0 EOF
  for (std::string line; std::getline(locks, line);) {
    std::istringstream fields(line);
    std::string number, kind, advisory, access, place;
    pid_t pid = 0;
    if (!(fields >> number >> kind >> advisory >> access >> pid >> place)) continue;
    if (kind == "FLOCK" && place.size() > inode.size() &&
        place.compare(place.size() - inode.size(), inode.size(), inode) == 0) {
      return std::max(pid, 0);
    }
  }
  return 0;
}

// The command as it was typed; shortened.
std::string CommandOf(pid_t pid) {
  constexpr std::size_t kMost = 60;
  std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline");
  std::string command, word;
  while (std::getline(file, word, '\0')) command += (command.empty() ? "" : " ") + word;
  for (char& c : command) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return command.size() > kMost ? command.substr(0, kMost) + "…" : command;
}

// For how long the process has been there, in seconds; negative if that is not known.
std::int64_t AgeOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t end = text.rfind(')');  // of its name, which may hold anything
  if (end == std::string::npos) return -1;
  std::istringstream fields(text.substr(end + 1));
  std::string field;
  for (int i = 3; i <= 21; ++i) fields >> field;
  std::int64_t started = 0;
  timespec now;
  if (!(fields >> started) || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return -1;
  return std::max<std::int64_t>(0, now.tv_sec - started / sysconf(_SC_CLK_TCK));
}

constexpr char kOthersHaveThem[] = "other runs of tcsim have the processors";

// "… (CPU 1: pid 1234, for 12 s: tcsim run flight.yaml)", as far as that is known.
std::string WhoHas(const std::vector<int>& cpus) {
  std::string who;
  for (const int cpu : cpus) {
    const pid_t pid = HolderOf(cpu);
    if (pid == 0) continue;
    who +=
        (who.empty() ? " (CPU " : "; CPU ") + std::to_string(cpu) + ": pid " + std::to_string(pid);
    if (const std::int64_t age = AgeOf(pid); age >= 0) who += ", for " + std::to_string(age) + " s";
    if (const std::string command = CommandOf(pid); !command.empty()) who += ": " + command;
  }
  return kOthersHaveThem + (who.empty() ? who : who + ")");
}

// A run may be stopped by ^Z, for one. A run that this process cannot see counts as not stopped.
bool IsStopped(const WaitingRun& run) {
  const char state = run.pid == 0 ? 'R' : ThreadState(run.pid);
  return state == 'T' || state == 't';
}

// Whether a CPU that real-time threads keep busy has some time for others: by real-time throttling,
// or since Linux 6.12 by a fair server, which root can turn off, and only root can look at.
bool LeavesOthersSome(int cpu) {
  std::int64_t runtime = -1, period = 0, server = 1;
  std::ifstream("/proc/sys/kernel/sched_rt_runtime_us") >> runtime;
  std::ifstream("/proc/sys/kernel/sched_rt_period_us") >> period;
  std::ifstream file("/sys/kernel/debug/sched/fair_server/cpu" + std::to_string(cpu) + "/runtime");
  if (file.is_open()) file >> server;
  return runtime >= 0 && runtime < period && server > 0;
}

time_t SecondsNow() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

// Claims one of the CPUs that no run ahead waits for. None: other runs have them all.
std::optional<CpuClaim> TryToClaimOneOf(const std::vector<int>& cpus,
                                        const std::vector<WaitingRun>& ahead) {
  for (const int cpu : cpus) {
    if (IsAwaited(cpu, ahead)) continue;
    std::optional<UniqueFd> fd = TryToClaim(cpu);
    if (!fd) continue;
    g_shared_folders.clear();
    return CpuClaim{cpu, std::move(*fd)};
  }
  return std::nullopt;
}

}  // namespace

CpuClaim::~CpuClaim() {
  if (fd) flock(fd.get(), LOCK_UN);
}

void ShareClaimsOfChildren() {
  for (const int cpu : AllowedCpus()) {
    if (g_shared_folders.size() == kMostShared) return;
    if (UniqueFd fd = OpenFolderOf(cpu)) g_shared_folders.emplace(cpu, std::move(fd));
  }
}

bool IsClaimed(int cpu) {
  const UniqueFd fd = OpenFolderOf(cpu);
  return fd && flock(fd.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

int LastAllowedCpu() {
  const std::vector<int> cpus = AllowedCpus();
  return cpus.empty() ? 0 : cpus.front();
}

LentCpu::LentCpu(const CpuClaim& claim) : claim_(claim) {
  if (claim.fd) flock(claim.fd.get(), LOCK_UN);
}

bool LentCpu::TakeBack() {
  if (!claim_.fd) return true;
  const auto is_for_others = [this] {
    return others_ != nullptr && IsAwaited(claim_.cpu, RivalsOf({claim_.cpu}, others_->Ahead()));
  };
  // All processes that have inherited the descriptor hold the claim again.
  if (!is_for_others() && flock(claim_.fd.get(), LOCK_EX | LOCK_NB) == 0) {
    others_.reset();
    return true;
  }
  if (others_ == nullptr) {
    others_ = std::make_unique<CpuRegister>();
    others_->Queue({claim_.cpu});
  }
  return false;
}

std::string LentCpu::WhoHasIt() const { return WhoHas({claim_.cpu}); }

std::variant<CpuClaim, std::string> ClaimCpu(bool waits) {
  CpuRegister others;
  const std::vector<int> allowed = AllowedCpus();
  const std::vector<int> cpus = CpusToClaim(
      allowed, [&](int cpu) { return others.SharersOf(cpu) > 0; },
      !allowed.empty() && LeavesOthersSome(allowed.back()));
  if (waits) others.Queue(cpus);
  std::optional<std::size_t> place;  // the place that this run has said last
  const time_t since = SecondsNow();
  time_t said = since;
  for (int look = 1;; ++look) {
    std::vector<WaitingRun> ahead = RivalsOf(cpus, others.Ahead());
    const std::size_t runs_ahead = ahead.size();
    if (look % kLooksPerStopLook == 0) std::erase_if(ahead, IsStopped);
    if (std::optional<CpuClaim> claim = TryToClaimOneOf(cpus, ahead)) return std::move(*claim);
    if (!waits) return WhoHas(cpus) + "; wait for one of them, or run without --no-wait";
    const time_t now = SecondsNow();
    if (!place.has_value()) {
      Say(WhoHas(cpus) + "; waiting for one of them, " + PlaceInWords(runs_ahead));
    } else if (now - said >= kSayAgainAfter) {
      Say(WhoHas(cpus) + "; waiting for one of them for " + std::to_string(now - since) + " s, " +
          PlaceInWords(runs_ahead));
    } else if (*place != runs_ahead) {
      Say(std::string(kOthersHaveThem) + "; " + PlaceInWords(runs_ahead));
    }
    if (place != runs_ahead || now - said >= kSayAgainAfter) said = now;
    place = runs_ahead;
    usleep(
        static_cast<useconds_t>(std::min<std::size_t>(kRetryUs * (runs_ahead + 1), kMostRetryUs)));
  }
}

}  // namespace tcs
