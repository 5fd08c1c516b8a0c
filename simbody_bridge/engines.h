// The engines that there are, and what each can do. Code that asks for something of an engine looks
// here whether the engine has it, and knows no engine by name. make_engine.cc makes the engines.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "simbody_bridge/dynamics.h"

namespace tcs {

struct EngineTraits {
  EngineKind kind;
  std::string_view name;  // in scenarios and results
  bool has_integrators;   // several methods, which choose their steps by an accuracy
  bool has_models;        // joints, contact and friction, not free bodies alone
};

inline constexpr std::array<EngineTraits, 3> kEngines = {{
    {EngineKind::kSimbody, "simbody", true, true},
    {EngineKind::kOde, "ode", false, false},
    {EngineKind::kMujoco, "mujoco", false, true},
}};

constexpr const EngineTraits& TraitsOf(EngineKind kind) {
  return *std::find_if(kEngines.begin(), kEngines.end(),
                       [kind](const EngineTraits& engine) { return engine.kind == kind; });
}

}  // namespace tcs
