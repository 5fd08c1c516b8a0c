#include "coordinator/dump/ask.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "coordinator/port/clocks.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/unique_fd.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

constexpr useconds_t kLookUs = 200;

// Calls `done` again and again until it is true, or the time is over.
template <class Done>
bool Await(std::int64_t within_ns, Done done) {
  const std::int64_t until_ns = HostClockNs(CLOCK_MONOTONIC) + within_ns;
  while (!done()) {
    if (HostClockNs(CLOCK_MONOTONIC) > until_ns) return false;
    usleep(kLookUs);
  }
  return true;
}

class MappedPage {
 public:
  explicit MappedPage(int fd) {
    struct stat status;
    const bool fits = fstat(fd, &status) == 0 &&
                      status.st_size == static_cast<off_t>(kStateTextAt + kMostStateText);
    if (!fits) return;
    void* at = mmap(nullptr, kStateTextAt, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (at != MAP_FAILED) page_ = static_cast<StatePage*>(at);
  }
  ~MappedPage() {
    if (page_ != nullptr) munmap(page_, kStateTextAt);
  }
  MappedPage(const MappedPage&) = delete;
  MappedPage& operator=(const MappedPage&) = delete;

  bool IsOurs() const {
    return page_ != nullptr && page_->magic == StatePage::kMagic &&
           page_->version == StatePage::kVersion;
  }
  StatePage* operator->() const { return page_; }
  const StatePage& operator*() const { return *page_; }

 private:
  StatePage* page_ = nullptr;
};

std::int64_t NsBefore(std::uint64_t now_tsc, std::uint64_t tsc, std::uint64_t ns_per_tick_q32) {
  if (tsc == 0 || tsc >= now_tsc) return 0;
  return shm::MulQ32(static_cast<std::int64_t>(now_tsc - tsc), ns_per_tick_q32);
}

CoordinatorState StateOf(const StatePage& page) {
  const std::uint64_t rate = CalibrateTsc(), now_tsc = HostTsc();
  return {.doing = page.doing.load(),
          .since_ns = NsBefore(now_tsc, page.since_tsc.load(), rate),
          .host_cpu = page.host_cpu.load(),
          .dispatched_tid = page.dispatched_tid.load(),
          .dispatched_since_ns = NsBefore(now_tsc, page.dispatched_tsc.load(), rate),
          .virtual_ns = page.virtual_ns.load(),
          .dispatches = page.dispatches.load()};
}

bool HasEnded(pid_t pid) {
  const char state = ThreadState(pid);
  return state == 'X' || state == 'Z';
}

// The pipe has no name but the one that the coordinator's descriptor has.
bool Wake(pid_t coordinator, int wake_fd) {
  const std::string path = fmt::format("/proc/{}/fd/{}", coordinator, wake_fd);
  const UniqueFd pipe(open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  if (!pipe) return false;
  // A full pipe wakes the coordinator as well.
  return write(pipe.get(), "?", 1) == 1 || errno == EAGAIN;
}

std::optional<std::string> TextIn(const FoundRun& run, std::uint64_t size) {
  std::string text(size, '\0');
  for (std::size_t had = 0; had < text.size();) {
    const ssize_t n = pread(run.memory.get(), text.data() + had, text.size() - had,
                            static_cast<off_t>(kStateTextAt + had));
    if (n <= 0) return std::nullopt;
    had += static_cast<std::size_t>(n);
  }
  return text;
}

}  // namespace

StateAnswer AskForState(const FoundRun& run, std::int64_t within_ns) {
  StateAnswer answer;
  const MappedPage page(run.memory.get());
  if (!page.IsOurs()) {
    answer.error = fmt::format(
        "the run of process {} is one of another version of tcsim: ask it with that one",
        run.coordinator);
    return answer;
  }
  const bool has_turn =
      Await(2 * within_ns, [&run] { return flock(run.memory.get(), LOCK_EX | LOCK_NB) == 0; });
  if (!has_turn) {
    answer.error = fmt::format(
        "somebody else asks the run of process {} again and again; try later", run.coordinator);
    return answer;
  }
  answer.coordinator = StateOf(*page);
  const std::int64_t begun_ns = HostClockNs(CLOCK_MONOTONIC);
  const std::int64_t computed_ns = ProcessCpuClockNs(run.coordinator);
  const std::uint32_t asked = page->asked.fetch_add(1) + 1;
  const bool is_woken = Wake(run.coordinator, page->wake_fd);
  const auto has_answered = [&] { return page->answered.load() == asked; };
  const bool is_over =
      is_woken && Await(within_ns, [&] { return has_answered() || HasEnded(run.coordinator); });
  const bool in_time = is_over && has_answered();
  answer.waited_ns = HostClockNs(CLOCK_MONOTONIC) - begun_ns;
  answer.computed_ns = std::max<std::int64_t>(0, ProcessCpuClockNs(run.coordinator) - computed_ns);
  if (!is_woken || (is_over && !in_time)) {
    answer.error = fmt::format("the run of process {} has just ended", run.coordinator);
  } else if (in_time && page->text_size.load() > kMostStateText) {
    answer.error = fmt::format("the run of process {} has too many threads to tell of in {} MB",
                               run.coordinator, kMostStateText >> 20);
  } else if (in_time) {
    answer.text = TextIn(run, page->text_size.load());
  }
  flock(run.memory.get(), LOCK_UN);
  return answer;
}

}  // namespace tcs
