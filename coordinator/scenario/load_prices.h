// Lists of prices as files: what a computer takes for work of which tcs spares its programs
// (coordinator/prices/price_list.h, docs/SCENARIO.md).
#pragma once

#include <string>

#include "coordinator/errors/load_error.h"
#include "coordinator/prices/price_list.h"

namespace tcs {

// The list in the YAML file `path`; or one sentence, with the place.
[[nodiscard]] LoadResult<PriceList> LoadPriceFile(const std::string& path);

}  // namespace tcs
