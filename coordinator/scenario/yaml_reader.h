// Reading a YAML tree so that every mistake becomes one sentence with its place.
//
// Internal to the loader: a mistake is thrown as ScenarioMistake, which LoadScenario catches; where
// all mistakes are asked for (mistakes.h) it is noted there, and what can be read is read on. A
// value knows where it stands: its place, a line of the file or an option of the command line, and
// its name as a dotted path from the scenario's top ("bodies.predator.mass").
#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/scenario/mistakes.h"
#include "coordinator/scenario/place.h"
#include "coordinator/scenario/set_option.h"
#include "shm/virtual_time.h"

namespace tcs {

class YamlMap;

// The state that all values of a file share.
struct YamlReading {
  SetOptions options;            // knows which nodes are not the file's
  Mistakes* mistakes = nullptr;  // null: the first mistake is thrown
};

class YamlValue {
 public:
  // An empty name is the scenario itself.
  YamlValue(Place place, std::string name, YAML::Node node,
            std::shared_ptr<const YamlReading> reading);

  const std::string& name() const { return name_; }
  const Place& place() const { return place_; }

  // The name for a sentence.
  std::string Described() const { return name_.empty() ? "the scenario" : name_; }

  // This value, with its mistakes reported for another place.
  YamlValue At(const Place& place) const { return YamlValue(place, name_, node_, reading_); }

  // Throws "PLACE: NAME SENTENCE".
  [[noreturn]] void Fail(std::string_view sentence) const;
  // Fails about a part of the scenario that this value names; nothing is held against a part that
  // is left out for its own mistake.
  [[noreturn]] void FailAbout(std::string_view part, std::string_view sentence) const;
  // Throws "PLACE: SENTENCE".
  [[noreturn]] void FailPlainly(std::string_view sentence) const;
  // Where all mistakes are asked for, the mistakes that `read` throws are noted, and what `read`
  // has not read is left out. False if there was a mistake.
  template <class Read>
  bool Try(Read read) const {
    Mistakes* mistakes = reading_->mistakes;
    if (mistakes == nullptr) {
      read();
      return true;
    }
    try {
      read();
      return true;
    } catch (const ScenarioMistake& mistake) {
      mistakes->Add(mistake);
      return false;
    }
  }
  // Calls Try for what `read` reads as the part `name` of the scenario.
  template <class Read>
  void TryPart(const std::string& name, Read read) const {
    if (!Try(read)) reading_->mistakes->AddMissing(name);
  }
  // True if there was a mistake until now.
  bool HasMistakes() const { return reading_->mistakes != nullptr && !reading_->mistakes->empty(); }

  std::string AsText() const;
  double AsNumber() const;
  double AsPositiveNumber(std::string_view unit) const;
  double AsNonNegativeNumber(std::string_view unit) const;
  std::int64_t AsInteger(std::int64_t least, std::int64_t most) const;
  std::uint64_t AsUnsigned64() const;
  bool AsBoolean() const;  // true or false
  VirtualDuration AsDuration() const;
  VirtualDuration AsPositiveDuration() const;
  // A list of `size` numbers; `example` shows one.
  std::vector<double> AsNumbers(std::size_t size, std::string_view example) const;
  std::array<double, 3> AsVector3() const;
  // At least one element.
  std::vector<YamlValue> AsList(std::string_view example) const;
  bool IsMap() const { return node_.IsMap(); }
  bool IsList() const { return node_.IsSequence(); }
  bool IsNull() const { return node_.IsNull(); }  // there is none
  YamlMap AsMap() const;

 private:
  std::string Scalar(std::string_view expected) const;
  // The value that `read` gives; where all mistakes are asked for and `read` has one, `harmless`.
  template <class Value, class Read>
  Value OrElse(Value harmless, Read read) const {
    Try([&] { harmless = read(); });
    return harmless;
  }
  // The place of a node in this value; the node is on `line` if it is in the file at all.
  Place PlaceOf(const YAML::Node& node, int line) const;

  Place place_;
  std::string name_;
  YAML::Node node_;
  std::shared_ptr<const YamlReading> reading_;
};

// A map in the order of the file, every key once.
class YamlMap {
 public:
  struct Entry {
    std::string key;
    Place key_place;
    YamlValue value;
  };

  YamlMap(YamlValue place, std::vector<Entry> entries);

  const std::vector<Entry>& entries() const& { return entries_; }
  void entries() && = delete;  // a range-for over a temporary would outlive it
  const YamlValue& place() const { return place_; }

  // Reads each entry, by YamlValue::TryPart.
  template <class Read>
  void ForEach(Read read) const {
    for (const Entry& entry : entries_) {
      place_.TryPart(entry.key, [&] { read(entry); });
    }
  }

  // The mistakes are the keys that are not among `known`.
  void AllowOnly(const std::vector<std::string>& known) const;

  // Null if the key is not there.
  const YamlValue* Find(std::string_view key) const;
  const YamlValue& Require(std::string_view key, std::string_view example) const;

 private:
  YamlValue place_;
  std::vector<Entry> entries_;
};

// The YAML `text` of `file`; throws ScenarioMistake if it is not one YAML document.
YAML::Node ParseDocument(const std::string& file, const std::string& text);

// Parses the YAML `text` of `file` with `settings` applied to it (see set_option.h); throws
// ScenarioMistake also if the text has no such place, or is empty.
YamlValue ParseYaml(const std::string& file, const std::string& text,
                    const std::vector<Setting>& settings, Mistakes* mistakes = nullptr);

// Names of bodies, robots, clients and channels become names of files and topics: throws unless
// the key is made of letters, digits, '_', '-' and '.', and does not begin with '.' or '-'.
void CheckName(const YamlMap::Entry& entry);

}  // namespace tcs
