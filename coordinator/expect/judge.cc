#include "coordinator/expect/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "coordinator/measures/measure.h"
#include "coordinator/text/spoken.h"

namespace tcs {

namespace {

using ExpectJson = nlohmann::json;

std::string ValueText(double value, MeasureUnit unit) {
  switch (unit) {
    case MeasureUnit::kSeconds:
      return std::abs(value) < 1e9 ? Spoken(std::llround(value * 1e9)) : fmt::format("{} s", value);
    case MeasureUnit::kShare:
      return fmt::format("{:.3g} %", value * 100);
    case MeasureUnit::kCount:
      return fmt::format("{:.0f}", value);
    case MeasureUnit::kNumber:
      break;
  }
  return fmt::format("{:.6g}", value);
}

// A value that rounding would make look like the bound is told in full.
std::string ValueBeside(double value, const ExpectationSpec& expected) {
  const std::string text = ValueText(value, expected.unit);
  for (const double limit : {expected.least, expected.most}) {
    if (value != limit && ValueText(limit, expected.unit) == text) {
      const bool is_time = expected.unit == MeasureUnit::kSeconds;
      return fmt::format("{}{}", value, is_time ? " s" : "");
    }
  }
  return text;
}

std::string TimeText(std::int64_t ns) {
  return fmt::format("{:.3f} s", static_cast<double>(ns) * 1e-9);
}

bool IsWithin(double value, const ExpectationSpec& expected) {
  return value >= expected.least && value <= expected.most;
}

const ExpectJson* Member(const ExpectJson& json, const std::string& key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found != json.end() ? &*found : nullptr;
}

std::int64_t TimeIn(const ExpectJson* json, const char* key) {
  const ExpectJson* time = json == nullptr ? nullptr : Member(*json, key);
  return time != nullptr && time->is_number_integer() ? time->get<std::int64_t>() : -1;
}

class Judge {
 public:
  Judge(const std::string& summary, const MetricsOfRun& kept)
      : summary_(ExpectJson::parse(summary, nullptr, false)),
        measures_(MeasuresFromSummary(summary).value_or(Measures())),
        kept_(kept) {}

  [[nodiscard]] Judgement Take(const ExpectationSpec& expected) const {
    return expected.kept ? OfKept(expected) : OfMeasure(expected);
  }

 private:
  [[nodiscard]] Judgement OfKept(const ExpectationSpec& expected) const {
    Judgement judgement{.expected = expected};
    const auto found = kept_.find(std::to_string(*expected.kept));
    if (found == kept_.end() || found->second.count == 0) {
      judgement.what = fmt::format("{} is not known, expected {}: the run has no value of it",
                                   expected.figure, BoundText(expected));
      return judgement;
    }
    const MetricFigures& figures = found->second;
    judgement.value = figures.min;
    judgement.largest = figures.max;
    judgement.first_time_ns = figures.first_time_ns;
    judgement.holds = IsWithin(figures.min, expected) && IsWithin(figures.max, expected);
    judgement.what = fmt::format("{} was between {} and {}, expected {}", expected.figure,
                                 ValueBeside(figures.min, expected),
                                 ValueBeside(figures.max, expected), BoundText(expected));
    if (!judgement.holds) judgement.what += ", first left at " + TimeText(figures.first_time_ns);
    return judgement;
  }

  // A name of a client, a chain, or of a metric, which is alone or under the client that prints it.
  [[nodiscard]] const Measure* Find(const ExpectationSpec& expected) const {
    const std::string& name = expected.measure;
    if (const auto found = measures_.find(name); found != measures_.end()) return &found->second;
    if (!expected.subject.starts_with("metric ")) return nullptr;
    const std::size_t first = name.find('/');
    const std::size_t second = first == std::string::npos ? first : name.find('/', first + 1);
    if (second == std::string::npos) return nullptr;
    const std::string alone = name.substr(second + 1);
    const ExpectJson* metrics = Member(summary_, "metrics");
    const ExpectJson* metric =
        metrics == nullptr ? nullptr : Member(*metrics, alone.substr(0, alone.rfind('.')));
    const ExpectJson* from = metric == nullptr ? nullptr : Member(*metric, "from");
    if (from == nullptr || *from != name.substr(0, second)) return nullptr;
    const auto found = measures_.find(alone);
    return found == measures_.end() ? nullptr : &found->second;
  }

