#include "coordinator/world/world_topics.h"

#include <algorithm>
#include <variant>

#include "coordinator/dds/measurement_messages.h"
#include "coordinator/dds/ros_messages.h"
#include "coordinator/dds/ros_names.h"
#include "coordinator/world/link_lines.h"

namespace tcs {

namespace {

// On /tf beside the world's transforms, the robots' transforms would no longer be what the robots
// have said.
bool RobotsHaveTransforms(const Scenario& scenario) {
  return std::ranges::any_of(scenario.sensors, [](const SensorChannelSpec& sensor) {
    const auto* to = std::get_if<DdsSensorEnd>(&sensor.to);
    return to != nullptr && to->end.topic == "/tf";
  });
}

}  // namespace

WorldTopics::WorldTopics(const Scenario& scenario, record::MessageSink& sink)
    : sink_(sink), links_(NamesOfLinks(*scenario.world)) {
  for (const BodySpec& body : scenario.world->bodies) {
    bodies_.push_back(body.name);
    topics_.push_back(sink_.AddOwnTopic("/bodies/" + dds::RosToken(body.name),
                                        dds::NameOf(dds::SensorMessage::kOdometry)));
  }
  if (bodies_.empty() && links_.empty()) return;
  transforms_ = sink_.AddOwnTopic(RobotsHaveTransforms(scenario) ? "/world/tf" : "/tf",
                                  dds::NameOf(dds::SensorMessage::kTransforms));
}

void WorldTopics::Write(VirtualTime at, std::span<const BodyState> states,
                        std::span<const LinkState> links) {
  if (transforms_ < 0) return;
  const std::int64_t stamp_ns = sink_.StampOf(at);
  TransformsMeasurement transforms;
  const auto add = [&transforms](const std::string& name, const Pose& pose) {
    transforms.transforms.push_back({"world", name, pose});
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    sink_.WriteOwn(topics_[i], at, dds::ToCdr(dds::ToOdometry(stamp_ns, bodies_[i], states[i])));
    add(bodies_[i], {states[i].position_m, states[i].orientation_xyzw});
  }
  for (std::size_t i = 0; i < links_.size(); ++i) add(links_[i], links[i].pose);
  sink_.WriteOwn(transforms_, at, dds::ToCdr(dds::ToMessage(stamp_ns, transforms)));
}

}  // namespace tcs
