// Which threads wait at which futex words: the kernel's wait queues. A wake goes to the most urgent
// thread that waits at a word, among equals to the one that has waited longest.
//
// Pure: makes no system call and reads no memory, so that words have no values here. Threads are
// numbers. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "coordinator/os/futex_key.h"

namespace tcs {

class FutexTable {
 public:
  using Thread = int;
  static constexpr Thread kNobody = -1;
  // A thread's priority as it is now; higher is more urgent.
  using PriorityOf = std::function<std::int64_t(Thread)>;

  explicit FutexTable(PriorityOf priority_of) : priority_of_(std::move(priority_of)) {}

  // The thread, which waits nowhere yet, waits at the word for a wake with one of these bits.
  void Wait(Thread thread, const FutexKey& word, std::uint32_t bits);
  // The thread waits at several words (futex_waitv).
  void WaitForAny(Thread thread, std::vector<FutexKey> words, std::uint32_t bits);
  // The thread, which waits, is to be moved to that lock (FUTEX_WAIT_REQUEUE_PI): wakes pass it by
  // until it is there.
  void ExpectLock(Thread thread, const FutexKey& lock);
  // Nothing happens if the thread does not wait.
  void Leave(Thread thread);
  // Moves the thread from the one word to the other, behind the threads that wait there.
  void Move(Thread thread, const FutexKey& from, const FutexKey& to);

  bool WaitsForAny(Thread thread) const;
  std::optional<FutexKey> ExpectedLock(Thread thread) const;
  // The word's place among the words at which the thread waits; 0 if it is none of them.
  std::size_t IndexOf(Thread thread, const FutexKey& word) const;
  // The word at which the thread waits, which must be one.
  const FutexKey& WordOf(Thread thread) const;
  // The first of the words at which the thread waits; null: none.
  const FutexKey* FirstWordOf(Thread thread) const;

  // False if no thread waits at this place of any page, and so none at this address, whatever it is
  // mapped to.
  bool MayBeWaitedAt(std::uint64_t address) const;
  // The thread that a wake with these bits is for; kNobody: none.
  Thread MostUrgent(const FutexKey& word, std::uint32_t bits) const;
  // The words at which threads wait, each once, in the order of processes and addresses.
  std::vector<FutexKey> AwaitedWords() const;
  // The threads that wait at the word, in the order of waiting.
  std::vector<Thread> WaitersAt(const FutexKey& word) const;
  // The same, the most urgent first.
  std::vector<Thread> ByUrgency(const FutexKey& word) const;

 private:
  static constexpr std::size_t kWordsOfAPage = 1024;

  struct Waiting {
    std::vector<FutexKey> words;
    std::uint32_t bits = 0;
    bool is_for_any = false;
    std::optional<FutexKey> expected_lock;
  };
  struct Hash {
    std::size_t operator()(const FutexKey& key) const;
  };

  static std::size_t PlaceInPage(std::uint64_t address) { return address / 4 % kWordsOfAPage; }
  void Enqueue(Thread thread, const FutexKey& word);
  void Dequeue(Thread thread, const FutexKey& word);

  PriorityOf priority_of_;
  std::unordered_map<Thread, Waiting> waiting_;
  std::unordered_map<FutexKey, std::vector<Thread>, Hash> queues_;  // no queue is empty
  std::array<std::uint32_t, kWordsOfAPage> waits_by_place_{};
};

}  // namespace tcs
