// The mistakes of a scenario, where all of them are asked for and not only the first.
//
// Internal to the loader. A reader that finds one goes on where it can: with the next entry of a
// map, or with a harmless value in the place of one that cannot be read. A thing that depends on a
// wrong part is not held against the user.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/scenario/place.h"

namespace tcs {

struct ScenarioMistake {
  std::string message;  // "FILE:LINE: …" or "--set KEY=VALUE: …"; empty: from another mistake
  Place place = {};
};

class Mistakes {
 public:
  void Add(const ScenarioMistake& mistake);
  // Notes that the part of that name has a mistake for which it was left out.
  void AddMissing(const std::string& name) { missing_.push_back(name); }
  // True if the text may be meant for a part that was left out, or for something in it.
  bool IsOfMissing(std::string_view text) const;

  bool empty() const { return all_.empty(); }
  // The sentences of all mistakes, in the order of the lines of `file`; mistakes in other places
  // follow.
  std::vector<std::string> Sentences(const std::string& file) const;

 private:
  std::vector<ScenarioMistake> all_;
  std::vector<std::string> missing_;
};

}  // namespace tcs
