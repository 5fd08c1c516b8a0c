#include "coordinator/dump/state_link.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <new>
#include <optional>
#include <utility>

#include "coordinator/os/shared_memory.h"

namespace tcs {

StateLink::~StateLink() {
  if (page_ != &own_) munmap(page_, kStateTextAt + kMostStateText);
}

void StateLink::Open(const std::string& folder) {
  std::optional<Pipe> pipe = Pipe::Make();
  if (!pipe.has_value()) return;
  SharedMemory memory = MakeSharedMemory(StatePage::kName, kStateTextAt + kMostStateText);
  if (!memory.fd) return;
  for (const int end : {pipe->read_end.get(), pipe->write_end.get()}) {
    fcntl(end, F_SETFL, O_NONBLOCK);
  }
  auto* page = new (memory.at) StatePage;
  page->coordinator_pid = getpid();
  page->wake_fd = pipe->write_end.get();
  if (folder.size() < StatePage::kMostPath) memcpy(page->folder, folder.c_str(), folder.size());
  page->magic.store(StatePage::kMagic);
  page_ = page;
  memory_ = std::move(memory.fd);
  pipe_ = std::move(*pipe);
}

void StateLink::Dispatched(pid_t tid, std::uint64_t tsc, std::int64_t at_ns) {
  constexpr auto kRelaxed = std::memory_order_relaxed;
  page_->dispatched_tid.store(tid, kRelaxed);
  page_->dispatched_tsc.store(tsc, kRelaxed);
  page_->virtual_ns.store(at_ns, kRelaxed);
  page_->dispatches.store(page_->dispatches.load(kRelaxed) + 1, kRelaxed);
}

bool StateLink::TakeAsked() {
  char bytes[256];
  while (read(pipe_.read_end.get(), bytes, sizeof bytes) == sizeof bytes) {
  }
  asked_ = page_->asked.load();
  return asked_ != page_->answered.load();
}

void StateLink::Answer(std::string_view text) {
  const bool fits = text.size() <= kMostStateText;
  if (fits) memcpy(reinterpret_cast<char*>(page_) + kStateTextAt, text.data(), text.size());
  page_->text_size.store(fits ? text.size() : StatePage::kTooLong);
  page_->answered.store(asked_);
}

}  // namespace tcs
