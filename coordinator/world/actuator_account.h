// What was commanded to the robots' joints and rotors, for what there is to say about it at the end
// of the run: what was commanded by several at one instant, never, or beyond what it can do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/channel/channel.h"
#include "shm/virtual_time.h"

namespace tcs {

class ActuatorAccount {
 public:
  // An actuator that `channel` drives, called "rotor 'left' of drone"; the number that it has here.
  // One that another channel drives, too, is the same.
  std::size_t Add(const std::string& name, const std::string& channel);

  // A command that acts from `at` on. It is for an instant that has a command already unless the
  // same sender has computed in between: then only its clock stood still.
  void Take(std::size_t actuator, VirtualTime at, const CommandSender& by = {});
  // It asked for more than the actuator can do, and was given `given`: "1200 rad/s".
  void TakeBeyond(std::size_t actuator, VirtualTime at, const std::string& asked,
                  const std::string& given);

  // A sentence for each actuator and each of the three. An actuator was never commanded only where
  // others of its channel were.
  std::vector<std::string> Complaints() const;

 private:
  struct Actuator {
    std::string name;
    std::vector<std::string> channels;
    std::int64_t commands = 0, again = 0, beyond = 0;
    VirtualTime last{}, first_again{}, first_beyond{};
    CommandSender last_by{};
    std::string asked, given;  // the first time that it was beyond
  };
  bool IsForgotten(const Actuator& actuator) const;

  std::vector<Actuator> actuators_;
};

}  // namespace tcs
