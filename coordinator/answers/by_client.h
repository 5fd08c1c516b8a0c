// Times of clients, by their numbers. Most activations keep no client's time, and the others keep
// one or two: a short list is faster than a tree.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace tcs {

class ByClient {
 public:
  using Entry = std::pair<int, std::int64_t>;  // client, ns

  ByClient() = default;
  // In the order of clients, each once.
  ByClient(std::initializer_list<Entry> entries) : entries_(entries) {}

  // The client's time, 0 until something is added to it.
  std::int64_t& operator[](int client) {
    const auto place = std::ranges::lower_bound(entries_, client, {}, &Entry::first);
    if (place != entries_.end() && place->first == client) return place->second;
    return entries_.insert(place, {client, 0})->second;
  }
  std::int64_t TotalNs() const {
    std::int64_t total_ns = 0;
    for (const auto& [client, ns] : entries_) total_ns += ns;
    return total_ns;
  }
  void DropZeros() {
    std::erase_if(entries_, [](const Entry& entry) { return entry.second == 0; });
  }

  bool empty() const { return entries_.empty(); }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  auto begin() { return entries_.begin(); }
  auto end() { return entries_.end(); }
  bool operator==(const ByClient&) const = default;

 private:
  std::vector<Entry> entries_;  // in the order of clients
};

}  // namespace tcs