  [[nodiscard]] std::int64_t FirstMiss(const ExpectationSpec& expected) const {
    if (!expected.figure.starts_with("miss")) return -1;
    const std::string of = expected.measure.substr(0, expected.measure.rfind('.'));
    constexpr std::string_view kChain = "chain ";
    const bool is_chain = of.starts_with(kChain);
    const ExpectJson* all = Member(summary_, is_chain ? "chains" : "clients");
    const ExpectJson* one =
        all == nullptr ? nullptr : Member(*all, is_chain ? of.substr(kChain.size()) : of);
    if (one != nullptr && !is_chain) one = Member(*one, "deadline");
    return TimeIn(one, "first_missed_ns");
  }

  [[nodiscard]] std::string WhyUnknown(const ExpectationSpec& expected) const {
    const std::string& figure = expected.figure;
    if (expected.subject.starts_with("metric ")) {
      return figure == "first_time" ? "it did not happen" : "nobody told a value of it";
    }
    if (expected.subject.starts_with("chain ")) {
      return figure.starts_with("miss") || figure == "deadline"
                 ? "it has no deadline, or no command acted"
                 : "no command acted that knows of a sample";
    }
    const std::string of = expected.measure.substr(0, expected.measure.rfind('.'));
    const ExpectJson* clients = Member(summary_, "clients");
    const ExpectJson* client = clients == nullptr ? nullptr : Member(*clients, of);
    const ExpectJson* deadline = client == nullptr ? nullptr : Member(*client, "deadline");
    if (figure.starts_with("miss") || figure == "deadline") {
      return deadline == nullptr || deadline->is_null()
                 ? "it has no deadline"
                 : "no activation was judged by its deadline";
    }
    if (figure.starts_with("command_age")) return "no command of it is known to act";
    for (const char* times : {"response", "start_delay", "execution"}) {
      if (figure.starts_with(times)) return "it has no activation";
    }
    return "the run does not tell of it";
  }

  [[nodiscard]] Judgement OfMeasure(const ExpectationSpec& expected) const {
    Judgement judgement{.expected = expected};
    const Measure* measure = Find(expected);
    // Where no activation was judged, zero misses are not known to be none.
    const bool is_judged =
        !expected.figure.starts_with("miss") || expected.figure == "missed" ||
        measures_.contains(expected.measure.substr(0, expected.measure.rfind('.')) + ".missed");
    if (measure == nullptr || !is_judged) {
      judgement.what = fmt::format("{} is not known, expected {}: {}", expected.figure,
                                   BoundText(expected), WhyUnknown(expected));
      return judgement;
    }
    judgement.value = measure->value;
    judgement.holds = IsWithin(measure->value, expected);
    judgement.what = fmt::format("{} was {}, expected {}", expected.figure,
                                 ValueBeside(measure->value, expected), BoundText(expected));
    judgement.first_time_ns = FirstMiss(expected);
    if (!judgement.holds && judgement.first_time_ns >= 0) {
      judgement.what += ", first at " + TimeText(judgement.first_time_ns);
    }
    return judgement;
  }

  ExpectJson summary_;
  Measures measures_;
  const MetricsOfRun& kept_;
};

}  // namespace

std::string BoundText(const ExpectationSpec& expected) {
  const auto text = [&](double value) { return ValueText(value, expected.unit); };
  if (std::isinf(expected.least)) return "at most " + text(expected.most);
  if (std::isinf(expected.most)) return "at least " + text(expected.least);
  return fmt::format("from {} to {}", text(expected.least), text(expected.most));
}

std::vector<Judgement> JudgeRun(const std::vector<ExpectationSpec>& expectations,
                                const std::string& summary, const MetricsOfRun& kept) {
  std::vector<Judgement> judgements;
  if (expectations.empty()) return judgements;
  const Judge judge(summary, kept);
  for (const ExpectationSpec& expected : expectations) judgements.push_back(judge.Take(expected));
  return judgements;
}

std::vector<const Judgement*> Failed(const std::vector<Judgement>& judgements) {
  std::vector<const Judgement*> failed;
  for (const Judgement& judgement : judgements) {
    if (!judgement.holds) failed.push_back(&judgement);
  }
  std::ranges::stable_sort(failed, {}, [](const Judgement* judgement) {
    return static_cast<std::uint64_t>(judgement->first_time_ns);  // -1, not known, is the last
  });
  return failed;
}

std::string SentenceOf(const Judgement& judgement) {
  return judgement.expected.place + judgement.expected.subject + ": " + judgement.what;
}

}  // namespace tcs
