// Lets a robot do what robots do, on one engine.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/engines.h"

namespace tcs::zoo {

// What its joints do: nothing, stay where they start by servos, or go each 20 ms to another place.
enum class Manner { kFree, kHeld, kMoved };
inline constexpr std::array kManners = {Manner::kFree, Manner::kHeld, Manner::kMoved};
const char* NameOf(Manner manner);

// Whether it has robots, and tcs was built with it.
bool HasRobots(const EngineTraits& engine);

struct LoadedRobot {
  WorldSpec world;
  double load_s = 0;  // of processor time
  std::vector<std::string> warnings;
  std::string mistake;  // empty: none
};
LoadedRobot LoadRobot(const std::filesystem::path& scenario);

struct Exercise {
  std::string wrong;       // empty: nothing
  double cpu_s = 0;        // of this thread
  std::int64_t steps = 0;  // of the engine
};
Exercise Perform(WorldSpec world, EngineKind engine, Manner manner, VirtualDuration duration);

}  // namespace tcs::zoo
