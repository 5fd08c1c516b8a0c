// `expect` of a scenario file: the figures that its run has to come to.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/measures/measure.h"
#include "coordinator/scenario/leave_out_later.h"
#include "coordinator/scenario/metric_names.h"
#include "coordinator/scenario/sections.h"

namespace tcs {

namespace {

constexpr std::string_view kBoundExample = "[0.9, 1.1]";

std::vector<std::string> KeysOf(const std::vector<FigureName>& figures) {
  std::vector<std::string> keys;
  for (const FigureName& figure : figures) keys.emplace_back(figure.name);
  return keys;
}

double LoadLimit(const YamlValue& value, MeasureUnit unit) {
  if (unit != MeasureUnit::kSeconds) return value.AsNumber();
  return static_cast<double>(value.AsDuration().ns()) / 1e9;
}

// A single number is the most; of a pair either number may be null.
void LoadBound(const YamlValue& value, ExpectationSpec* expectation) {
  if (!value.IsList()) {
    expectation->most = LoadLimit(value, expectation->unit);
    return;
  }
  const std::vector<YamlValue> pair = value.AsList(kBoundExample);
  if (pair.size() != 2) {
    value.Fail("has " + std::to_string(pair.size()) +
               " limits; give the most, or the least and the most, like " +
               std::string(kBoundExample));
  }
  if (pair[0].IsNull() && pair[1].IsNull()) {
    value.Fail("has no limit; give one or both, like " + std::string(kBoundExample));
  }
  if (!pair[0].IsNull()) expectation->least = LoadLimit(pair[0], expectation->unit);
  if (!pair[1].IsNull()) expectation->most = LoadLimit(pair[1], expectation->unit);
  if (expectation->least > expectation->most) {
    value.Fail("has a least that is more than its most; swap them");
  }
}

double LoadShare(const YamlMap& map) {
  const YamlValue* share = map.Find("share");
  if (share == nullptr) return 1;
  const double value = share->AsPositiveNumber("");
  if (value > 1) share->Fail("is more than 1; give the share of the trials, such as 0.95");
  return value;
}

class ExpectLoader {
 public:
  // `is_whole`: no section before this one has a mistake, so that all names are known.
  ExpectLoader(bool is_whole, bool is_shortened, Scenario* scenario)
      : is_whole_(is_whole), is_shortened_(is_shortened), scenario_(*scenario) {
    if (!scenario->world || !is_whole) return;
    quantities_ = scenario->quantities;
    names_ = std::make_unique<MetricNames>(*scenario, &quantities_);
  }

  void Load(const YamlMap::Entry& entry) {
    const std::size_t space = entry.key.find(' ');
    const std::string word = space == std::string::npos ? "" : entry.key.substr(0, space);
    const std::string name = entry.key.substr(space == std::string::npos ? 0 : space + 1);
    if (word == "body" || word == "joint" || word == "channel") return LoadKept(entry, word, name);
    if (word == "chain") return LoadFigures(entry, FindChain(entry, name), FiguresOfChain());
    if (word == "metric") return LoadFigures(entry, FindMetric(entry, name), FiguresOfMetric());
    if (entry.key == "run") return LoadFigures(entry, "run", FiguresOfRun());
    if (word.empty()) return LoadFigures(entry, FindClient(entry, name), FiguresOfClient());
    entry.value.At(entry.key_place)
        .FailPlainly("expect: '" + word + "' is no kind of thing; " +
                     Suggest(word, {"body", "joint", "channel", "chain", "metric"}, "kinds") +
                     " (a client is named without one, like robot/controller)");
  }

  std::vector<QuantitySpec> TakeQuantities() { return std::move(quantities_); }
  bool HasNames() const { return names_ != nullptr; }

 private:
  [[noreturn]] static void FailAtKey(const YamlMap::Entry& entry, const std::string& part,
                                     const std::string& sentence) {
    entry.value.At(entry.key_place).FailAbout(part, sentence);
  }

  std::vector<std::string> ClientNames() const {
    std::vector<std::string> names;
    for (const RobotSpec& robot : scenario_.robots) {
      for (const ClientSpec& client : robot.clients) names.push_back(client.name);
    }
    return names;
  }

