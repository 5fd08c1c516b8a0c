#include "coordinator/perfetto/misses.h"

#include <fmt/format.h>

#include <variant>

#include "coordinator/explain/explanation.h"
#include "coordinator/explain/told.h"
#include "coordinator/text/csv.h"

namespace tcs::perfetto {

void AddMisses(const std::string& folder, const Schedule& schedule, EventWriter* events) {
  if (!IsFile(folder + "/responses.csv") || !IsFile(folder + "/summary.json")) return;
  const auto read = explain::ReadTold(folder);
  const auto* told = std::get_if<explain::Told>(&read);
  if (told == nullptr) return;
  for (const explain::Activation& one : told->activations) {
    if (one.LateNs() <= 0) continue;
    const Row* row =
        one.thread > 0 ? schedule.Find(fmt::format("{} #{}", one.client, one.thread)) : nullptr;
    if (row == nullptr) row = schedule.Find(one.client);
    if (row == nullptr) continue;
    events->Instant(*row, "missed deadline: " + explain::SentenceOn(one, told->clients),
                    one.release_ns + one.deadline_ns);
  }
}

}  // namespace tcs::perfetto
