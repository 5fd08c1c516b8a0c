#include "coordinator/cli/client_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/text/spoken.h"
#include "coordinator/text/text_table.h"

namespace tcs {

std::string ClientTable(const std::vector<ClientReport>& clients) {
  TextTable table({{"client", false},
                   {"computed"},
                   {"activations"},
                   {"deadline"},
                   {"missed"},
                   {"response p99"},
                   {"max"},
                   {"oldest data"}});
  const auto time = [](const Distribution& of, std::int64_t ns) {
    return of.count() == 0 ? "-" : Spoken(ns);
  };
  for (const ClientReport& c : clients) {
    const ClientFigures& f = c.figures;
    std::int64_t oldest_ns = f.command_age.max();
    bool has_data = f.command_age.count() > 0;
    for (const InputFigures& input : f.inputs) {
      has_data = has_data || input.age.count() > 0;
      oldest_ns = std::max(oldest_ns, input.age.max());
    }
    const bool judged = f.deadline.judged > 0;
    table.Row({c.name, fmt::format("{:.3f} s", static_cast<double>(c.usage.charged_ns) * 1e-9),
               std::to_string(c.usage.activations),
               f.deadline.deadline_ns > 0 ? Spoken(f.deadline.deadline_ns) : "none",
               judged ? fmt::format("{} of {}", f.deadline.missed, f.deadline.judged) : "-",
               time(f.times.response, f.times.response.Quantile(0.99)),
               time(f.times.response, f.times.response.max()), has_data ? Spoken(oldest_ns) : "-"});
  }
  return table.Text();
}

}  // namespace tcs
