#include "coordinator/report/read_answers.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tcs::report {

namespace {

using AnswersJson = nlohmann::json;

Quantiles QuantilesOf(const AnswersJson& of, const char* key) {
  const auto found = of.find(key);
  if (found == of.end() || found->is_null()) return {};
  return {found->at("count").get<std::int64_t>(), found->at("p50").get<std::int64_t>(),
          found->at("p99").get<std::int64_t>(), found->at("max").get<std::int64_t>()};
}

// The age of the data that the client's commands were made of; for a client that commands nothing,
// the age of the oldest data that it read.
Quantiles DataAgeOf(const AnswersJson& client) {
  const Quantiles commanded = QuantilesOf(client, "command_age_ns");
  if (commanded.count > 0) return commanded;
  Quantiles oldest;
  for (const AnswersJson& input : client.value("inputs", AnswersJson::array())) {
    const Quantiles read = QuantilesOf(input, "age_ns");
    if (read.count > 0 && read.max_ns >= oldest.max_ns) oldest = read;
  }
  return oldest;
}

void TakeClient(const AnswersJson& entry, Client* client) {
  client->response = QuantilesOf(entry, "response_ns");
  client->data_age = DataAgeOf(entry);
  const auto deadline = entry.find("deadline");
  if (deadline == entry.end() || deadline->is_null()) return;
  client->deadline = {deadline->at("deadline_ns").get<std::int64_t>(),
                      deadline->value("period_of", ""), deadline->at("judged").get<std::int64_t>(),
                      deadline->at("missed").get<std::int64_t>()};
}

}  // namespace

void TakeAnswers(const AnswersJson& summary, Run* run) {
  run->has_answers = summary.contains("verdict");
  run->verdict = summary.value("verdict", std::vector<std::string>());
  run->warnings = summary.value("warnings", std::vector<std::string>());
  for (const AnswersJson& one : summary.value("expectations", AnswersJson::array())) {
    run->expectations.push_back({one.at("subject").get<std::string>(),
                                 one.at("figure").get<std::string>(),
                                 one.at("what").get<std::string>(), one.at("holds").get<bool>()});
  }
  for (auto& [name, client] : run->clients) TakeClient(summary.at("clients").at(name), &client);
  const auto chains = summary.value("chains", AnswersJson::object());
  for (const auto& [name, of] : chains.items()) {
    const AnswersJson& deadline = of.at("deadline_ns");
    run->chains.push_back({name, deadline.is_null() ? 0 : deadline.get<std::int64_t>(),
                           of.at("missed").get<std::int64_t>(), QuantilesOf(of, "age_ns")});
  }
}

}  // namespace tcs::report
