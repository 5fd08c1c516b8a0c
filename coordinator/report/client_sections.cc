// The clients: how long their activations took, and what they were charged.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "coordinator/report/response_figure.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// The clients of all systems, by name; the value: is the client periodic?
std::map<std::string, bool> Clients(const Results& results) {
  std::map<std::string, bool> clients;
  for (const System& system : results.systems) {
    for (const Run& run : system.runs) {
      for (const auto& [name, client] : run.clients) clients[name] = client.is_periodic;
    }
  }
  return clients;
}

double MeanOver(const System& system, const std::string& name, std::int64_t Client::*member) {
  double sum = 0;
  int runs = 0;
  for (const Run& run : system.runs) {
    const auto found = run.clients.find(name);
    if (found == run.clients.end()) continue;
    sum += static_cast<double>(found->second.*member);
    ++runs;
  }
  return runs == 0 ? 0 : sum / runs;
}

}  // namespace

std::optional<Figure> ResponseTimes(const Results& results) {
  std::vector<ResponseGroup> groups;
  std::vector<std::string> late, none;
  for (const auto& [name, is_periodic] : Clients(results)) {
    ResponseGroup group{name, {}};
    bool has_deadline = false;
    for (std::size_t i = 0; i < results.systems.size(); ++i) {
      const System& system = results.systems[i];
      ResponseRow row{results.systems.size() > 1 ? system.name : "", static_cast<int>(i), 0, {}};
      std::int64_t missed = 0, judged = 0;
      for (const Run& run : system.runs) {
        const auto found = run.clients.find(name);
        if (found == run.clients.end()) continue;
        const Client& client = found->second;
        row.values_s.insert(row.values_s.end(), client.responses_s.begin(),
                            client.responses_s.end());
        if (!client.deadline.has_value()) continue;
        row.deadline_s = static_cast<double>(client.deadline->deadline_ns) * 1e-9;
        missed += client.deadline->missed;
        judged += client.deadline->judged;
      }
      has_deadline |= row.deadline_s > 0;
      if (row.values_s.empty()) continue;
      if (missed > 0) {
        late.push_back(fmt::format("{} for {} of {}{}", name, Grouped(missed),
                                   Count(judged, "activation"), InSystem(results, system)));
      }
      group.rows.push_back(std::move(row));
    }
    if (group.rows.empty()) continue;
    if (!has_deadline) none.push_back(name);
    groups.push_back(std::move(group));
  }
  if (groups.empty()) return {};
  std::string sentence = late.empty() ? "Nobody took longer than its deadline allows."
                                      : fmt::format("Longer than the deadline: {}.", Listed(late));
  if (none.size() == groups.size()) sentence = "No client has a deadline.";
  return MakeFigure("response-times", "Response times against deadlines", sentence,
                    "From when the cause was there to the end of the work, in virtual time, of all "
                    "activations that count. Each client has an axis of its own.",
                    [&](int width) { return DrawResponses(groups, width); });
}

std::optional<Section> ClientsSection(const Results& results) {
  if (Clients(results).empty()) return {};
  Table table("Means over the trials.", {{"client", false},
                                         {"system", false},
                                         {"charged"},
                                         {"by price"},
                                         {"its CPU clock"},
                                         {"stolen"},
                                         {"activations"},
                                         {"overruns"}});
  std::pair<double, std::string> most{-1, ""};
  for (const auto& [name, is_periodic] : Clients(results)) {
    for (const System& system : results.systems) {
      const auto mean = [&, &client = name](std::int64_t Client::*member) {
        return MeanOver(system, client, member);
      };
      const double charged = mean(&Client::charged_ns) * 1e-9;
      const double own = mean(&Client::own_clock_ns) * 1e-9;
      const double stolen = mean(&Client::stolen_ns) * 1e-9;
      const double priced = mean(&Client::priced_ns) * 1e-9;
      table.Row({name, system.name, Seconds(charged), Seconds(priced), own < 0 ? "–" : Seconds(own),
                 Seconds(stolen), Plain(mean(&Client::activations)),
                 Plain(mean(&Client::overruns))});
      const double share = charged > 0 ? stolen / charged : 0;
      most = std::max(most, {share, name + InSystem(results, system)});
    }
  }
  std::string sentence = "Nothing was stolen from any client.";
  if (most.first > 0) {
    sentence = fmt::format("The most was stolen from {}: {} of what it was charged.", most.second,
                           Percent(most.first));
  }
  return Section{"What clients were charged",
                 sentence +
                     " Charged is what moved a program's clock; what it is charged by price it did "
                     "not compute "
                     "here; stolen went to others while it ran, and moved nothing.",
                 table.Html(), table.Text()};
}

}  // namespace tcs::report
