// Judgements as summary.json has them, for others and for the judgement over trials.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "coordinator/expect/judge.h"

namespace tcs {

// A list, in the scenario's order: subject, figure, least and most (null: none; seconds for times),
// share, holds, value (null: not known; of a body from `value` to `largest`), first_time_ns (-1:
// none), what, place.
[[nodiscard]] nlohmann::ordered_json ExpectationsJson(const std::vector<Judgement>& judgements);

// The judgements of the text of a summary.json, as far as the list says; empty if it has none.
[[nodiscard]] std::vector<Judgement> ExpectationsFromSummary(const std::string& text);

}  // namespace tcs
