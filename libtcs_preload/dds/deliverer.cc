#include "libtcs_preload/dds/deliverer.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <vector>

#include "libtcs_preload/dds/mirrors.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"

namespace tcs::dds {
namespace {

thread_local bool t_is_deliverer;

struct Deliveries {
  std::mutex mutex;
  std::condition_variable done;
  std::vector<std::uint32_t> closing;
  bool ended = false;  // the run is over: a thread that wants something has to do it
  Mirrors mirrors;     // the deliverer's; after its end, of the thread that has the mutex
};

Deliveries& TheDeliveries() {
  static auto* state = new Deliveries;
  return *state;
}

bool IsNudge(const shm::DdsMessage& message) {
  return message.kind == shm::DdsKind::kHistoryEnd && GuidAt(message.subject) == Guid{};
}

void CloseNow(Deliveries& state, std::uint32_t domain) {
  state.mirrors.Close(domain);
  OverEnd(domain);
  if (HasDomain(domain)) state.mirrors.Complete();
}

void CloseDomains(Deliveries& state) {
  std::vector<std::uint32_t> closing;
  {
    const std::lock_guard lock(state.mutex);
    closing = state.closing;
  }
  if (closing.empty()) return;
  for (const std::uint32_t domain : closing) CloseNow(state, domain);
  const std::lock_guard lock(state.mutex);
  for (const std::uint32_t domain : closing) {
    state.closing.erase(std::ranges::find(state.closing, domain));
  }
  state.done.notify_all();
}

void HandleAll(Deliveries& state, const std::byte* messages, std::size_t size) {
  for (std::size_t at = 0; at + sizeof(shm::DdsMessage) <= size;) {
    shm::DdsMessage message;
    std::memcpy(&message, messages + at, sizeof(message));
    if (message.size < sizeof(message) || message.size > size - at) return;
    if (IsNudge(message)) {
      state.mirrors.Complete();
    } else {
      state.mirrors.Handle(message, messages + at + sizeof(message));
    }
    CloseDomains(state);
    at += message.size;
  }
}

void* Run(void*) {
  t_is_deliverer = true;
  Deliveries& state = TheDeliveries();
  const std::byte* messages = nullptr;
  while (const std::size_t size = TheLink().wait(&messages)) HandleAll(state, messages, size);
  const std::lock_guard lock(state.mutex);
  state.ended = true;
  state.done.notify_all();
  return nullptr;
}

}  // namespace

void StartDeliverer() {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  sigdelset(&all, SIGXCPU);  // at which Cyclone's own threads tell where they are, too
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_t thread;
  if (const int error = pthread_create(&thread, nullptr, Run, nullptr); error != 0) {
    Say("cannot start the thread that takes in DDS samples: %s", strerror(error));
    Deliveries& state = TheDeliveries();
    state.ended = true;
  } else {
    pthread_setname_np(thread, "tcs-dds");
    pthread_detach(thread);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

bool IsDeliverer() { return t_is_deliverer; }

void LookAgain() {
  // On the deliverer a listener has made what is new: the deliverer looks when the listener is
  // done.
  SendNudge();
}

void CloseDomain(std::uint32_t domain) {
  Deliveries& state = TheDeliveries();
  std::unique_lock lock(state.mutex);
  if (!state.ended) {
    state.closing.push_back(domain);
    if (t_is_deliverer) return;
    lock.unlock();
    SendNudge();
    lock.lock();
    state.done.wait(lock, [&state, domain] {
      return state.ended || std::ranges::count(state.closing, domain) == 0;
    });
    const auto left = std::ranges::find(state.closing, domain);
    if (left == state.closing.end()) return;
    state.closing.erase(left);
  }
  CloseNow(state, domain);
}

}  // namespace tcs::dds
