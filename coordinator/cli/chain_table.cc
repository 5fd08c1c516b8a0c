#include "coordinator/cli/chain_table.h"

#include <fmt/format.h>

#include "coordinator/text/spoken.h"
#include "coordinator/text/text_table.h"

namespace tcs {

std::string ChainTable(const std::vector<ChainFigures>& chains) {
  TextTable table({{"chain", false},
                   {"commands"},
                   {"deadline"},
                   {"missed"},
                   {"age p50"},
                   {"p99"},
                   {"max"},
                   {"through", false}});
  bool is_empty = true;
  for (const ChainFigures& chain : chains) {
    if (!chain.is_named && chain.path.size() < 2) continue;
    is_empty = false;
    const auto age = [&](std::int64_t ns) { return chain.age.count() == 0 ? "-" : Spoken(ns); };
    table.Row({chain.name, std::to_string(chain.age.count()),
               chain.deadline_ns > 0 ? Spoken(chain.deadline_ns) : "none",
               chain.deadline_ns > 0 ? std::to_string(chain.missed) : "-",
               age(chain.age.Quantile(0.5)), age(chain.age.Quantile(0.99)), age(chain.age.max()),
               fmt::format("{}", fmt::join(chain.path, ", "))});
  }
  return is_empty ? "" : table.Text();
}

}  // namespace tcs
