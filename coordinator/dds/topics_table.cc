#include "coordinator/dds/topics_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tcs::dds {
namespace {

constexpr std::size_t kColumns = 8;
using Row = std::array<std::string, kColumns>;

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

}  // namespace

std::string TopicsTable(const std::vector<TopicReport>& topics, bool with_qos) {
  constexpr std::array<bool, kColumns> kIsNumber = {false, false, true,  true,
                                                    true,  true,  false, false};
  const bool has_domains =
      std::any_of(topics.begin(), topics.end(), [](const TopicReport& t) { return t.domain != 0; });
  std::vector<Row> rows = {
      {"topic", "type", "domain", "samples", "rate", "drops", "writers", "readers"}};
  for (const TopicReport& t : topics) {
    rows.push_back({t.topic, t.type, std::to_string(t.domain), std::to_string(t.samples),
                    RateText(t.RateHz()), std::to_string(t.drops), Who(t, EndpointKind::kWriter),
                    Who(t, EndpointKind::kReader)});
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < kColumns; ++i) {
      if (i == 2 && !has_domains) continue;
      const std::string gap = line.empty() ? "" : "  ";
      line += kIsNumber[i] ? fmt::format("{}{:>{}}", gap, rows[r][i], widths[i])
                           : fmt::format("{}{:<{}}", gap, rows[r][i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
    if (r == 0 || !with_qos) continue;
    for (const EndpointReport& end : topics[r - 1].endpoints) {
      table += fmt::format("    {} {}{}: {}\n",
                           end.kind == EndpointKind::kWriter ? "writer" : "reader", end.process,
                           end.count > 1 ? fmt::format(" x{}", end.count) : "", QosText(end.qos));
    }
  }
  return table;
}

std::vector<std::string> TopicWarnings(const std::vector<TopicReport>& topics) {
  std::vector<std::string> warnings;
  for (const TopicReport& topic : topics) {
    if (topic.drops > 0) {
      warnings.push_back(fmt::format("{}: {} samples did not reach a reader that matched",
                                     topic.topic, topic.drops));
    }
    for (const EndpointReport& reader : topic.endpoints) {
      if (reader.kind != EndpointKind::kReader) continue;
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
  }
  return warnings;
}

}  // namespace tcs::dds
