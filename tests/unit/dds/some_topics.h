// A run's topics, for tests.
#pragma once

#include <vector>

#include "coordinator/dds/topics_file.h"

namespace tcs::dds {

inline std::vector<TopicReport> SomeTopics() {
  Qos best_effort;
  best_effort.reliability = Reliability::kBestEffort;
  best_effort.history = History::kKeepAll;
  best_effort.deadline = VirtualDuration::Milliseconds(1500);
  best_effort.lifespan = VirtualDuration::Seconds(2);
  best_effort.lease = VirtualDuration::Nanoseconds(7);
  Qos latched;
  latched.durability = Durability::kTransientLocal;
  latched.liveliness = Liveliness::kManualByTopic;
  TopicReport odom{"/odom", "nav_msgs/msg/Odometry"};
  for (int i = 0; i <= 200; ++i) odom.Count(i * 10'000'000, 716);
  odom.drops = 2;
  odom.endpoints = {{EndpointKind::kWriter, "tcsim", "", {}},
                    {EndpointKind::kReader, "hunter/controller", "hunter", best_effort},
                    {EndpointKind::kReader, "hunter/planner", "hunter", {}},
                    {EndpointKind::kReader, "hunter/planner", "hunter", {}}};
  TopicReport map{"/map", "nav_msgs/msg/Path", 3};
  map.Count(5, 100);
  map.endpoints = {{EndpointKind::kWriter, "hunter/planner", "hunter", latched}};
  return {odom, map};
}

}  // namespace tcs::dds
