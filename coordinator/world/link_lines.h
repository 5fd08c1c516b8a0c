// Where the links of models are, as lines of bodies.csv.
#pragma once

#include <string>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// The names there of the links of the world's models, as Dynamics numbers the links: MODEL/LINK, or
// MODEL where the model has only one link.
std::vector<std::string> NamesOfLinks(const WorldSpec& world);

class LinkLines {
 public:
  LinkLines() = default;
  // Lines of all links of the world's models.
  explicit LinkLines(const WorldSpec& world);

  // Appends a line for each link, as it is at dynamics.Now(): the link's frame, in the world.
  void Append(Dynamics& dynamics, std::string* text);
  // The links' states at the last Append.
  const std::vector<LinkState>& states() const { return states_; }

 private:
  std::vector<std::string> names_;
  std::vector<int> links_;
  std::vector<LinkState> states_;  // memory of Append
};

}  // namespace tcs
