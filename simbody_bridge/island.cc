#include "simbody_bridge/island.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "simbody_bridge/require.h"

namespace tcs {
namespace {

// Limits of the first step after a change: where changes come at a rate, the next change most
// likely ends the step, and the part beyond would be thrown away.
constexpr std::int64_t kIntervalsAhead = 2;
constexpr VirtualDuration kLeastAhead = VirtualDuration::Milliseconds(1);

// Islands are integrated side by side.
void Count(std::int64_t& what) {
  std::atomic_ref<std::int64_t>(what).fetch_add(1, std::memory_order_relaxed);
}

bool IsEarlier(VirtualTime t, const Island::Command& command) { return t < command.at; }

bool HasSettled(const IslandStep& step) {
  for (std::size_t place = 0; place < step.remainders.size(); ++place) {
    if (!HasSettled(step.wrenches[place], step.remainders[place], step.at)) return false;
  }
  return true;
}

}  // namespace

VirtualDuration LengthOf(const IslandStep& step) {
  if (step.length_s == step.limit.seconds()) return step.limit;
  return VirtualDuration::Nanoseconds(static_cast<std::int64_t>(std::floor(step.length_s * 1e9)));
}

Island::Island(int index, int bodies, IslandEngine& engine, Dynamics::Work& work)
    : index_(index), engine_(engine), work_(work) {
  IslandStart start = engine.StartOf(index);
  frontier_.state = std::move(start.state);
  frontier_.try_s = start.try_s;
  frontier_.wrenches.resize(static_cast<std::size_t>(bodies));
}

Island::Island(int index, Node start, std::vector<Command> commands, IslandEngine& engine,
               Dynamics::Work& work)
    : index_(index),
      engine_(engine),
      work_(work),
      commands_(std::move(commands)),
      frontier_(std::move(start)) {}

// The wrench that acts on the body after all commands for `t` and before.
const Wrench& Island::ActingAfter(VirtualTime t, int place) const {
  auto command = std::upper_bound(commands_.begin(), commands_.end(), t, IsEarlier);
  while (command != commands_.begin()) {
    --command;
    if (command->place == place) return command->wrench;
  }
  return Origin().wrenches[static_cast<std::size_t>(place)];
}

void Island::Apply(int place, const Wrench& wrench, VirtualTime t) {
  Require(t >= Origin().at, "a command cannot act before what is settled");
  const bool changes = !(ActingAfter(t, place) == wrench);
  // The command is kept even where it changes nothing: an earlier command may still come.
  commands_.insert(std::upper_bound(commands_.begin(), commands_.end(), t, IsEarlier),
                   {t, place, wrench});
  if (changes && used_ > 0 && t <= legs_[used_ - 1].to) TakeBackTo(t);
}

void Island::TakeBackTo(VirtualTime t) {
  Count(work_.taken_back);
  while (used_ > 0 && legs_[used_ - 1].start.at >= t) {
    --used_;
    std::swap(frontier_, legs_[used_].start);
    knows_frontier_ = true;
  }
  if (used_ > 0) FindFrontier();
}

void Island::Settle(VirtualTime t) {
  std::size_t past = 0;
  const auto end_of = [this](std::size_t leg) {
    return leg + 1 < used_ ? legs_[leg + 1].start.at : frontier_.at;
  };
  while (past < used_ && end_of(past) < t) ++past;
  if (past == 0) return;
  if (past == used_) StateAtFrontier();  // while there is a leg that knows it
  const auto at = [this](std::size_t leg) {
    return legs_.begin() + static_cast<std::ptrdiff_t>(leg);
  };
  std::rotate(legs_.begin(), at(past), at(used_));
  used_ -= past;
  const VirtualTime origin = Origin().at;
  const auto is_earlier = [](const Command& command, VirtualTime of) { return command.at < of; };
  commands_.erase(commands_.begin(),
                  std::lower_bound(commands_.begin(), commands_.end(), origin, is_earlier));
}

std::size_t Island::CommandsUntil(VirtualTime t) const {
  const auto later = std::upper_bound(commands_.begin(), commands_.end(), t, IsEarlier);
  return static_cast<std::size_t>(later - commands_.begin());
}

IslandStep* Island::NextStepTo(VirtualTime t, VirtualDuration most) {
  if (t <= frontier_.at) return nullptr;
  if (used_ == legs_.size()) legs_.emplace_back();
  StateAtFrontier();
  Leg& leg = legs_[used_];
  leg.within_at = VirtualTime::Never();
  Depart(frontier_, most, &leg);
  return &leg.step;
}

// The commands for the very instant take effect.
void Island::Depart(const Node& start, VirtualDuration most, Leg* leg) {
  IslandStep& step = leg->step;
  step.island = index_;
  step.at = start.at;
  step.from = start.state;
  step.wrenches = start.wrenches;
  step.remainders = start.remainders;
  step.try_s = start.try_s;
  step.limit = engine_.LongestStep(index_);
  if (!engine_.has_set_steps()) step.limit = std::min(step.limit, most);
  leg->changed_at = start.changed_at;
  for (const Command& command : commands_) {
    if (command.at > start.at) break;
    if (command.at == start.at) {
      step.wrenches[static_cast<std::size_t>(command.place)] = command.wrench;
    }
  }
  if (step.wrenches != start.wrenches) {
    Count(work_.changes);
    leg->changed_at = start.at;
    LetLag(start, &step);
    LimitAfterChange(start, &step);
  }
  if (HasSettled(step)) step.remainders.clear();
}

// Where a new command lags, the wrench that acted until now fades.
void Island::LetLag(const Node& start, IslandStep* step) const {
  const std::size_t bodies = step->wrenches.size();
  for (std::size_t place = 0; place < bodies; ++place) {
    const Wrench& before = start.wrenches[place];
    const Wrench& now = step->wrenches[place];
    if (now == before) continue;
    if (now.lag == VirtualDuration{}) {
      if (!step->remainders.empty()) step->remainders[place] = {};
      continue;
    }
    step->remainders.resize(bodies);
    const Remainder& left = start.remainders.empty() ? Remainder{} : start.remainders[place];
    step->remainders[place] = RemainderAt(before, left, start.at);
  }
}

void Island::LimitAfterChange(const Node& start, IslandStep* step) const {
  if (engine_.has_set_steps()) return;
  if (const VirtualDuration interval = start.at - start.changed_at; interval > VirtualDuration{}) {
    step->limit = std::min(step->limit, std::max(interval * kIntervalsAhead, kLeastAhead));
  }
  for (std::size_t place = 0; place < step->remainders.size(); ++place) {
    // Error control sees a fading wrench when the step is not many times longer than the fading
    // takes.
    if (step->remainders[place].since != start.at) continue;
    step->limit = std::min(step->limit, step->wrenches[place].lag);
  }
}

void Island::Took() {
  Leg& leg = legs_[used_];
  std::swap(leg.start, frontier_);
  const VirtualDuration length = LengthOf(leg.step);
  Require(length > VirtualDuration{}, "a step leads on");
  leg.to = leg.start.at + length;
  ++used_;
  Count(work_.steps);
  FindFrontier();
}

// The time of the first change between a leg's start and the end of its step; Never() if nothing
// changes. Until then the commanded wrenches are those that the step has: so only the commands of
// an instant matter, of which the last one to a place stays.
VirtualTime Island::ChangeWithin(const Leg& leg) const {
  auto command = std::upper_bound(commands_.begin(), commands_.end(), leg.start.at, IsEarlier);
  while (command != commands_.end() && command->at <= leg.to) {
    const auto end = std::upper_bound(command, commands_.end(), command->at, IsEarlier);
    for (; command != end; ++command) {
      if (command->wrench == leg.step.wrenches[static_cast<std::size_t>(command->place)]) continue;
      const auto is_same_place = [&](const Command& later) {
        return later.place == command->place;
      };
      if (std::none_of(command + 1, end, is_same_place)) return command->at;
    }
  }
  return VirtualTime::Never();
}

// Finds the frontier's time; the island's state at that time is found when it is needed.
void Island::FindFrontier() {
  const Leg& leg = legs_[used_ - 1];
  frontier_.at = std::min(leg.to, ChangeWithin(leg));
  knows_frontier_ = false;
}

const std::vector<double>& Island::StateAtFrontier() {
  if (!knows_frontier_) {
    Leg& leg = legs_[used_ - 1];
    GoTo(leg, frontier_.at, &frontier_);
    frontier_.state = StateOf(leg, frontier_.at);
  }
  knows_frontier_ = true;
  return frontier_.state;
}

// Fills in all of the node but the state.
void Island::GoTo(const Leg& leg, VirtualTime t, Node* node) const {
  node->at = t;
  node->wrenches = leg.step.wrenches;
  node->remainders = leg.step.remainders;
  node->try_s = leg.step.next_try_s;
  node->changed_at = leg.changed_at;
}

Island::Node Island::NodeAt(VirtualTime t) {
  Require(t >= Origin().at && t <= frontier_.at, "an island goes on from where it is known");
  if (t == frontier_.at) {
    StateAtFrontier();
    return frontier_;
  }
  std::size_t leg = used_ - 1;
  while (legs_[leg].start.at > t) --leg;
  if (legs_[leg].start.at == t) return legs_[leg].start;
  Node node;
  GoTo(legs_[leg], t, &node);
  node.state = StateOf(legs_[leg], t);
  return node;
}

// The result is valid until the leg is another one, or another state within it is asked for.
const std::vector<double>& Island::StateOf(Leg& leg, VirtualTime t) {
  IslandStep& step = leg.step;
  const VirtualDuration after = t - leg.start.at;
  if (after == VirtualDuration{}) return step.from;
  if (after.seconds() == step.length_s) {
    if (step.to.empty()) engine_.Within(step, after, &step.to);
    return step.to;
  }
  if (leg.within_at != t) {
    leg.within_at = VirtualTime::Never();
    engine_.Within(step, after, &leg.within);
    leg.within_at = t;
  }
  return leg.within;
}

void Island::StateAt(VirtualTime t, std::vector<double>* state) {
  Require(t >= Origin().at && t <= frontier_.at, "a state is read where it is known");
  if (t == frontier_.at) {
    *state = StateAtFrontier();
    return;
  }
  std::size_t leg = used_ - 1;
  while (legs_[leg].start.at > t) --leg;
  *state = StateOf(legs_[leg], t);
}

Acting Island::ActingUntil(VirtualTime t) const {
  if (used_ == 0) return {frontier_.wrenches, frontier_.remainders, t};
  std::size_t leg = used_ - 1;
  while (leg > 0 && legs_[leg].start.at >= t) --leg;
  const Node& start = legs_[leg].start;
  if (start.at >= t) return {start.wrenches, start.remainders, t};
  return {legs_[leg].step.wrenches, legs_[leg].step.remainders, t};
}

const IslandStep* Island::StepTo(VirtualTime t) const {
  Require(t >= Origin().at && t <= frontier_.at, "a step is looked at where it was taken");
  std::size_t leg = used_;
  while (leg > 0 && legs_[leg - 1].start.at >= t) --leg;
  return leg > 0 ? &legs_[leg - 1].step : nullptr;
}

void Island::Save(Saved* saved) const {
  saved->origin = Origin();
  saved->commands = commands_;
}

// Steps are taken anew: they lead where they led before.
void Island::Restore(const Saved& saved) {
  used_ = 0;
  frontier_ = saved.origin;
  knows_frontier_ = true;
  commands_ = saved.commands;
}

}  // namespace tcs
