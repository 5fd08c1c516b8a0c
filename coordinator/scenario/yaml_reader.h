// Reading a YAML tree so that every mistake becomes one sentence with its place.
//
// Internal to the loader: a mistake is thrown as ScenarioMistake, which LoadScenario catches. A
// value knows where it stands: its line, and its name as a dotted path from the scenario's top
// ("bodies.predator.mass").
#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shm/virtual_time.h"

namespace tcs {

struct ScenarioMistake {
  std::string message;  // "FILE:LINE: …"
};

class YamlMap;

class YamlValue {
 public:
  // `line` counts from 1. An empty name is the scenario itself.
  YamlValue(std::string file, std::string name, int line, YAML::Node node);

  const std::string& name() const { return name_; }
  int line() const { return line_; }

  // The name for a sentence.
  std::string Described() const { return name_.empty() ? "the scenario" : name_; }

  // The same value, its mistakes reported for another line.
  YamlValue AtLine(int line) const { return YamlValue(file_, name_, line, node_); }

  // Throws "FILE:LINE: NAME SENTENCE".
  [[noreturn]] void Fail(std::string_view sentence) const;
  // Throws "FILE:LINE: SENTENCE".
  [[noreturn]] void FailPlainly(std::string_view sentence) const;

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
  YamlMap AsMap() const;

 private:
  std::string Scalar(std::string_view expected) const;

  std::string file_;
  std::string name_;
  int line_;
  YAML::Node node_;
};

// A map in the order of the file, every key once.
class YamlMap {
 public:
  struct Entry {
    std::string key;
    int key_line;
    YamlValue value;
  };

  YamlMap(YamlValue place, std::vector<Entry> entries);

  const std::vector<Entry>& entries() const& { return entries_; }
  void entries() && = delete;  // a range-for over a temporary would outlive it
  const YamlValue& place() const { return place_; }

  // The mistake is the first key that is not among `known`.
  void AllowOnly(const std::vector<std::string>& known) const;

  // Null if the key is not there.
  const YamlValue* Find(std::string_view key) const;
  const YamlValue& Require(std::string_view key, std::string_view example) const;

 private:
  YamlValue place_;
  std::vector<Entry> entries_;
};

// Parses the YAML `text` of `file`; throws ScenarioMistake if it is not one YAML document.
YamlValue ParseYaml(const std::string& file, const std::string& text);

// Names of bodies, robots, clients and channels become names of files and topics: throws unless
// the key is made of letters, digits, '_', '-' and '.', and does not begin with '.' or '-'.
void CheckName(const YamlMap::Entry& entry);

}  // namespace tcs
