// Commands that have been sent for times before which other commands may still be sent. The queue
// keeps them until no earlier command can come, and then gives them on in the order of their times.
//
// Programs do not wait before they send commands here (shm/own_receivers.h), so the commands come
// in the order in which the programs were dispatched. Commands for one instant stay in the order in
// which they came.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/channel/channel.h"

namespace tcs {

class CommandQueue final : public CommandSink {
 public:
  // `to` outlives this.
  explicit CommandQueue(CommandSink& to) : to_(to) {}

  void Take(std::size_t channel, const CommandSent& sent, const Wrench& wrench) override {
    Add(channel, sent, wrench);
  }
  void Take(std::size_t channel, const CommandSent& sent,
            std::span<const JointGoal> goals) override {
    Add(channel, sent, std::vector<JointGoal>(goals.begin(), goals.end()));
  }
  void Take(std::size_t channel, const CommandSent& sent, const PlanarSpeed& speed) override {
    Add(channel, sent, speed);
  }
  void Take(std::size_t channel, const CommandSent& sent,
            const JointTrajectory& trajectory) override {
    Add(channel, sent, trajectory);
  }
  std::optional<GoalNames> GoalsOf(std::size_t channel) const override {
    return to_.GoalsOf(channel);
  }
  // Refusals and notes act at no time.
  void Refuse(std::size_t channel, const std::string& why) override { to_.Refuse(channel, why); }
  void Note(const std::string& sentence) override { to_.Note(sentence); }

  std::size_t size() const { return kept_.size(); }

  // Gives on the commands that were sent by `until`; `before` is told of each command's time first.
  // False if there was no command.
  bool PassOn(VirtualTime until, const std::function<void(VirtualTime)>& before);

 private:
  using What = std::variant<Wrench, std::vector<JointGoal>, PlanarSpeed, JointTrajectory>;
  struct Kept {
    CommandSent sent;
    std::size_t channel;
    What what;
  };
  static VirtualTime TimeOf(const Kept& kept) { return kept.sent.at; }
  void Add(std::size_t channel, const CommandSent& sent, What what);

  CommandSink& to_;
  std::vector<Kept> kept_;  // in the order of their times
};

}  // namespace tcs
