#include "coordinator/trials/record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

// "was made with --drift 1ms, not 2ms"
std::string Differs(const std::string& option, const std::string& before, const std::string& now) {
  if (before == now) return {};
  if (before.empty()) return fmt::format("was made without {} {}", option, now);
  return fmt::format("was made with {} {}{}", option, before, now.empty() ? "" : ", not " + now);
}

Json JsonOf(const Vary& vary) { return {{"key", vary.key}, {"values", vary.values}}; }

Vary VaryOf(const Json& json) {
  return {json.at("key").get<std::string>(), json.at("values").get<std::vector<std::string>>()};
}

std::string KeysOf(const TrialsPlan& plan) {
  std::string keys;
  for (const Vary& vary : plan.vary) keys += (keys.empty() ? "" : " ") + vary.key;
  return keys;
}

}  // namespace

// FNV-1a. It guards against forgetting, not against forging.
std::string HashOfFile(const std::string& path) {
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "re"));
  if (!file) return {};
  std::uint64_t hash = 0xcbf29ce484222325;
  std::array<unsigned char, 65536> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
    for (std::size_t i = 0; i < n; ++i) hash = (hash ^ block[i]) * 0x100000001b3;
  }
  return std::ferror(file.get()) != 0 ? "" : fmt::format("{:016x}", hash);
}

std::string ToJson(const TrialsRecord& record) {
  const TrialsPlan& plan = record.plan;
  Json json{{"scenario", plan.scenario},
            {"name", plan.name},
            {"first_seed", plan.first_seed},
            {"trials", plan.trials},
            {"options",
             {{"sync", plan.options.sync},
              {"accounting", plan.options.accounting},
              {"duration", plan.options.duration},
              {"drift", plan.options.drift},
              {"set", plan.options.set}}},
            {"vary", nullptr},
            {"fingerprint", {{"scenario", record.scenario_hash}, {"programs", record.programs}}}};
  if (plan.vary.size() == 1) json["vary"] = JsonOf(plan.vary.front());
  if (plan.vary.size() > 1) {
    json["vary"] = Json::array();
    for (const Vary& vary : plan.vary) json["vary"].push_back(JsonOf(vary));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::variant<TrialsRecord, std::string> RecordFromJson(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    TrialsRecord record;
    TrialsPlan& plan = record.plan;
    json.at("scenario").get_to(plan.scenario);
    json.at("name").get_to(plan.name);
    json.at("first_seed").get_to(plan.first_seed);
    json.at("trials").get_to(plan.trials);
    const Json& options = json.at("options");
    options.at("sync").get_to(plan.options.sync);
    options.at("accounting").get_to(plan.options.accounting);
    options.at("duration").get_to(plan.options.duration);
    options.at("drift").get_to(plan.options.drift);
    options.at("set").get_to(plan.options.set);
    if (const Json& vary = json.at("vary"); vary.is_array()) {
      for (const Json& one : vary) plan.vary.push_back(VaryOf(one));
    } else if (!vary.is_null()) {
      plan.vary.push_back(VaryOf(vary));
    }
    json.at("fingerprint").at("scenario").get_to(record.scenario_hash);
    json.at("fingerprint").at("programs").get_to(record.programs);
    return record;
  } catch (const Json::exception& error) {
    // The text without the library's number of the error, "[json.exception.parse_error.101] ".
    const std::string what = error.what();
    return what.substr(what.find("] ") + 2);
  }
}

std::string WhatDiffers(const TrialsRecord& before, const TrialsRecord& now) {
  const TrialsPlan& old_plan = before.plan;
  const TrialsPlan& plan = now.plan;
  if (old_plan.scenario != plan.scenario) return "has trials of " + old_plan.scenario;
  if (before.scenario_hash != now.scenario_hash) {
    return "has trials of " + plan.scenario + " as it was before it was changed";
  }
  const auto set = [](const TrialsPlan& p) {
    return fmt::format("{}", fmt::join(p.options.set, " "));
  };
  for (const std::string& difference :
       {Differs("--sync", old_plan.options.sync, plan.options.sync),
        Differs("--accounting", old_plan.options.accounting, plan.options.accounting),
        Differs("--duration", old_plan.options.duration, plan.options.duration),
        Differs("--drift", old_plan.options.drift, plan.options.drift),
        Differs("--set", set(old_plan), set(plan)),
        Differs("--vary", KeysOf(old_plan), KeysOf(plan)),
        Differs("--first-seed", std::to_string(old_plan.first_seed),
                std::to_string(plan.first_seed))}) {
    if (!difference.empty()) return difference;
  }
  return {};
}

std::string ChangedProgram(const TrialsRecord& before, const TrialsRecord& now) {
  for (const auto& [path, hash] : now.programs) {
    const auto found = before.programs.find(path);
    if (found == before.programs.end() || found->second != hash) return path;
  }
  return {};
}

}  // namespace tcs
