#include "coordinator/dds/topics_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "coordinator/text/text_table.h"

namespace tcs::dds {
namespace {

// "100 Hz", "0.5 Hz", "99.97 Hz".
std::string RateText(double hz) { return hz == 0 ? "-" : fmt::format("{:.4g} Hz", hz); }

std::string DurationText(VirtualDuration duration) {
  constexpr std::array<std::pair<std::int64_t, const char*>, 4> kUnits = {
      {{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "us"}, {1, "ns"}}};
  for (const auto& [ns, unit] : kUnits) {
    if (duration.ns() % ns == 0) return fmt::format("{}{}", duration.ns() / ns, unit);
  }
  return {};
}

// "tcsim, hunter/planner x2"; "-" for nobody.
std::string Who(const TopicReport& topic, EndpointKind kind) {
  std::vector<std::pair<std::string, std::int64_t>> processes;
  for (const EndpointReport& end : topic.endpoints) {
    if (end.kind != kind) continue;
    const auto same = std::find_if(processes.begin(), processes.end(),
                                   [&](const auto& p) { return p.first == end.process; });
    if (same == processes.end()) {
      processes.emplace_back(end.process, end.count);
    } else {
      same->second += end.count;
    }
  }
  std::string text;
  for (const auto& [name, count] : processes) {
    text += (text.empty() ? "" : ", ") + name + (count > 1 ? fmt::format(" x{}", count) : "");
  }
  return text.empty() ? "-" : text;
}

std::string QosText(const Qos& qos) {
  std::string text = NameOf(qos.reliability) + ", " + NameOf(qos.history);
  if (qos.history == History::kKeepLast) text += fmt::format(" {}", qos.depth);
  text += ", " + NameOf(qos.durability);
  if (qos.liveliness != Liveliness::kAutomatic) text += ", " + NameOf(qos.liveliness);
  if (qos.deadline) text += ", deadline " + DurationText(*qos.deadline);
  if (qos.lifespan) text += ", lifespan " + DurationText(*qos.lifespan);
  if (qos.lease) text += ", lease " + DurationText(*qos.lease);
  return text;
}

constexpr const char* kSimulation = "tcsim";

// A reader that `tcsim run --record` adds reads everything, and is nobody's other end.
bool IsRecorder(const EndpointReport& end) {
  return end.kind == EndpointKind::kReader && end.process == kSimulation &&
         end.qos.history == History::kKeepAll;
}

// The process of the first endpoint at that end of the topic; none: there is no endpoint.
std::optional<std::string> FirstAt(const TopicReport& topic, EndpointKind kind) {
  for (const EndpointReport& end : topic.endpoints) {
    if (end.kind == kind && !IsRecorder(end)) return end.process;
  }
  return std::nullopt;
}

// Why the reader of a topic that nobody writes may have been meant for the topic `other`.
std::optional<std::string> WhyApart(const TopicReport& topic, const std::string& reader,
                                    const TopicReport& other) {
  const auto writer = FirstAt(other, EndpointKind::kWriter);
  if (!writer) return std::nullopt;
  const bool is_ours = (reader == kSimulation) != (*writer == kSimulation);
  if (other.domain != topic.domain) {
    if (!is_ours || other.topic != topic.topic || other.type != topic.type) return std::nullopt;
    return fmt::format(
        "{}: {} reads it in domain {}, but {} writes it in domain {}, so no sample arrives; use "
        "one "
        "domain at both ends (ROS_DOMAIN_ID of programs, `domain` of channels)",
        topic.topic, reader, topic.domain, *writer, other.domain);
  }
  if (other.topic == topic.topic) {
    return fmt::format(
        "{}: {} reads {} there, but {} writes {}, so no sample arrives; use one type at both ends",
        topic.topic, reader, topic.type, *writer, other.type);
  }
  if (!is_ours || other.type != topic.type || FirstAt(other, EndpointKind::kReader)) {
    return std::nullopt;
  }
  return fmt::format(
      "{}: {} reads it, and no program writes it; {}: {} writes it with the same type, and no "
      "program reads it; if they belong together, use one name",
      topic.topic, reader, other.topic, *writer);
}

}  // namespace

std::string TopicsTable(const std::vector<TopicReport>& topics, bool with_qos) {
  const bool has_domains =
      std::any_of(topics.begin(), topics.end(), [](const TopicReport& t) { return t.domain != 0; });
  std::vector<TextColumn> columns = {{"topic", false}, {"type", false}};
  if (has_domains) columns.push_back({"domain"});
  columns.insert(columns.end(), {{"samples"}, {"rate"}, {"drops"}});
  columns.insert(columns.end(), {{"writers", false}, {"readers", false}});
  TextTable table(columns);
  for (const TopicReport& t : topics) {
    std::vector<std::string> cells = {t.topic, t.type};
    if (has_domains) cells.push_back(std::to_string(t.domain));
    cells.insert(cells.end(),
                 {std::to_string(t.samples), RateText(t.RateHz()), std::to_string(t.drops),
                  Who(t, EndpointKind::kWriter), Who(t, EndpointKind::kReader)});
    table.Row(std::move(cells));
    if (!with_qos) continue;
    for (const EndpointReport& end : t.endpoints) {
      table.Note(fmt::format(
          "    {} {}{}: {}", end.kind == EndpointKind::kWriter ? "writer" : "reader", end.process,
          end.count > 1 ? fmt::format(" x{}", end.count) : "", QosText(end.qos)));
    }
  }
  return table.Text();
}

std::vector<std::string> TopicWarnings(const std::vector<TopicReport>& topics) {
  std::vector<std::string> warnings;
  for (const TopicReport& topic : topics) {
    if (topic.drops > 0) {
      warnings.push_back(fmt::format("{}: {} samples did not reach a reader that matched",
                                     topic.topic, topic.drops));
    }
  }
  const std::vector<std::string> mismatches = MismatchWarnings(topics);
  warnings.insert(warnings.end(), mismatches.begin(), mismatches.end());
  return warnings;
}

std::vector<std::string> MismatchWarnings(const std::vector<TopicReport>& topics) {
  std::vector<std::string> warnings;
  for (const TopicReport& topic : topics) {
    for (const EndpointReport& reader : topic.endpoints) {
      if (reader.kind != EndpointKind::kReader || IsRecorder(reader)) continue;
      std::string why;
      bool has_match = false;
      for (const EndpointReport& writer : topic.endpoints) {
        if (writer.kind != EndpointKind::kWriter) continue;
        const auto mismatch = WhatDoesNotMatch(reader.qos, writer.qos);
        has_match = has_match || !mismatch;
        if (mismatch && why.empty()) why = *mismatch + " by " + writer.process;
      }
      if (has_match || why.empty()) continue;
      warnings.push_back(fmt::format("{}: the reader of {} gets nothing: it {}", topic.topic,
                                     reader.process, why));
    }
    const auto reader = FirstAt(topic, EndpointKind::kReader);
    if (!reader || FirstAt(topic, EndpointKind::kWriter)) continue;
    for (const TopicReport& other : topics) {
      if (&other == &topic) continue;
      if (const auto why = WhyApart(topic, *reader, other)) warnings.push_back(*why);
    }
  }
  return warnings;
}

}  // namespace tcs::dds