  std::string FindClient(const YamlMap::Entry& entry, const std::string& name) const {
    if (!is_whole_) return name;
    NameOrWhyNot found = FindName(name, ClientNames(), "client");
    if (found.name.empty()) FailAtKey(entry, name, "is unknown: " + found.why_not);
    return found.name;
  }

  // Runs tell of the chain of each pair of a sensor and a command, and of the chains that the
  // scenario names.
  std::string FindChain(const YamlMap::Entry& entry, const std::string& name) const {
    if (!is_whole_) return name;
    std::vector<std::string> known;
    for (const ChainSpec& chain : scenario_.chains) known.push_back(chain.name);
    for (const SensorChannelSpec& sensor : scenario_.sensors) {
      for (const CommandChannelSpec& command : scenario_.commands) {
        known.push_back(sensor.name + "->" + command.name);
      }
    }
    NameOrWhyNot found = FindName(name, known, "chain");
    if (found.name.empty()) FailAtKey(entry, name, "is unknown: " + found.why_not);
    return "chain " + found.name;
  }

  // Nobody knows yet which metrics programs will print.
  std::string FindMetric(const YamlMap::Entry& entry, const std::string& name) const {
    std::vector<std::string> known;
    for (const MetricSpec& metric : scenario_.metrics) known.push_back(metric.name);
    if (!is_whole_ || std::ranges::find(known, name) != known.end()) return name;
    const std::vector<std::string> clients = ClientNames();
    const std::size_t slash = name.find('/', name.find('/') + 1);
    if (name.find('/') != std::string::npos && slash != std::string::npos) {
      const std::string client = name.substr(0, slash);
      if (std::ranges::find(clients, client) != clients.end()) return name;
    }
    if (const auto nearest = Nearest(name, known)) {
      FailAtKey(entry, name,
                "is of a metric that metrics does not have; did you mean '" + *nearest +
                    "'? (one that a program prints: metric ROBOT/CLIENT/" + name + ")");
    }
    return name;
  }

  void LoadFigures(const YamlMap::Entry& entry, const std::string& of,
                   const std::vector<FigureName>& figures) {
    const YamlMap map = entry.value.AsMap();
    std::vector<std::string> keys = KeysOf(figures);
    keys.emplace_back("share");
    map.AllowOnly(keys);
    const double share = LoadShare(map);
    std::size_t before = scenario_.expectations.size();
    for (const YamlMap::Entry& asked : map.entries()) {
      const auto figure = std::ranges::find(figures, asked.key, &FigureName::name);
      if (figure == figures.end()) continue;
      ExpectationSpec expectation = Begin(entry, asked, share);
      expectation.unit = figure->unit;
      expectation.measure = of + "." + asked.key;
      LoadBound(asked.value, &expectation);
      scenario_.expectations.push_back(std::move(expectation));
    }
    CheckSome(entry, before, "{" + std::string(figures.front().name) + ": 0}");
  }

  static ExpectationSpec Begin(const YamlMap::Entry& subject, const YamlMap::Entry& figure,
                               double share) {
    ExpectationSpec expectation;
    expectation.place = figure.key_place.Prefix();
    expectation.subject = subject.key;
    expectation.figure = figure.key;
    expectation.share = share;
    return expectation;
  }

  void CheckSome(const YamlMap::Entry& entry, std::size_t before,
                 const std::string& example) const {
    if (scenario_.expectations.size() > before || !is_whole_) return;
    entry.value.Fail("expects nothing; add a figure and its bound, like " + example);
  }

