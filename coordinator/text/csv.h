// Reading of the tables that a run writes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/errors/load_error.h"

namespace tcs {

using CsvFields = std::vector<std::string_view>;

// Calls `take` for each line with its fields under `columns`, in that order; it returns false for a
// line that it cannot use. Whole lines only: a last one without its end may have been cut off.
// Returns how many lines were of no use, or one sentence if the file cannot be read or lacks a
// column.
[[nodiscard]] LoadResult<std::int64_t> ReadCsv(const std::string& path,
                                               const std::vector<std::string_view>& columns,
                                               const std::function<bool(const CsvFields&)>& take);

// The fields of a line, which is without its end.
void SplitCsv(std::string_view line, CsvFields* fields);

// None unless all of `text` is one finite number.
[[nodiscard]] std::optional<double> ToReal(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> ToInteger(std::string_view text);

[[nodiscard]] bool IsFile(const std::string& path);

// The whole file; none if it cannot be read.
[[nodiscard]] std::optional<std::string> ReadFile(const std::string& path);

}  // namespace tcs
