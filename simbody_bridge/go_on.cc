#include "simbody_bridge/go_on.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace tcs {
namespace {

// The place in `group` of what is at `place` of `other`; none if `group` does not have that model.
std::optional<int> PlaceIn(const ModelGroup& group, const ModelGroup& other, int place) {
  const auto [member, own] = other.Locate(place);
  const int model = other.models()[member];
  if (!group.Has(model)) return {};
  return group.PlaceIn(group.MemberOf(model), own);
}

// Copies the states of the models of `group` that go on from `past`. Returns whether there is any.
bool CopyStates(ModelEngine& engine, const ModelGroup& group, const GroupPast& past,
                std::span<double> into) {
  bool has_any = false;
  for (std::size_t member = 0; member < past.group->models().size(); ++member) {
    const int model = past.group->models()[member];
    if (!group.Has(model)) continue;
    has_any = true;
    engine.CopyModel({past.group->island(), static_cast<int>(member)}, past.node.state,
                     {group.island(), static_cast<int>(group.MemberOf(model))}, into);
  }
  return has_any;
}

void CopyActing(const ModelGroup& group, const GroupPast& past, Island::Node* node) {
  const bool lags = !past.node.remainders.empty();
  if (lags) node->remainders.resize(node->wrenches.size());
  for (std::size_t place = 0; place < past.node.wrenches.size(); ++place) {
    const std::optional<int> here = PlaceIn(group, *past.group, static_cast<int>(place));
    if (!here) continue;
    const auto at = static_cast<std::size_t>(*here);
    node->wrenches[at] = past.node.wrenches[place];
    if (lags) node->remainders[at] = past.node.remainders[place];
  }
}

}  // namespace

GroupFuture GoOn(ModelEngine& engine, const ModelGroup& group, std::span<const GroupPast> pasts) {
  GroupFuture future;
  Island::Node& start = future.start;
  start.at = pasts.front().node.at;
  start.state.resize(engine.StartOf(group.island()).state.size());
  start.wrenches.resize(static_cast<std::size_t>(group.places()));
  start.try_s = std::numeric_limits<double>::infinity();
  for (const GroupPast& past : pasts) {
    if (!CopyStates(engine, group, past, start.state)) continue;
    start.try_s = std::min(start.try_s, past.node.try_s);
    start.changed_at = std::max(start.changed_at, past.node.changed_at);
    CopyActing(group, past, &start);
    for (const Island::Command& command : past.commands) {
      if (command.at < start.at) continue;
      const std::optional<int> here = PlaceIn(group, *past.group, command.place);
      if (here) future.commands.push_back({command.at, *here, command.wrench});
    }
  }
  std::stable_sort(future.commands.begin(), future.commands.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return future;
}

}  // namespace tcs