  // Loads expectations of a body, a joint or a channel, which is looked at all the while.
  void LoadKept(const YamlMap::Entry& entry, const std::string& word, const std::string& name) {
    if (!scenario_.world) {
      FailAtKey(entry, name,
                "is of a world, and there is none; add the key dynamics, or remove it");
    }
    const YamlMap map = entry.value.AsMap();
    std::vector<std::string> options = {"from", "until", "every", "share"};
    if (word == "body") CheckKeys(map, kMotionQuantities, options);
    if (word == "joint") CheckKeys(map, kJointQuantities, options);
    MetricSpec when;
    if (const YamlValue* from = map.Find("from")) when.from = from->AsDuration();
    if (const YamlValue* every = map.Find("every")) when.every = every->AsPositiveDuration();
    if (const YamlValue* until = map.Find("until")) {
      when.until = until->AsDuration();
      if (*when.until < when.from) until->Fail("is before from; correct one of them");
    }
    if (when.from > scenario_.duration && !is_shortened_) {
      scenario_.warnings.push_back(entry.key_place.Prefix() + entry.value.name() +
                                   " begins after the end of the run, so it cannot hold; correct "
                                   "its from, or the duration");
    }
    const double share = LoadShare(map);
    const std::size_t before = scenario_.expectations.size();
    for (const YamlMap::Entry& asked : map.entries()) {
      if (std::ranges::find(options, asked.key) != options.end()) continue;
      ExpectationSpec expectation = Begin(entry, asked, share);
      LoadBound(asked.value, &expectation);
      if (names_ == nullptr) continue;
      MetricSpec metric = when;
      metric.name = std::to_string(scenario_.kept.size());
      metric.least = expectation.least;
      metric.most = expectation.most;
      metric.expression = Named(entry, word, name, asked.key);
      expectation.kept = scenario_.kept.size();
      scenario_.kept.push_back(std::move(metric));
      scenario_.expectations.push_back(std::move(expectation));
    }
    CheckSome(entry, before, word == "joint" ? "{velocity: [-1, 1]}" : "{z: [0.9, 1.1]}");
  }

  template <class Quantities>
  static void CheckKeys(const YamlMap& map, const Quantities& quantities,
                        const std::vector<std::string>& options) {
    std::vector<std::string> keys(quantities.begin(), quantities.end());
    keys.insert(keys.end(), options.begin(), options.end());
    map.AllowOnly(keys);
  }

  Expression Named(const YamlMap::Entry& entry, const std::string& word, const std::string& name,
                   const std::string& quantity) {
    const std::string whole = name + "." + quantity;
    auto parsed = ParseExpression(whole, *names_);
    if (word == "body" && std::holds_alternative<std::string>(parsed)) {
      const auto place = names_->PlaceOf(name);
      if (const auto* why = std::get_if<std::string>(&place)) {
        FailAtKey(entry, name, "is unknown: " + *why);
      }
    }
    if (const auto* why = std::get_if<std::string>(&parsed)) {
      FailAtKey(entry, name, "is unknown: " + *why);
    }
    auto& expression = std::get<Expression>(parsed);
    using Kind = QuantitySpec::Kind;
    const std::vector<std::size_t> needs = expression.Needs();
    const Kind kind = needs.size() == 1 ? quantities_[needs[0]].kind : Kind::kBody;
    const bool is_channel = kind == Kind::kReading || kind == Kind::kCommand;
    if ((word == "channel") != is_channel || (word == "joint") != (kind == Kind::kJoint) ||
        needs.size() != 1) {
      FailAtKey(entry, name, "names '" + whole + "', which is no quantity of a " + word);
    }
    return std::move(expression);
  }

  bool is_whole_, is_shortened_;
  Scenario& scenario_;
  std::vector<QuantitySpec> quantities_;
  std::unique_ptr<MetricNames> names_;
};

}  // namespace

void LoadExpect(const YamlMap& top, bool is_shortened, Scenario* scenario) {
  const YamlValue* value = top.Find("expect");
  if (value == nullptr) return;
  ExpectLoader loader(!value->HasMistakes(), is_shortened, scenario);
  value->AsMap().ForEach([&](const YamlMap::Entry& entry) { loader.Load(entry); });
  if (loader.HasNames()) scenario->quantities = loader.TakeQuantities();
  if (is_shortened) LeaveOutLater(scenario);
}

void LeaveOutLater(Scenario* scenario) {
  scenario->not_judged += std::erase_if(scenario->expectations, [scenario](const auto& one) {
    return one.kept && scenario->kept[*one.kept].from > scenario->duration;
  });
}

}  // namespace tcs
