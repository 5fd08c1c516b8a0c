#include "coordinator/engine/engine_part.h"

#include "coordinator/engine/wiring.h"

namespace tcs {

EnginePart::EnginePart(Wiring& all) : all_(all), run_(all.run) {}

}  // namespace tcs
