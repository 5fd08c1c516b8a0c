#include "coordinator/dds/topics_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <tuple>

#include "coordinator/os/files.h"
#include "coordinator/text/csv.h"

namespace tcs::dds {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kVersion = 1;

OrderedJson ToJson(const std::optional<VirtualDuration>& duration) {
  return duration ? OrderedJson(duration->ns()) : OrderedJson(nullptr);
}

OrderedJson ToJson(const Qos& qos) {
  return {{"reliability", NameOf(qos.reliability)},
          {"history", NameOf(qos.history)},
          {"depth", qos.depth},
          {"durability", NameOf(qos.durability)},
          {"liveliness", NameOf(qos.liveliness)},
          {"deadline_ns", ToJson(qos.deadline)},
          {"lifespan_ns", ToJson(qos.lifespan)},
          {"lease_ns", ToJson(qos.lease)}};
}

OrderedJson ToJson(const TopicReport& topic) {
  OrderedJson json{{"topic", topic.topic},     {"type", topic.type},
                   {"domain", topic.domain},   {"samples", topic.samples},
                   {"bytes", topic.bytes},     {"first_ns", topic.first_ns},
                   {"last_ns", topic.last_ns}, {"rate_hz", topic.RateHz()},
                   {"drops", topic.drops},     {"endpoints", OrderedJson::array()}};
  for (const EndpointReport& end : topic.endpoints) {
    json["endpoints"].push_back({{"kind", end.kind == EndpointKind::kWriter ? "writer" : "reader"},
                                 {"process", end.process},
                                 {"robot", end.robot},
                                 {"count", end.count},
                                 {"qos", ToJson(end.qos)}});
  }
  return json;
}

// Thrown, as Json::exception is, for a file that is not as above.
struct UnknownName {};

template <class Kind>
Kind ToKind(const Json& json, std::initializer_list<Kind> kinds) {
  for (const Kind kind : kinds) {
    if (json.get<std::string>() == NameOf(kind)) return kind;
  }
  throw UnknownName();
}

std::optional<VirtualDuration> ToDuration(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return VirtualDuration::Nanoseconds(json.get<std::int64_t>());
}

Qos ToQos(const Json& json) {
  Qos qos;
  qos.reliability =
      ToKind(json.at("reliability"), {Reliability::kReliable, Reliability::kBestEffort});
  qos.history = ToKind(json.at("history"), {History::kKeepLast, History::kKeepAll});
  qos.depth = json.at("depth").get<int>();
  qos.durability =
      ToKind(json.at("durability"), {Durability::kVolatile, Durability::kTransientLocal});
  qos.liveliness = ToKind(
      json.at("liveliness"),
      {Liveliness::kAutomatic, Liveliness::kManualByParticipant, Liveliness::kManualByTopic});
  qos.deadline = ToDuration(json.at("deadline_ns"));
  qos.lifespan = ToDuration(json.at("lifespan_ns"));
  qos.lease = ToDuration(json.at("lease_ns"));
  return qos;
}

EndpointReport ToEndpoint(const Json& json) {
  const auto kind = json.at("kind").get<std::string>();
  if (kind != "writer" && kind != "reader") throw UnknownName();
  return {kind == "writer" ? EndpointKind::kWriter : EndpointKind::kReader,
          json.at("process").get<std::string>(), json.at("robot").get<std::string>(),
          ToQos(json.at("qos")), json.value("count", std::int64_t{1})};
}

TopicReport ToTopic(const Json& json) {
  TopicReport topic;
  json.at("topic").get_to(topic.topic);
  json.at("type").get_to(topic.type);
  json.at("domain").get_to(topic.domain);
  json.at("samples").get_to(topic.samples);
  json.at("bytes").get_to(topic.bytes);
  json.at("first_ns").get_to(topic.first_ns);
  json.at("last_ns").get_to(topic.last_ns);
  json.at("drops").get_to(topic.drops);
  for (const Json& end : json.at("endpoints")) topic.endpoints.push_back(ToEndpoint(end));
  return topic;
}

}  // namespace

double TopicReport::RateHz() const {
  if (samples < 2 || last_ns <= first_ns) return 0;
  return static_cast<double>(samples - 1) / (static_cast<double>(last_ns - first_ns) * 1e-9);
}

std::string WriteTopics(std::vector<TopicReport> topics, const std::string& path) {
  const auto key = [](const TopicReport& t) { return std::tie(t.topic, t.domain, t.type); };
  std::stable_sort(topics.begin(), topics.end(),
                   [&key](const TopicReport& a, const TopicReport& b) { return key(a) < key(b); });
  OrderedJson json{{"version", kVersion}, {"topics", OrderedJson::array()}};
  for (const TopicReport& topic : topics) json["topics"].push_back(ToJson(topic));
  // Names are whatever programs chose.
  return WriteWhole(path, json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
}

LoadResult<std::vector<TopicReport>> ReadTopics(const std::string& folder) {
  const std::string path = folder + "/topics.json";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    return LoadError{"there is no folder '" + folder + "'; give one that tcsim run has written"};
  }
  if (!std::filesystem::exists(path, error)) {
    return LoadError{
        "'" + folder +
        "' has no topics.json: no program of the run used DDS in shared memory, or the run "
        "did not come to its end"};
  }
  const std::optional<std::string> text = ReadFile(path);
  if (!text) return LoadError{path + " is no file that can be read; make the run again"};
  const LoadError damaged{path + " is damaged; make the run again"};
  std::vector<TopicReport> topics;
  try {
    const Json json = Json::parse(*text);
    const int version = json.at("version").get<int>();
    if (version > kVersion) {
      return LoadError{path +
                       " was written by a later tcsim; use that version, or make the run again"};
    }
    for (const Json& topic : json.at("topics")) topics.push_back(ToTopic(topic));
  } catch (const Json::exception&) {
    return damaged;
  } catch (const UnknownName&) {
    return damaged;
  }
  return topics;
}

}  // namespace tcs::dds
