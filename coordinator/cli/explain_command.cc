#include "coordinator/cli/explain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/errors/nearest.h"
#include "coordinator/explain/explanation.h"
#include "coordinator/explain/told.h"
#include "coordinator/scenario/duration.h"
#include "coordinator/text/spoken.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

// The activations that there are to choose from: "of 704 activations of hover/controller, which has
// missed 653 of its 656 deadlines".
std::string WhatThereIs(const explain::Told& told, const std::string& client) {
  std::int64_t all = 0, judged = 0, missed = 0;
  for (const explain::Activation& activation : told.activations) {
    if (!client.empty() && activation.client != client) continue;
    ++all;
    judged += activation.deadline_ns > 0;
    missed += activation.LateNs() > 0;
  }
  const std::string of = client.empty() ? "" : " of " + client;
  if (judged == 0)
    return fmt::format("{} activations{}, for none of which there is a deadline", all, of);
  return fmt::format("{} activations{}; of {} that there was a deadline for, {} missed it", all, of,
                     judged, missed == 0 ? "none" : std::to_string(missed));
}

void PrintText(const explain::Told& told, const explain::Choice& choice,
               const std::vector<const explain::Activation*>& chosen) {
  Print("{}\n", WhatThereIs(told, choice.client));
  for (const explain::Activation* activation : chosen) {
    Print("\n{}\n", explain::SentenceOn(*activation, told.clients));
    for (const explain::Part& part : explain::PartsOf(*activation, told.clients))
      Print("{:>12}  {}\n", Spoken(part.ns), part.what);
    if (const explain::Activation* behind = explain::QueuedBehind(told, *activation))
      Print("  the queue goes back to this: {}\n", explain::SentenceOn(*behind, told.clients));
  }
}

// "r/a was between two: the one before had ended at 4.990 s, the next was released at 5.010 s".
void PrintBetween(const explain::Told& told, const explain::Choice& choice) {
  for (const auto& [name, client] : told.clients) {
    if (!choice.client.empty() && name != choice.client) continue;
    std::int64_t before_ns = -1, next_ns = INT64_MAX;
    for (const explain::Activation& one : told.activations) {
      if (one.client != name) continue;
      if (one.end_ns < *choice.at_ns) before_ns = std::max(before_ns, one.end_ns);
      if (one.release_ns > *choice.at_ns) next_ns = std::min(next_ns, one.release_ns);
    }
    const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) / 1e9; };
    Print("{} had nothing to do then{}{}\n", name,
          before_ns < 0 ? ""
                        : fmt::format("; its last work had ended at {:.3f} s", seconds(before_ns)),
          next_ns == INT64_MAX ? "" : fmt::format("; the next came at {:.3f} s", seconds(next_ns)));
  }
}

Json SharesOf(const std::vector<explain::Share>& shares) {
  Json json = Json::array();
  for (const explain::Share& share : shares)
    json.push_back({{"client", share.client}, {"ns", share.ns}});
  return json;
}

void PrintJson(const explain::Told& told, const std::vector<const explain::Activation*>& chosen) {
  Json all = Json::array();
  for (const explain::Activation* one : chosen) {
    Json json = {{"client", one->client},
                 {"thread", one->thread},
                 {"release_ns", one->release_ns},
                 {"start_ns", one->start_ns},
                 {"end_ns", one->end_ns},
                 {"deadline_ns", one->deadline_ns > 0 ? Json(one->deadline_ns) : Json()},
                 {"late_ns", std::max<std::int64_t>(0, one->LateNs())},
                 {"queued_ns", one->queued_ns},
                 {"away_ns", one->away_ns},
                 {"wakeup_ns", one->wakeup_ns},
                 {"executed_ns", one->executed_ns},
                 {"cores", SharesOf(one->cores)},
                 {"locks", SharesOf(one->locks)},
                 {"room_ns", one->room_ns},
                 {"rest_ns", one->rest_ns},
                 {"sentence", explain::SentenceOn(*one, told.clients)}};
    all.push_back(std::move(json));
  }
  Print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
}

int ExplainChain(const explain::Chain& chain, const ExplainArguments& arguments) {
  if (!arguments.at.empty())
    return Fail("--at: of a chain only the worst commands are known; leave it out");
  const std::size_t most = std::min(chain.worst.size(), static_cast<std::size_t>(arguments.worst));
  if (arguments.as_json) {
    Json all = Json::array();
    for (std::size_t i = 0; i < most; ++i) {
      Json hops = Json::array();
      for (const explain::Hop& hop : chain.worst[i].hops)
        hops.push_back({{"of", hop.of}, {"name", hop.name}, {"ns", hop.ns}});
      all.push_back({{"sampled_ns", chain.worst[i].sampled_ns},
                     {"acts_ns", chain.worst[i].acts_ns},
                     {"hops", std::move(hops)},
                     {"sentence", explain::SentenceOn(arguments.client, chain, chain.worst[i])}});
    }
    Print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
    return kSucceeded;
  }
  Print("{} commands by {}{}\n", chain.commands, arguments.client,
        chain.deadline_ns > 0
            ? fmt::format("; {} acted on older samples than its deadline allows",
                          chain.missed == 0 ? "none" : std::to_string(chain.missed))
            : ", for which there is no deadline");
  for (std::size_t i = 0; i < most; ++i) {
    Print("\n{}\n", explain::SentenceOn(arguments.client, chain, chain.worst[i]));
    for (const explain::Part& part : explain::PartsOf(chain.worst[i]))
      Print("{:>12}  {}\n", Spoken(part.ns), part.what);
  }
  return kSucceeded;
}

}  // namespace

int ExplainCommand(const ExplainArguments& arguments) {
  explain::Choice choice{.client = arguments.client,
                         .most = static_cast<std::size_t>(arguments.worst)};
  if (!arguments.at.empty()) {
    const auto at = ParseDuration(arguments.at);
    if (const auto* error = std::get_if<LoadError>(&at)) return Fail("--at: " + error->message);
    choice.at_ns = std::get<VirtualDuration>(at).ns();
  }
  const auto read = explain::ReadTold(arguments.folder);
  if (const auto* error = std::get_if<LoadError>(&read)) return Fail(error->message);
  const auto& told = std::get<explain::Told>(read);
  if (const auto chain = told.chains.find(choice.client); chain != told.chains.end())
    return ExplainChain(chain->second, arguments);
  if (!choice.client.empty() && !told.clients.contains(choice.client)) {
    std::vector<std::string> known;
    for (const auto& [name, client] : told.clients) known.push_back(name);
    for (const auto& [name, chain] : told.chains) known.push_back(name);
    return Fail("the run in " + arguments.folder + " has no client or chain '" + choice.client +
                "'; " + Suggest(choice.client, known, "clients and chains"));
  }
  const auto chosen = explain::Choose(told, choice);
  arguments.as_json ? PrintJson(told, chosen) : PrintText(told, choice, chosen);
  if (chosen.empty() && choice.at_ns.has_value() && !arguments.as_json) PrintBetween(told, choice);
  return kSucceeded;
}

}  // namespace tcs
