#include "coordinator/measures/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coordinator/errors/nearest.h"

namespace tcs {

namespace {

using SummaryJson = nlohmann::json;

constexpr double kSecond = 1e9;         // divided by: 5 ms are 0.005, not 0.005000000000000001
constexpr std::size_t kMostNames = 12;  // that a sentence lists

// Of these the quantiles are compared unasked; the others explain them.
bool IsAnswer(std::string_view distribution) {
  return distribution != "start_delay" && distribution != "execution";
}

class MeasureReader {
 public:
  Measures Take(const SummaryJson& summary) {
    TakeRun(summary);
    for (const auto& [name, client] : Members(summary, "clients")) TakeClient(name, client);
    for (const auto& [name, chain] : Members(summary, "chains")) {
      TakeDistributions("chain " + name, chain);
      TakeChain("chain " + name, chain);
    }
    for (const auto& [name, metric] : Members(summary, "metrics")) TakeMetric(name, metric);
    return std::move(measures_);
  }

 private:
  static SummaryJson::object_t Members(const SummaryJson& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_object() ? found->get<SummaryJson::object_t>()
                                                     : SummaryJson::object_t();
  }

  void Add(const std::string& name, double value, MeasureUnit unit, WorseWhen worse,
           bool is_compared) {
    measures_[name] = {value, unit, worse, is_compared};
  }

  void TakeRun(const SummaryJson& summary) {
    for (const char* key : {"drift", "staleness", "virtual", "real"}) {
      const auto found = summary.find(std::string(key) + "_ns");
      if (found == summary.end() || !found->is_number()) continue;
      Add(fmt::format("run.{}", key), found->get<double>() / kSecond, MeasureUnit::kSeconds,
          WorseWhen::kUnknown, false);
    }
    if (const auto found = summary.find("overhead_percent");
        found != summary.end() && found->is_number()) {
      Add("run.overhead", found->get<double>() / 100, MeasureUnit::kShare, WorseWhen::kUnknown,
          false);
    }
  }

  // Each member "WHAT_ns" with quantiles: "response_ns": {"count", "p50", "p99", "max"}.
  void TakeDistributions(const std::string& of, const SummaryJson& entry) {
    if (!entry.is_object()) return;
    for (const auto& [key, value] : entry.items()) {
      if (!value.is_object() || !key.ends_with("_ns") || value.value("count", 0) == 0) continue;
      const std::string what = key.substr(0, key.size() - 3);
      for (const char* figure : {"p50", "p99", "max"}) {
        const auto found = value.find(figure);
        if (found == value.end() || !found->is_number()) continue;
        const bool is_typical = std::string_view(figure) == "p50";
        Add(fmt::format("{}.{}_{}", of, what, figure), found->get<double>() / kSecond,
            MeasureUnit::kSeconds, WorseWhen::kMore,
            IsAnswer(what) || (what == "execution" && is_typical));
      }
    }
  }

  void TakeDeadline(const std::string& of, const SummaryJson& entry) {
    const auto found = entry.find("deadline");
    if (found == entry.end() || !found->is_object()) return;
    const SummaryJson& deadline = *found;
    const double judged = deadline.at("judged").get<double>();
    const double missed = deadline.at("missed").get<double>();
    Add(of + ".misses", missed, MeasureUnit::kCount, WorseWhen::kMore, false);
    // A run of another length has another count.
    if (judged > 0) {
      Add(of + ".missed", missed / judged, MeasureUnit::kShare, WorseWhen::kMore, true);
    }
    Add(of + ".misses_in_a_row", deadline.at("most_in_a_row").get<double>(), MeasureUnit::kCount,
        WorseWhen::kMore, true);
    Add(of + ".deadline", deadline.at("deadline_ns").get<double>() / kSecond, MeasureUnit::kSeconds,
        WorseWhen::kUnknown, false);
  }

  void TakeChain(const std::string& of, const SummaryJson& chain) {
    if (!chain.is_object()) return;
    const auto deadline = chain.find("deadline_ns"), missed = chain.find("missed"),
               age = chain.find("age_ns");
    if (deadline == chain.end() || !deadline->is_number() || missed == chain.end() ||
        !missed->is_number() || age == chain.end() || !age->is_object()) {
      return;
    }
    const double commands = age->value("count", 0.0);
    Add(of + ".misses", missed->get<double>(), MeasureUnit::kCount, WorseWhen::kMore, false);
    if (commands > 0) {
      Add(of + ".missed", missed->get<double>() / commands, MeasureUnit::kShare, WorseWhen::kMore,
          true);
    }
    Add(of + ".deadline", deadline->get<double>() / kSecond, MeasureUnit::kSeconds,
        WorseWhen::kUnknown, false);
  }

  void TakeClient(const std::string& name, const SummaryJson& client) {
    if (!client.is_object()) return;
    TakeDistributions(name, client);
    TakeDeadline(name, client);
    const auto inputs = client.find("inputs");
    if (inputs != client.end() && inputs->is_array() && !inputs->empty()) {
      for (const char* what : {"sent", "received", "lost", "replaced", "unread"}) {
        double sum = 0;
        for (const SummaryJson& input : *inputs) sum += input.value(what, 0.0);
        const bool is_loss =
            std::string_view(what) != "sent" && std::string_view(what) != "received";
        Add(fmt::format("{}.{}", name, what), sum, MeasureUnit::kCount,
            is_loss ? WorseWhen::kMore : WorseWhen::kUnknown, std::string_view(what) == "lost");
      }
      double backlog = 0;
      for (const SummaryJson& input : *inputs) {
        backlog = std::max(backlog, input.value("most_waiting", 0.0));
        TakeDistributions(fmt::format("{} from {}", name, input.value("from", "")), input);
      }
      Add(name + ".backlog", backlog, MeasureUnit::kCount, WorseWhen::kMore, false);
    }
    if (client.contains("charged_ns") && client.at("charged_ns").is_number()) {
      Add(name + ".computed", client.at("charged_ns").get<double>() / kSecond,
          MeasureUnit::kSeconds, WorseWhen::kUnknown, false);
    }
    if (client.contains("activations") && client.at("activations").is_number()) {
      Add(name + ".activations", client.at("activations").get<double>(), MeasureUnit::kCount,
          WorseWhen::kUnknown, false);
    }
  }

