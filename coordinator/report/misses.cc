#include "coordinator/report/misses.h"

#include <algorithm>

#include "coordinator/explain/explanation.h"
#include "coordinator/text/spoken.h"

namespace tcs::report {

namespace {

// A miss takes about 250 bytes of the page; a mark alone, 20.
constexpr std::size_t kMostExplained = 1'500, kMostMarked = 50'000;

}  // namespace

void AddMisses(const explain::Told& told, Timeline* timeline) {
  std::vector<const explain::Activation*> late;
  for (const explain::Activation& one : told.activations) {
    if (one.LateNs() > 0 && late.size() < kMostMarked) late.push_back(&one);
  }
  std::ranges::stable_sort(late, {},
                           [](const auto* one) { return one->release_ns + one->deadline_ns; });
  for (const explain::Activation* one : late) {
    const auto row = std::ranges::find(timeline->rows, one->client);
    if (row == timeline->rows.end()) continue;
    Miss& miss = timeline->misses.emplace_back();
    miss.row = static_cast<int>(row - timeline->rows.begin());
    miss.released_us = one->release_ns / 1000;
    miss.due_us = (one->release_ns + one->deadline_ns) / 1000;
    miss.ended_us = one->end_ns / 1000;
    if (timeline->misses.size() > kMostExplained) continue;
    miss.sentence = explain::SentenceOn(*one, told.clients);
    for (const explain::Part& part : explain::PartsOf(*one, told.clients))
      miss.parts.emplace_back(Spoken(part.ns), part.what);
  }
}

}  // namespace tcs::report
