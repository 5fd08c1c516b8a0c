// A run's folder as one trace for ui.perfetto.dev: which thread ran when (trace.json), with
// counters of where bodies were and what was commanded, arrows from sends to receives, and what
// programs printed.
#pragma once

#include <string>

namespace tcs::perfetto {

// Writes `path`, JSON that is compressed with gzip. Empty on success, else one sentence.
[[nodiscard]] std::string WriteTrace(const std::string& folder, const std::string& path);

}  // namespace tcs::perfetto
