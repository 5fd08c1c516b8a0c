// A request that a page can make of a run, in words: "stand", "go", "step 10000000" (nanoseconds),
// "pace 0.5" (0: as fast as it can).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "coordinator/view/control_page.h"

namespace tcs {

struct ControlRequest {
  enum class Kind { kStand, kGo, kStep, kPace } kind = Kind::kGo;
  std::int64_t step_ns = 0;
  double pace = 0;
};

// None where `words` are no request: steps are 1 ns to an hour, paces 0.001 to 1000, or 0.
[[nodiscard]] std::optional<ControlRequest> ParseControlRequest(std::string_view words);

// Notes the request for the run. One call at a time.
void Ask(const ControlRequest& asked, ControlPage* page);

}  // namespace tcs
