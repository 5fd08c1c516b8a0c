// The common base of the engine's parts. The parts are made once, by the wiring, and reach each
// other through it. State that a part keeps for itself is in the part.
//
// For the coordinator's thread only, as are all of the engine's parts.
#pragma once

namespace tcs {

struct RunState;
struct Wiring;

class EnginePart {
 public:
  explicit EnginePart(Wiring& all);
  EnginePart(const EnginePart&) = delete;
  EnginePart& operator=(const EnginePart&) = delete;

 protected:
  ~EnginePart() = default;

  Wiring& all_;
  RunState& run_;
};

}  // namespace tcs