  // A scenario asks for one figure of its metric; what a program prints is looked at from all
  // sides.
  void TakeMetric(const std::string& name, const SummaryJson& metric) {
    if (!metric.is_object()) return;
    const std::string asked = metric.value("asked", "");
    for (const auto& [key, value] : metric.items()) {
      if (!value.is_number()) continue;
      if (key == "first_time_ns") {
        Add(name + ".first_time", value.get<double>() / kSecond, MeasureUnit::kSeconds,
            WorseWhen::kUnknown, asked == "first_time_when");
        continue;
      }
      const bool is_one_of_several = key == "last" || key == "mean" || key == "max";
      Add(fmt::format("{}.{}", name, key), value.get<double>(),
          key == "count" ? MeasureUnit::kCount : MeasureUnit::kNumber, WorseWhen::kUnknown,
          asked.empty() ? is_one_of_several : asked == key);
    }
  }

  Measures measures_;
};

// The nearest one, or what there is; of very many an idea.
std::string Instead(std::string_view wanted, const std::vector<std::string>& names,
                    std::string_view what) {
  if (const auto nearest = Nearest(wanted, names)) return "did you mean '" + *nearest + "'?";
  std::string said;
  const std::size_t shown = std::min(names.size(), kMostNames);
  for (std::size_t i = 0; i < shown; ++i) said += (i == 0 ? "" : ", ") + names[i];
  if (names.empty()) return "there is none at all";
  return shown < names.size()
             ? fmt::format("there are {} {}s: {} and so on", names.size(), what, said)
             : fmt::format("there is: {}", said);
}

}  // namespace

const std::vector<FigureName>& FiguresOfClient() {
  using enum MeasureUnit;
  static const std::vector<FigureName> all = {{"misses", kCount},
                                              {"missed", kShare},
                                              {"misses_in_a_row", kCount},
                                              {"deadline", kSeconds},
                                              {"response_p50", kSeconds},
                                              {"response_p99", kSeconds},
                                              {"response_max", kSeconds},
                                              {"start_delay_p50", kSeconds},
                                              {"start_delay_p99", kSeconds},
                                              {"start_delay_max", kSeconds},
                                              {"execution_p50", kSeconds},
                                              {"execution_p99", kSeconds},
                                              {"execution_max", kSeconds},
                                              {"command_age_p50", kSeconds},
                                              {"command_age_p99", kSeconds},
                                              {"command_age_max", kSeconds},
                                              {"sent", kCount},
                                              {"received", kCount},
                                              {"lost", kCount},
                                              {"replaced", kCount},
                                              {"unread", kCount},
                                              {"backlog", kCount},
                                              {"computed", kSeconds},
                                              {"activations", kCount}};
  return all;
}

const std::vector<FigureName>& FiguresOfChain() {
  using enum MeasureUnit;
  static const std::vector<FigureName> all = {
      {"misses", kCount},         {"missed", kShare},         {"deadline", kSeconds},
      {"age_p50", kSeconds},      {"age_p99", kSeconds},      {"age_max", kSeconds},
      {"reaction_p50", kSeconds}, {"reaction_p99", kSeconds}, {"reaction_max", kSeconds}};
  return all;
}

const std::vector<FigureName>& FiguresOfMetric() {
  using enum MeasureUnit;
  static const std::vector<FigureName> all = {
      {"last", kNumber}, {"min", kNumber},  {"max", kNumber},        {"mean", kNumber},
      {"rms", kNumber},  {"count", kCount}, {"first_time", kSeconds}};
  return all;
}

const std::vector<FigureName>& FiguresOfRun() {
  using enum MeasureUnit;
  static const std::vector<FigureName> all = {{"virtual", kSeconds},
                                              {"real", kSeconds},
                                              {"drift", kSeconds},
                                              {"staleness", kSeconds},
                                              {"overhead", kShare}};
  return all;
}

std::optional<Measures> MeasuresFromSummary(const std::string& text) {
  try {
    return MeasureReader().Take(SummaryJson::parse(text));
  } catch (const SummaryJson::exception&) {
    return {};
  }
}

NameOrWhyNot FindName(std::string_view wanted, const std::vector<std::string>& names,
                      std::string_view what) {
  if (std::find(names.begin(), names.end(), wanted) != names.end())
    return {std::string(wanted), {}};
  std::vector<std::string> found;
  for (const std::string& name : names) {
    if (name.size() <= wanted.size() || !name.ends_with(wanted)) continue;
    const char before = name[name.size() - wanted.size() - 1];
    if (before == '/' || before == '.') found.push_back(name);
  }
  if (found.size() == 1) return {found.front(), {}};
  if (found.empty()) {
    return {{}, fmt::format("there is no {} '{}'; {}", what, wanted, Instead(wanted, names, what))};
  }
  return {{}, fmt::format("'{}' may be {} or {}; give the whole name", wanted, found[0], found[1])};
}

}  // namespace tcs
