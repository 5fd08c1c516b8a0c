// Models that have been in some groups go on in another one.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/island.h"
#include "simbody_bridge/model_group.h"

namespace tcs {

// Where a group's island has come to, and the commands that it has been given.
struct GroupPast {
  const ModelGroup* group = nullptr;
  Island::Node node;
  std::vector<Island::Command> commands;
};

// The start of a group's island.
struct GroupFuture {
  Island::Node start;
  std::vector<Island::Command> commands;  // from its start on
};

// Each model of `group` is in one of `pasts`, which have come to the same time.
GroupFuture GoOn(ModelEngine& engine, const ModelGroup& group, std::span<const GroupPast> pasts);

}  // namespace tcs
