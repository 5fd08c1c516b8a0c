#include "coordinator/world/link_lines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numeric>

namespace tcs {

LinkLines::LinkLines(const WorldSpec& world) {
  for (const RobotModel& model : world.models) {
    for (const Link& link : model.links) {
      names_.push_back(model.links.size() == 1 ? model.name : model.name + "/" + link.name);
    }
  }
  links_.resize(names_.size());
  std::iota(links_.begin(), links_.end(), 0);
  states_.resize(names_.size());
}

void LinkLines::Append(Dynamics& dynamics, std::string* text) {
  if (links_.empty()) return;
  dynamics.ReadLinks(dynamics.Now(), links_, states_);
  const double time_s = static_cast<double>(dynamics.Now().ns()) * 1e-9;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const LinkState& s = states_[i];
    *text +=
        fmt::format("{:.9f},{},{},{},{},{}\n", time_s, names_[i], fmt::join(s.pose.position_m, ","),
                    fmt::join(s.pose.orientation_xyzw, ","), fmt::join(s.linear_velocity_mps, ","),
                    fmt::join(s.angular_velocity_radps, ","));
  }
}

}  // namespace tcs
