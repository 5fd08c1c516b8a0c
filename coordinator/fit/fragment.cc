#include "coordinator/fit/fragment.h"

#include <fmt/format.h>

#include "coordinator/text/yaml_text.h"

namespace tcs::fit {

namespace {

std::string CostsOf(const Costs& costs) {
  std::string text;
  if (costs.call_ns) text += fmt::format("fixed_call_cost: {}ns", *costs.call_ns);
  if (costs.call_ns && costs.allocation_ns) text += ", ";
  if (costs.allocation_ns) text += fmt::format("fixed_allocation_cost: {}ns", *costs.allocation_ns);
  return "{" + text + "}";
}

// On one line, as a comment has to be.
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

}  // namespace

std::string FragmentOf(const MeasuredRun& run, const std::vector<ClientFit>& fits) {
  std::string text = fmt::format(
      "# What calls and allocations cost each client of {}, measured in {}.\n"
      "# By `tcsim fit`, for `tcsim run SCENARIO --accounting fixed --overlay THIS`.\n",
      OneLine(run.scenario), OneLine(run.folder));
  std::string clients, robot_before;
  for (const ClientFit& fit : fits) {
    const std::size_t slash = fit.client.find('/');
    if (slash == std::string::npos || (!fit.costs.call_ns && !fit.costs.allocation_ns)) continue;
    const std::string robot = fit.client.substr(0, slash);
    if (robot != robot_before) {
      clients += fmt::format("  {}:  # speed {}\n    clients:\n", YamlText(robot),
                             run.clients.at(fit.client).speed);
    }
    robot_before = robot;
    clients +=
        fmt::format("      {}: {}\n", YamlText(fit.client.substr(slash + 1)), CostsOf(fit.costs));
  }
  return text + (clients.empty() ? "robots: {}\n" : "robots:\n" + clients);
}

}  // namespace tcs::fit
