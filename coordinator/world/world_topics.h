// Where the world's bodies and links are, in the run's recording: /bodies/NAME for each body
// (Odometry), and for all bodies and links transforms from the frame "world": on /tf, or, where
// robots have /tf themselves, on /world/tf.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coordinator/record/message_sink.h"
#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

class WorldTopics {
 public:
  // The sink outlives this. The scenario has a world.
  WorldTopics(const Scenario& scenario, record::MessageSink& sink);

  // `states` are those of the world's bodies, `links` those of all its links, at `at`.
  void Write(VirtualTime at, std::span<const BodyState> states, std::span<const LinkState> links);

 private:
  record::MessageSink& sink_;
  std::vector<std::string> bodies_, links_;  // names
  std::vector<int> topics_;                  // of each body
  int transforms_ = -1;
};

}  // namespace tcs
