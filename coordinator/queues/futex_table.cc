#include "coordinator/queues/futex_table.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tcs {

std::size_t FutexTable::Hash::operator()(const FutexKey& key) const {
  constexpr std::size_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio: spreads the bits
  return (static_cast<std::size_t>(key.pid) * kOdd ^ key.file) * kOdd ^ key.address;
}

void FutexTable::Enqueue(Thread thread, const FutexKey& word) {
  queues_[word].push_back(thread);
  ++waits_by_place_[PlaceInPage(word.address)];
}

void FutexTable::Dequeue(Thread thread, const FutexKey& word) {
  const auto queue = queues_.find(word);
  if (queue == queues_.end()) return;
  const auto place = std::find(queue->second.begin(), queue->second.end(), thread);
  if (place == queue->second.end()) return;
  queue->second.erase(place);
  if (queue->second.empty()) queues_.erase(queue);
  --waits_by_place_[PlaceInPage(word.address)];
}

void FutexTable::Wait(Thread thread, const FutexKey& word, std::uint32_t bits) {
  WaitForAny(thread, {word}, bits);
  waiting_[thread].is_for_any = false;
}

void FutexTable::WaitForAny(Thread thread, std::vector<FutexKey> words, std::uint32_t bits) {
  for (const FutexKey& word : words) Enqueue(thread, word);
  waiting_[thread] = {.words = std::move(words), .bits = bits, .is_for_any = true};
}

void FutexTable::ExpectLock(Thread thread, const FutexKey& lock) {
  const auto found = waiting_.find(thread);
  if (found != waiting_.end()) found->second.expected_lock = lock;
}

void FutexTable::Leave(Thread thread) {
  const auto found = waiting_.find(thread);
  if (found == waiting_.end()) return;
  for (const FutexKey& word : found->second.words) Dequeue(thread, word);
  waiting_.erase(found);
}

void FutexTable::Move(Thread thread, const FutexKey& from, const FutexKey& to) {
  const auto found = waiting_.find(thread);
  if (found == waiting_.end()) return;
  Waiting& waiting = found->second;
  if (waiting.expected_lock == to) waiting.expected_lock.reset();
  for (FutexKey& word : waiting.words) {
    if (word != from) continue;
    Dequeue(thread, from);
    word = to;
    Enqueue(thread, to);
  }
}

bool FutexTable::WaitsForAny(Thread thread) const {
  const auto found = waiting_.find(thread);
  return found != waiting_.end() && found->second.is_for_any;
}

std::optional<FutexKey> FutexTable::ExpectedLock(Thread thread) const {
  const auto found = waiting_.find(thread);
  return found == waiting_.end() ? std::nullopt : found->second.expected_lock;
}

std::size_t FutexTable::IndexOf(Thread thread, const FutexKey& word) const {
  const auto found = waiting_.find(thread);
  if (found == waiting_.end()) return 0;
  const std::vector<FutexKey>& words = found->second.words;
  const auto place = std::find(words.begin(), words.end(), word);
  return place == words.end() ? 0 : static_cast<std::size_t>(place - words.begin());
}

const FutexKey& FutexTable::WordOf(Thread thread) const {
  return waiting_.at(thread).words.front();
}

const FutexKey* FutexTable::FirstWordOf(Thread thread) const {
  const auto found = waiting_.find(thread);
  return found == waiting_.end() ? nullptr : &found->second.words.front();
}

bool FutexTable::MayBeWaitedAt(std::uint64_t address) const {
  return waits_by_place_[PlaceInPage(address)] != 0;
}

FutexTable::Thread FutexTable::MostUrgent(const FutexKey& word, std::uint32_t bits) const {
  const auto queue = queues_.find(word);
  if (queue == queues_.end()) return kNobody;
  Thread best = kNobody;
  std::int64_t best_priority = 0;
  for (const Thread thread : queue->second) {
    const Waiting& waiting = waiting_.at(thread);
    if ((waiting.bits & bits) == 0 || waiting.expected_lock.has_value()) continue;
    const std::int64_t priority = priority_of_(thread);
    if (best != kNobody && priority <= best_priority) continue;
    best = thread;
    best_priority = priority;
  }
  return best;
}

std::vector<FutexKey> FutexTable::AwaitedWords() const {
  std::vector<FutexKey> words;
  words.reserve(queues_.size());
  for (const auto& [word, waiters] : queues_) words.push_back(word);
  std::sort(words.begin(), words.end(), [](const FutexKey& one, const FutexKey& other) {
    return std::tie(one.pid, one.file, one.address) <
           std::tie(other.pid, other.file, other.address);
  });
  return words;
}

std::vector<FutexTable::Thread> FutexTable::WaitersAt(const FutexKey& word) const {
  const auto queue = queues_.find(word);
  return queue == queues_.end() ? std::vector<Thread>() : queue->second;
}

std::vector<FutexTable::Thread> FutexTable::ByUrgency(const FutexKey& word) const {
  std::vector<Thread> waiters = WaitersAt(word);
  std::stable_sort(waiters.begin(), waiters.end(), [this](Thread one, Thread other) {
    return priority_of_(one) > priority_of_(other);
  });
  return waiters;
}

}  // namespace tcs
