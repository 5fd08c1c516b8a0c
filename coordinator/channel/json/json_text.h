// JSON written as text rather than built as a tree first: a fleet sends thousands of readings a
// second.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "shm/virtual_time.h"

namespace tcs {

// The number in the fewest digits that read back as the same double, with a point or an exponent,
// because JSON readers of some languages make an integer of a number without both. A number that is
// not finite is null.
void AppendNumber(double value, std::string& text);
void AppendList(std::span<const double> values, std::string& text);

// An object that is written key by key.
class JsonObject {
 public:
  JsonObject() = default;
  // An object whose first key is "time".
  explicit JsonObject(VirtualTime at);

  void Add(std::string_view key, double value);
  void Add(std::string_view key, std::span<const double> values);
  void Add(std::string_view key, const std::string& value);
  // The value is JSON already.
  void AddRaw(std::string_view key, std::string_view value);

  std::string Take() { return std::move(text_) + '}'; }

 private:
  void Begin(std::string_view key);
  std::string text_ = "{";
};

}  // namespace tcs
