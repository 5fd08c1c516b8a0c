// The clients: how long their activations took, how late they began, what they were charged.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "coordinator/report/histogram_figure.h"
#include "coordinator/report/lateness_figure.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

std::vector<double> All(const System& system, const std::string& client,
                        std::vector<double> ActivationTimes::*member) {
  std::vector<double> all;
  for (const Run& run : system.runs) {
    const auto found = run.clients.find(client);
    if (found == run.clients.end()) continue;
    const std::vector<double>& values = found->second.times.*member;
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

// Of all systems, by name; the value: is it periodic?
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
  HistogramPlot plot{"response time [s]", "s", "activation", {}, {}};
  std::vector<std::string> sentences;
  const std::map<std::string, bool> clients = Clients(results);
  const auto planners = std::count_if(clients.begin(), clients.end(),
                                      [](const auto& client) { return !client.second; });
  for (const auto& [name, is_periodic] : clients) {
    if (is_periodic) continue;
    std::vector<std::string> medians, longest;
    for (std::size_t i = 0; i < results.systems.size(); ++i) {
      const System& system = results.systems[i];
      std::vector<double> response = All(system, name, &ActivationTimes::response_s);
      if (response.empty()) continue;
      const Spread spread = SpreadOf(response);
      const Spread computed = SpreadOf(All(system, name, &ActivationTimes::computed_s));
      medians.push_back(fmt::format("{}{} ({} of computing)", Seconds(spread.median),
                                    InSystem(results, system), Seconds(computed.median)));
      longest.push_back(Seconds(spread.most));
      plot.panels.push_back({planners > 1 ? fmt::format("{}: {}", system.name, name) : system.name,
                             static_cast<int>(i), std::move(response)});
    }
    if (medians.empty()) continue;
    sentences.push_back(fmt::format("The median activation of {} takes {}; the longest {} {}.",
                                    name, Listed(medians), longest.size() > 1 ? "take" : "takes",
                                    Listed(longest)));
  }
  if (plot.panels.empty()) return {};
  return MakeFigure("response-times", "How long planners take",
                    fmt::format("{}", fmt::join(sentences, " ")),
                    "Best-effort clients, from being woken to being idle again, by their own "
                    "clocks. Where the world stands still meanwhile (callback), these go on.",
                    [&](int width) { return DrawHistograms(plot, width); });
}

std::optional<Figure> Lateness(const Results& results) {
  std::vector<LatenessGroup> groups;
  std::vector<std::string> sentences, overruns;
  for (const auto& [name, is_periodic] : Clients(results)) {
    if (!is_periodic) continue;
    LatenessGroup group{name, {}};
    std::vector<std::string> late_by;
    for (std::size_t i = 0; i < results.systems.size(); ++i) {
      const System& system = results.systems[i];
      std::vector<double> late = All(system, name, &ActivationTimes::lateness_s);
      if (late.empty()) continue;
      std::sort(late.begin(), late.end());
      group.rows.push_back({system.name, static_cast<int>(i), Quantile(late, 0.5),
                            Quantile(late, 0.99), late.back()});
      if (late.back() > 0) {
        late_by.push_back(Seconds(late.back(), 2) + InSystem(results, system));
      }
      const double missed = MeanOver(system, name, &Client::overruns);
      if (missed > 0) {
        overruns.push_back(
            fmt::format("{} of {}{}", Plain(missed), name, InSystem(results, system)));
      }
    }
    if (group.rows.empty()) continue;
    sentences.push_back(late_by.empty()
                            ? fmt::format("{} never begins late.", name)
                            : fmt::format("{} begins up to {} late.", name, Listed(late_by)));
    groups.push_back(std::move(group));
  }
  if (groups.empty()) return {};
  sentences.push_back(overruns.empty() ? "No activation overran the next one."
                                       : fmt::format("Overruns in a trial: {}.", Listed(overruns)));
  return MakeFigure("lateness", "How late controllers begin",
                    fmt::format("{}", fmt::join(sentences, " ")),
                    "Periodic clients, from being due to running, in virtual time. The dot is the "
                    "median, the thick line goes to the 99th percentile, the thin one to the most.",
                    [&](int width) { return DrawLateness(groups, width); });
}

std::optional<Section> ClientsSection(const Results& results) {
  if (results.systems.empty()) return {};
  Table table("Means over the trials.", {{"client", false},
                                         {"system", false},
                                         {"charged"},
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
      table.Row({name, system.name, Seconds(charged), own < 0 ? "–" : Seconds(own), Seconds(stolen),
                 Plain(mean(&Client::activations)), Plain(mean(&Client::overruns))});
      const double share = charged > 0 ? stolen / charged : 0;
      most = std::max(most, {share, name + InSystem(results, system)});
    }
  }
  std::string sentence = "Nothing was stolen from any client.";
  if (most.first > 0) {
    sentence = fmt::format("The most was stolen from {}: {} of what it was charged.", most.second,
                           Percent(most.first));
  }
  return Section{
      "The clients",
      sentence +
          " Charged is what moved a program's clock; stolen went to others while it ran, "
          "and moved nothing.",
      table.Html(), table.Text()};
}

}  // namespace tcs::report
