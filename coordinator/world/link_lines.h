// Where the links of models are, as lines of bodies.csv.
#pragma once

#include <string>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// What the links of the world's models are called there, as Dynamics numbers them: MODEL/LINK, or
// MODEL where it has only the one.
std::vector<std::string> NamesOfLinks(const WorldSpec& world);

class LinkLines {
 public:
  LinkLines() = default;
  // Of all links of the world's models.
  explicit LinkLines(const WorldSpec& world);

  // A line for each, as they are at dynamics.Now(): the link's frame, in the world.
  void Append(Dynamics& dynamics, std::string* text);
  // As they were then.
  const std::vector<LinkState>& states() const { return states_; }

 private:
  std::vector<std::string> names_;
  std::vector<int> links_;
  std::vector<LinkState> states_;  // memory of Append
};

}  // namespace tcs
