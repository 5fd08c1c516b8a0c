#include "coordinator/world/link_lines.h"

#include <numeric>

#include "coordinator/world/csv_row.h"

namespace tcs {

std::vector<std::string> NamesOfLinks(const WorldSpec& world) {
  std::vector<std::string> names;
  for (const RobotModel& model : world.models) {
    for (const Link& link : model.links) {
      names.push_back(model.links.size() == 1 ? model.name : model.name + "/" + link.name);
    }
  }
  return names;
}

LinkLines::LinkLines(const WorldSpec& world) : names_(NamesOfLinks(world)) {
  links_.resize(names_.size());
  std::iota(links_.begin(), links_.end(), 0);
  states_.resize(names_.size());
}

void LinkLines::Append(Dynamics& dynamics, std::string* text) {
  if (links_.empty()) return;
  dynamics.ReadLinks(dynamics.Now(), links_, states_);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const LinkState& s = states_[i];
    AppendBodiesCsvRow(dynamics.Now(), names_[i], s.pose.position_m, s.pose.orientation_xyzw,
                       s.linear_velocity_mps, s.angular_velocity_radps, text);
  }
}

}  // namespace tcs
