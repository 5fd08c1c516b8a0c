#include "coordinator/explain/told.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "coordinator/text/csv.h"

namespace tcs::explain {

namespace {

using nlohmann::json;

// "core:CLIENT=NS lock:CLIENT=NS"
bool TakeShares(std::string_view whose, Activation* activation) {
  while (!whose.empty()) {
    const std::size_t end = std::min(whose.find(' '), whose.size());
    const std::string_view share = whose.substr(0, end);
    whose.remove_prefix(std::min(end + 1, whose.size()));
    const std::size_t colon = share.find(':'), equals = share.rfind('=');
    if (colon == std::string_view::npos || equals == std::string_view::npos || equals < colon)
      return false;
    const std::optional<std::int64_t> ns = ToInteger(share.substr(equals + 1));
    if (!ns.has_value()) return false;
    auto& of = share.substr(0, colon) == "lock" ? activation->locks : activation->cores;
    of.push_back({std::string(share.substr(colon + 1, equals - colon - 1)), *ns});
  }
  return true;
}

std::optional<Activation> ActivationOf(const CsvFields& fields) {
  Activation activation{.client = std::string(fields[0])};
  const std::array<std::int64_t*, 11> numbers = {
      &activation.thread,      &activation.release_ns, &activation.start_ns, &activation.end_ns,
      &activation.deadline_ns, &activation.queued_ns,  &activation.away_ns,  &activation.wakeup_ns,
      &activation.executed_ns, &activation.room_ns,    &activation.rest_ns};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<std::int64_t> number = ToInteger(fields[i + 1]);
    if (!number.has_value()) return std::nullopt;
    *numbers[i] = *number;
  }
  if (!TakeShares(fields.back(), &activation)) return std::nullopt;
  return activation;
}

template <class T>
T ValueOf(const json& of, const char* key, T otherwise) {
  const auto found = of.find(key);
  return found != of.end() && found->is_number() ? found->get<T>() : otherwise;
}

std::string TextOf(const json& of, const char* key) {
  const auto found = of.find(key);
  return found != of.end() && found->is_string() ? found->get<std::string>() : "";
}

// Empty where there is no such list.
const json& ListOf(const json& of, const char* key) {
  static const json kNone = json::array();
  const auto found = of.find(key);
  return found != of.end() && found->is_array() ? *found : kNone;
}

std::map<std::string, Chain> ReadChains(const json& summary) {
  std::map<std::string, Chain> chains;
  if (!summary.is_object() || !summary.contains("chains")) return chains;
  for (const auto& [name, of] : summary["chains"].items()) {
    if (!of.is_object()) continue;
    Chain& chain = chains[name];
    chain.deadline_ns = ValueOf<std::int64_t>(of, "deadline_ns", 0);
    chain.missed = ValueOf<std::int64_t>(of, "missed", 0);
    if (of.contains("age_ns") && of["age_ns"].is_object())
      chain.commands = ValueOf<std::int64_t>(of["age_ns"], "count", 0);
    for (const json& one : ListOf(of, "worst")) {
      if (!one.is_object()) continue;
      ChainCase& found = chain.worst.emplace_back();
      found.sampled_ns = ValueOf<std::int64_t>(one, "sampled_ns", 0);
      found.acts_ns = ValueOf<std::int64_t>(one, "acts_ns", 0);
      for (const json& hop : ListOf(one, "hops")) {
        if (!hop.is_object()) continue;
        found.hops.push_back(
            {TextOf(hop, "of"), TextOf(hop, "name"), ValueOf<std::int64_t>(hop, "ns", 0)});
      }
    }
  }
  return chains;
}

// Among clients of a robot with `scheduler: edf` a priority says little.
std::optional<std::int64_t> PriorityOf(const json& summary, const json& client) {
  const auto robots = summary.find("robots");
  if (robots != summary.end() && robots->is_object()) {
    const auto robot = robots->find(TextOf(client, "robot"));
    if (robot != robots->end() && robot->is_object() && TextOf(*robot, "scheduler") == "edf")
      return {};
  }
  return ValueOf<std::int64_t>(client, "priority", 0);
}

std::map<std::string, Client> ReadClients(const json& summary) {
  std::map<std::string, Client> clients;
  if (!summary.is_object() || !summary.contains("clients")) return clients;
  for (const auto& [name, of] : summary["clients"].items()) {
    if (!of.is_object()) continue;
    clients[name] = {.priority = PriorityOf(summary, of),
                     .has_deadline = of.contains("deadline") && of["deadline"].is_object(),
                     .counted_after_ns = ValueOf<std::int64_t>(of, "counted_after_ns", -1)};
  }
  return clients;
}

}  // namespace

LoadResult<Told> ReadTold(const std::string& folder) {
  // A run that was cut off has no summary; then nothing is known of priorities.
  const json summary = json::parse(ReadFile(folder + "/summary.json").value_or(""), nullptr, false);
  Told told{.chains = ReadChains(summary), .clients = ReadClients(summary)};
  const bool is_whole = !told.clients.empty();
  const auto read =
      ReadCsv(folder + "/responses.csv",
              {"client", "thread", "release_ns", "start_ns", "end_ns", "deadline_ns", "queued_ns",
               "away_ns", "wakeup_ns", "executed_ns", "room_ns", "rest_ns", "whose"},
              [&](const CsvFields& fields) {
                std::optional<Activation> activation = ActivationOf(fields);
                if (!activation.has_value()) return false;
                Client& client = told.clients[activation->client];
                if (!is_whole && activation->deadline_ns > 0) client.has_deadline = true;
                if (activation->end_ns <= client.counted_after_ns) return true;
                // Nobody expects such a client to keep a period.
                if (!client.has_deadline) activation->deadline_ns = 0;
                told.activations.push_back(std::move(*activation));
                return true;
              });
  if (const auto* error = std::get_if<LoadError>(&read)) {
    return LoadError{error->message +
                     "; it is in the folder of a run by `tcsim run` of this version of tcs"};
  }
  return told;
}

}  // namespace tcs::explain
