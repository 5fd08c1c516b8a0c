#include "shm/check.h"
#include "tests/bench/model_work.h"

namespace tcs::bench {

bool HasMujoco() { return false; }

double BareMujocoSeconds(const ModelWork&) {
  TCS_CHECK(false);
  return 0;
}

}  // namespace tcs::bench
