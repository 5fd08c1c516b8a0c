// The sections on what happened: the world of each system's first run, the robots in it, and what
// programs said.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/replay.h"

namespace tcs::report {

// HTML of a section: the player, with what it plays. Without a world in any of the replays a
// sentence says so.
[[nodiscard]] std::string WorldSection(const std::vector<Replay>& replays);
// The figure of the first replay that has moments; none: there is no such replay, or nothing moves
// in it.
[[nodiscard]] std::optional<Figure> PathsFigure(const std::vector<Replay>& replays);
[[nodiscard]] std::optional<Figure> MotionFigure(const std::vector<Replay>& replays);
// HTML of a section, of the first replay where there is no script.
[[nodiscard]] std::string SaidSection(const std::vector<Replay>& replays);

}  // namespace tcs::report
