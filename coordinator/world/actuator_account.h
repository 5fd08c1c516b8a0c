// The account of the commands to the robots' joints and rotors. At the end of the run it says which
// actuators were commanded several times at one instant, never, or beyond what they can do.
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
  // Adds an actuator that `channel` drives, called "rotor 'left' of drone", and returns its number
  // here. An actuator that another channel drives, too, keeps its number.
  std::size_t Add(const std::string& name, const std::string& channel);

  // A command that acts from `at` on. The command counts as a second one for its instant, unless
  // the same sender has computed in between: then only the sender's clock stood still.
  void Take(std::size_t actuator, VirtualTime at, const CommandSender& by = {});
  // A command asked for more than the actuator can do, and was given `given`: "1200 rad/s".
  void TakeBeyond(std::size_t actuator, VirtualTime at, const std::string& asked,
                  const std::string& given);

  // A sentence for each actuator and each of the three cases. An actuator counts as never commanded
  // only where others of its channel were commanded.
  std::vector<std::string> Complaints() const;

 private:
  struct Actuator {
    std::string name;
    std::vector<std::string> channels;
    std::int64_t commands = 0, again = 0, beyond = 0;
    VirtualTime last{}, first_again{}, first_beyond{};
    CommandSender last_by{};
    std::string asked, given;  // in the first command beyond
  };
  bool IsForgotten(const Actuator& actuator) const;

  std::vector<Actuator> actuators_;
};

}  // namespace tcs
