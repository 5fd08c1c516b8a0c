#include "coordinator/scenario/yaml_reader.h"

#include <yaml-cpp/emitterstyle.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/duration.h"
#include "coordinator/scenario/name.h"

namespace tcs {
namespace {

std::string InQuotes(std::string_view text) { return "'" + std::string(text) + "'"; }

template <class Number>
std::optional<Number> ParseWhole(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// yaml-cpp leaves some nodes without a mark, the empty ones above all.
int LineOf(const YAML::Node& node, int otherwise) {
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? otherwise : mark.line + 1;
}

// Notes where a document that it is told of begins.
class FirstPlace : public YAML::EventHandler {
 public:
  int line() const { return line_; }

  void OnDocumentStart(const YAML::Mark& mark) override { Note(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { NoteNode(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { NoteNode(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    NoteNode(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    NoteNode(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    NoteNode(mark);
  }
  void OnMapEnd() override {}

 private:
  void Note(const YAML::Mark& mark) { line_ = mark.line + 1; }
  // The first thing in a document rather than the line above it.
  void NoteNode(const YAML::Mark& mark) {
    if (!std::exchange(has_node_, true) && !mark.is_null()) Note(mark);
  }

  int line_ = 1;
  bool has_node_ = false;
};

// YAML::LoadAll is not used: it never comes to an end of text that follows a document and is none.
std::optional<int> LineOfSecondDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  FirstPlace first, second;
  if (!parser.HandleNextDocument(first) || !parser.HandleNextDocument(second)) return std::nullopt;
  return second.line();
}

// A text may stand on a later line than its key; of everything else the key's line is the place.
int LineOfValue(const YAML::Node& node, int key_line) {
  return node.IsScalar() ? LineOf(node, key_line) : key_line;
}

// Leaves out the middle of a sentence that a text of the file makes endless: a sentence begins with
// what is wrong and ends with how to mend it. The cuts are between characters of UTF-8.
std::string Readable(std::string_view sentence) {
  constexpr std::size_t kMost = 2'000, kFirst = 1'000, kLast = 500;
  if (sentence.size() <= kMost) return std::string(sentence);
  const auto is_inside = [sentence](std::size_t at) { return (sentence[at] & 0xc0) == 0x80; };
  std::size_t first = kFirst, last = sentence.size() - kLast;
  while (first > 0 && is_inside(first)) --first;
  while (last < sentence.size() && is_inside(last)) ++last;
  return std::string(sentence.substr(0, first)) + " ... " + std::string(sentence.substr(last));
}

}  // namespace

YamlValue::YamlValue(Place place, std::string name, YAML::Node node,
                     std::shared_ptr<const YamlReading> reading)
    : place_(std::move(place)),
      name_(std::move(name)),
      node_(std::move(node)),
      reading_(std::move(reading)) {}

void YamlValue::Fail(std::string_view sentence) const {
  FailPlainly(Described() + " " + std::string(sentence));
}

void YamlValue::FailAbout(std::string_view part, std::string_view sentence) const {
  const Mistakes* mistakes = reading_->mistakes;
  if (mistakes != nullptr && mistakes->IsOfMissing(part)) throw ScenarioMistake{};
  Fail(sentence);
}

void YamlValue::FailPlainly(std::string_view sentence) const {
  const Mistakes* mistakes = reading_->mistakes;
  if (mistakes != nullptr && node_.IsScalar() && mistakes->IsOfMissing(node_.Scalar())) {
    throw ScenarioMistake{};
  }
  throw ScenarioMistake{place_.Prefix() + Readable(sentence), place_};
}

Place YamlValue::PlaceOf(const YAML::Node& node, int line) const {
  if (const std::string* option = reading_->options.OriginOf(node)) return {*option, 0};
  return place_.IsOption() ? place_ : Place{place_.source, line};
}

std::string YamlValue::Scalar(std::string_view expected) const {
  if (node_.IsNull()) Fail("has no value; give " + std::string(expected));
  if (!node_.IsScalar()) {
    Fail(std::string(node_.IsMap() ? "is a map" : "is a list") + "; give " + std::string(expected));
  }
  return node_.Scalar();
}

std::string YamlValue::AsText() const {
  std::string text = Scalar("a text, in quotes if it is empty");
  if (text.find('\0') != std::string::npos) Fail("contains a NUL character; remove it");
  return text;
}

double YamlValue::AsNumber() const {
  return OrElse(1.0, [&] {
    const std::string text = Scalar("a number");
    const auto number = ParseWhole<double>(text);
    if (!number || !std::isfinite(*number)) {
      Fail("is " + InQuotes(text) + "; it must be a finite number");
    }
    return *number;
  });
}

double YamlValue::AsPositiveNumber(std::string_view unit) const {
  return OrElse(1.0, [&] {
    const double number = AsNumber();
    if (!(number > 0)) Fail("is " + node_.Scalar() + "; it must be positive" + std::string(unit));
    return number;
  });
}

double YamlValue::AsNonNegativeNumber(std::string_view unit) const {
  return OrElse(1.0, [&] {
    const double number = AsNumber();
    if (!(number >= 0)) {
      Fail("is " + node_.Scalar() + "; it must not be negative" + std::string(unit));
    }
    return number;
  });
}

std::int64_t YamlValue::AsInteger(std::int64_t least, std::int64_t most) const {
  return OrElse(least, [&] {
    const std::string text = Scalar("a whole number");
    const auto number = ParseWhole<std::int64_t>(text);
    if (!number || *number < least || *number > most) {
      Fail("is " + InQuotes(text) + "; it must be a whole number from " + std::to_string(least) +
           " to " + std::to_string(most));
    }
    return *number;
  });
}

std::uint64_t YamlValue::AsUnsigned64() const {
  return OrElse(std::uint64_t{1}, [&] {
    const std::string text = Scalar("a whole number");
    const auto number = ParseWhole<std::uint64_t>(text);
    if (!number) Fail("is " + InQuotes(text) + "; it must be a whole number from 0 to 2^64 - 1");
    return *number;
  });
}

bool YamlValue::AsBoolean() const {
  return OrElse(false, [&] {
    const std::string text = Scalar("true or false");
    if (text != "true" && text != "false")
      Fail("is " + InQuotes(text) + "; it must be true or false");
    return text == "true";
  });
}

VirtualDuration YamlValue::AsDuration() const {
  return OrElse(VirtualDuration::Nanoseconds(1), [&] {
    const auto result = ParseDuration(Scalar("a duration like 20s or 10ms"));
    if (const auto* error = std::get_if<LoadError>(&result)) {
      FailPlainly(Described() + ": " + error->message);
    }
    return std::get<VirtualDuration>(result);
  });
}

VirtualDuration YamlValue::AsPositiveDuration() const {
  return OrElse(VirtualDuration::Nanoseconds(1), [&] {
    const VirtualDuration duration = AsDuration();
    if (duration <= VirtualDuration{}) Fail("is " + node_.Scalar() + "; it must be longer than 0");
    return duration;
  });
}

std::vector<YamlValue> YamlValue::AsList(std::string_view example) const {
  if (!node_.IsSequence() || node_.size() == 0) {
    Fail(std::string(node_.IsSequence() ? "is an empty list" : "is not a list") +
         "; write it like " + std::string(example));
  }
  std::vector<YamlValue> list;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    const YAML::Node element = node_[i];
    list.emplace_back(PlaceOf(element, LineOf(element, place_.line)),
                      name_ + "[" + std::to_string(i) + "]", element, reading_);
  }
  return list;
}

std::vector<double> YamlValue::AsNumbers(std::size_t size, std::string_view example) const {
  const std::vector<YamlValue> list = AsList(example);
  if (list.size() != size) {
    Fail("has " + std::to_string(list.size()) + " numbers; write " + std::to_string(size) +
         ", like " + std::string(example));
  }
  std::vector<double> numbers;
  for (const YamlValue& element : list) numbers.push_back(element.AsNumber());
  return numbers;
}

std::array<double, 3> YamlValue::AsVector3() const {
  const std::vector<double> numbers = AsNumbers(3, "[0, 0, 0]");
  return {numbers[0], numbers[1], numbers[2]};
}

YamlMap YamlValue::AsMap() const {
  if (!node_.IsMap()) {
    Fail(std::string(node_.IsNull() ? "has no value" : "is not a map") +
         "; give it keys with values, or {} for none");
  }
  std::vector<YamlMap::Entry> entries;
  std::map<std::string, Place> places;
  int previous_line = place_.line;
  for (const auto& pair : node_) {
    const int key_line = LineOf(pair.first, previous_line);
    previous_line = key_line;
    const Place key_place = PlaceOf(pair.second, key_line);
    if (!pair.first.IsScalar()) {
      At(key_place).Fail("has a key that is not a text; write a text");
    }
    const std::string key = pair.first.Scalar();
    const YamlValue value(PlaceOf(pair.second, LineOfValue(pair.second, key_line)),
                          name_.empty() ? key : name_ + "." + key, pair.second, reading_);
    if (const auto [earlier, is_new] = places.try_emplace(key, key_place); !is_new) {
      value.At(key_place).Fail("is given twice, first " + earlier->second.Reference() +
                               "; rename or remove one");
    }
    entries.push_back({key, key_place, value});
  }
  return YamlMap(*this, std::move(entries));
}

YamlMap::YamlMap(YamlValue place, std::vector<Entry> entries)
    : place_(std::move(place)), entries_(std::move(entries)) {}

void YamlMap::AllowOnly(const std::vector<std::string>& known) const {
  for (const Entry& entry : entries_) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    place_.Try([&] {
      entry.value.At(entry.key_place)
          .FailPlainly("unknown key " + InQuotes(entry.key) +
                       (place_.name().empty() ? "" : " in " + place_.name()) + "; " +
                       Suggest(entry.key, known, "keys"));
    });
  }
}

const YamlValue* YamlMap::Find(std::string_view key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

const YamlValue& YamlMap::Require(std::string_view key, std::string_view example) const {
  if (const YamlValue* value = Find(key)) return *value;
  place_.Fail("lacks the key " + InQuotes(key) + "; add it, like " + std::string(example));
}

YAML::Node ParseDocument(const std::string& file, const std::string& text) {
  const int last_line = 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  YAML::Node document;
  std::optional<int> second;
  try {
    document = YAML::Load(text);
    second = LineOfSecondDocument(text);
  } catch (const YAML::Exception& error) {
    const int line = error.mark.is_null() ? last_line : error.mark.line + 1;
    throw ScenarioMistake{Place{file, line}.Prefix() + "this is not valid YAML (" + error.msg +
                          "); indent with spaces, and quote a text that holds : # { } [ or ]"};
  }
  if (second.has_value()) {
    throw ScenarioMistake{Place{file, *second}.Prefix() +
                          "a second YAML document begins here; keep one scenario to a file"};
  }
  return document;
}

YamlValue ParseYaml(const std::string& file, const std::string& text,
                    const std::vector<Setting>& settings, Mistakes* mistakes) {
  const YAML::Node document = ParseDocument(file, text);
  if (document.IsNull()) {
    throw ScenarioMistake{Place{file, 1}.Prefix() +
                          "the scenario is empty; write at least duration and robots"};
  }
  const auto reading = std::make_shared<YamlReading>();
  reading->mistakes = mistakes;
  const YAML::Node tree = reading->options.Apply(document, settings);
  return YamlValue({file, LineOf(document, 1)}, "", tree, reading);
}

void CheckName(const YamlMap::Entry& entry) {
  if (IsName(entry.key)) return;
  entry.value.At(entry.key_place)
      .FailPlainly(InQuotes(entry.key) +
                   " is not a name; use up to 64 letters, digits, '_', '-' and '.'");
}

}  // namespace tcs
