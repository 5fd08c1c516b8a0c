// How programs meet their robot: readings of sensors go out at an Outlet, commands come in at an
// Inlet. A transport carries both: a folder here, and a few lines in open/channels.cc.
//
// Outlets and inlets only carry. world/ decides when a sensor is sampled, what it reads, and when a
// command acts.
//
// Not thread-safe: the coordinator's thread calls outlets and inlets, and none of them waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/inertial.h"
#include "simbody_bridge/measurements.h"
#include "simbody_bridge/model/joint_goal.h"
#include "simbody_bridge/model/joint_trajectory.h"
#include "simbody_bridge/model/wheel_base.h"

namespace tcs {

class DatagramWatch;

struct BodyReading {
  std::string_view name;  // UTF-8; outlives the reading
  BodyState state;        // finite
  InertialReading felt;   // finite, too
};

struct JointReading {
  std::string_view name;  // UTF-8; outlives the reading
  JointState state;       // finite
};

// A sensor's reading at an instant: of bodies, or of the joints of a robot, or what the sensor
// measures itself.
struct Reading {
  VirtualTime at;
  std::vector<BodyReading> bodies;  // as the channel lists them
  std::vector<JointReading> joints{};
  Measurement measured{};
};

// Where the readings of one sensor go out.
class Outlet {
 public:
  virtual ~Outlet() = default;

  // The reading is to arrive at `arrives`, not before the ones sent earlier. True if the reading is
  // out of the outlet's hands: then another part, such as the DDS hub, has it arrive.
  virtual bool Send(const Reading& reading, VirtualTime arrives) = 0;

  // When the next reading that the outlet still has is due; never: it has none.
  virtual VirtualTime NextDue() const = 0;
  // Hands over the readings that are due. True if there was one.
  virtual bool HandOver(VirtualTime now) = 0;

  // How many readings the outlet still has.
  virtual std::size_t Kept() const { return NextDue().IsNever() ? 0 : 1; }

  // At the run's end: why no reading that was sent has reached a program, and how to mend that, as
  // the rest of a sentence that begins with the channel's name. Empty: a reading has, or that
  // cannot be told.
  virtual std::string WhyUnheard() const { return {}; }
  // The same for readings that did not go out, whether or not a program was listening.
  virtual std::string WhatWasLost() const { return {}; }

  // Has the watch, which outlives this, told of each datagram that goes out.
  virtual void TellOf(DatagramWatch&, const std::string& /*channel*/) {}
};

// An end that has been opened, or why it was not: one sentence.
template <class End>
using Opened = std::variant<std::unique_ptr<End>, std::string>;

// The meaning of the numbers in a command without wrenches.
struct GoalNames {
  std::span<const std::string> names;               // JointGoal::joint is an index into it
  JointQuantity quantity = JointQuantity::kEffort;  // of a number that does not name one
  bool are_wheels = false;                          // a command says how fast the robot is to go
  bool follow_trajectories = false;                 // a command is a trajectory
  // The last `followers` of `names` are of joints that follow others: a command may name them, and
  // the sink that takes the command leaves out what it says of them.
  std::size_t followers = 0;

  std::span<const std::string> Driven() const { return names.first(names.size() - followers); }
};

// The thread that has sent a command, and how long it had run by then, what was stolen from it
// included (shm::RunTime). Two commands of the thread have different run times if the thread has
// computed between them, also while its clock stands still (a clock that has shown stolen time
// waits until that much has been computed). `id` 0: not known, firmware or a program outside the
// run.
struct CommandSender {
  std::uint64_t id = 0;
  std::int64_t ran_ns = 0;
  bool operator==(const CommandSender&) const = default;
};

// When a command was sent, and by which thread.
struct CommandSent {
  VirtualTime at;
  CommandSender by;
  CommandSent(VirtualTime sent_at, CommandSender sent_by = {})  // NOLINT: a time is one
      : at(sent_at), by(sent_by) {}
};

// Takes the commands that come in. Channels have the numbers of the scenario's list of command
// channels.
class CommandSink {
 public:
  // A command.
  virtual void Take(std::size_t channel, const CommandSent& sent, const Wrench& wrench) = 0;
  virtual void Take(std::size_t channel, const CommandSent& sent,
                    std::span<const JointGoal> goals) = 0;
  virtual void Take(std::size_t channel, const CommandSent& sent, const PlanarSpeed& speed) = 0;
  virtual void Take(std::size_t channel, const CommandSent& sent,
                    const JointTrajectory& trajectory) = 0;
  // The joints or rotors that the channel drives; none: wrenches are for its body or link.
  virtual std::optional<GoalNames> GoalsOf(std::size_t channel) const = 0;
  // Something that is no command; `why` is a sentence.
  virtual void Refuse(std::size_t channel, const std::string& why) = 0;
  // Something that the user should know at once: a sentence.
  virtual void Note(const std::string& sentence) = 0;

 protected:
  ~CommandSink() = default;
};

// Where commands come in, of one channel or of several.
class Inlet {
 public:
  virtual ~Inlet() = default;

  // A descriptor that is readable once something has come in; -1: the inlet is asked again and
  // again.
  virtual int fd() const = 0;
  // True for one end of a terminal. Bytes that a program writes to the other end are not there at
  // once, but when they are received: so the coordinator receives whenever a program has written to
  // a terminal.
  virtual bool IsTerminal() const { return false; }
  // Gives away what has come in by now, in the order of sending. `now` says which thread has sent
  // it, if that is known.
  virtual void Receive(const CommandSent& now, CommandSink& sink) = 0;
  // Gives away a datagram that did not come in at the descriptor, where that is a datagram socket.
  virtual void Accept(std::string_view /*datagram*/, const CommandSent&, CommandSink&) {}

  // For a sentence about a channel of the inlet: "nothing came in WHERE; let a client MEND".
  struct Place {
    std::string where, mend;
  };
  virtual Place PlaceOf(std::size_t channel) const = 0;

  // As Outlet::TellOf, for each datagram that comes in.
  virtual void TellOf(DatagramWatch&) {}
};

}  // namespace tcs
