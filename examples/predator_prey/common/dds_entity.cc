#include "examples/predator_prey/common/dds_entity.h"

#include <stdexcept>

namespace predator_prey {

dds_return_t CheckDds(dds_return_t result, const std::string& what) {
  if (result < 0) throw std::runtime_error("cannot " + what + ": " + dds_strretcode(result));
  return result;
}

}  // namespace predator_prey
