#include "simbody_bridge/model_islands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simbody_bridge/body_islands.h"
#include "simbody_bridge/go_on.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/take_steps.h"

namespace tcs {
namespace {

// The shortest worthwhile step where the engine chooses steps. A model that would have to step
// shorter to stay in its zone gets another zone.
constexpr VirtualDuration kBrief = VirtualDuration::Milliseconds(1);
// With so many steps in a row that are shorter than this a run comes nowhere: the steps take
// seconds of real time for some milliseconds of virtual time.
constexpr VirtualDuration kBriefest = VirtualDuration::Microseconds(1);
constexpr int kMostBriefest = 5000;
// A new zone is good for so many of the shortest worthwhile steps.
constexpr std::int64_t kStepsInZone = 5;
// Islands that can meet go on in windows as long as this: the steps beyond the time at which they
// meet are taken for nothing.
constexpr VirtualDuration kWindow = VirtualDuration::Milliseconds(20);
// The longest step that has a zone's edge before it.
constexpr VirtualDuration kLongestWay = VirtualDuration::Seconds(1000);

VirtualDuration BriefestStep(const ModelEngine& engine) {
  return engine.has_set_steps() ? engine.LongestStep(0) : kBrief;
}

}  // namespace

ModelIslands::ModelIslands(const WorldSpec& world, Dynamics::Work& work)
    : models_(world.models),
      parts_(models_),
      work_(work),
      unit_of_(models_.size()),
      of_model_(models_.size()) {
  const std::vector<std::vector<int>> units = ModelUnitsOf(world);
  if (units.empty()) return;
  engine_ = MakeModelEngine(world, units);
  brief_ = BriefestStep(*engine_);
  std::vector<GroupIsland*> meeting;
  for (const std::vector<int>& unit : units) {
    AddUnit(unit);
    const auto can_meet = [this](int model) {
      return CanMeet(models_[static_cast<std::size_t>(model)]);
    };
    if (std::ranges::any_of(unit, can_meet)) meeting.push_back(islands_.back().get());
  }
  AddStatics();
  if (!CanAnyMeet(meeting)) return;
  rules_.emplace((brief_ * kStepsInZone).seconds());
  for (GroupIsland* of : meeting) AddMovers(*of, VirtualTime{});
  Regroup(meeting, VirtualTime{});
  regroupings_.clear();
}

void ModelIslands::AddStatics() {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (!models_[i].touches_models) continue;
    for (const StaticShape& of : StaticShapesOf(models_[i])) {
      statics_.push_back({BallOf(of.shape), static_cast<int>(i)});
    }
  }
}

// Whether an island has something to meet: another island that moves, or a static shape of another
// model.
bool ModelIslands::CanAnyMeet(const std::vector<GroupIsland*>& meeting) const {
  const auto is_of_another = [&](const StaticBall& one) {
    return !meeting[0]->group->Has(one.model);
  };
  return meeting.size() > 1 ||
         (meeting.size() == 1 && std::ranges::any_of(statics_, is_of_another));
}

// The engine has been made with the units, in this order.
void ModelIslands::AddUnit(const std::vector<int>& models) {
  const int index = static_cast<int>(group_of_island_.size());
  auto group = std::make_unique<ModelGroup>(models_, models, index);
  IslandStart start = engine_->StartOf(index);
  Island::Node node;
  node.state = std::move(start.state);
  node.try_s = start.try_s;
  node.wrenches.resize(static_cast<std::size_t>(group->places()));
  group_of_island_.push_back(group.get());
  AddIsland(std::make_unique<GroupIsland>(
      GroupIsland{group.get(), {}, Island(index, std::move(node), {}, *engine_, work_)}));
  for (const int model : models) unit_of_[static_cast<std::size_t>(model)] = index;
  groups_.emplace(std::pair(models, std::vector<int>{}), std::move(group));
}

void ModelIslands::AddIsland(Owned island) {
  for (const int model : island->group->models()) {
    of_model_[static_cast<std::size_t>(model)] = island.get();
  }
  islands_.push_back(std::move(island));
}

void ModelIslands::ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t,
                               VirtualTime now) {
  const ModelPart& part = parts_.LinkAt(link);
  if (!AllFinite(wrench.force_n) || !AllFinite(wrench.torque_nm)) {
    const RobotModel& model = models_[static_cast<std::size_t>(part.model)];
    throw DynamicsError(fmt::format("link '{}': a commanded wrench must be finite",
                                    model.links[static_cast<std::size_t>(part.index)].name));
  }
  // The frame says along whose axes the wrench is, and models' engines know of no lag.
  const Wrench acting{.force_n = wrench.force_n, .torque_nm = wrench.torque_nm};
  Require(wrench == acting, "a wrench on a link does not lag, and its frame is an argument");
  Command(part.model, PlaceOfLink(part.index, frame), acting, t, now);
}

void ModelIslands::Drive(int joint, const JointDrive& drive, VirtualTime t, VirtualTime now) {
  const ModelPart& part = parts_.JointAt(joint);
  const RobotModel& model = models_[static_cast<std::size_t>(part.model)];
  const Joint& driven = model.joints[static_cast<std::size_t>(part.index)];
  Require(CoordinatesOf(driven.kind) == 1 && !driven.mimic.has_value(),
          "a joint that is driven has one coordinate of its own");
  const bool lags = driven.drive_lag > VirtualDuration{};
  const Wrench numbers = lags ? AsNumbers(drive, driven.drive_lag) : AsNumbers(drive);
  if (!AllFinite(numbers.force_n) || !AllFinite(numbers.torque_nm)) {
    throw DynamicsError(fmt::format("joint '{}': what drives it must be finite", driven.name));
  }
  Command(part.model, PlaceOfJoint(static_cast<int>(model.links.size()), part.index), numbers, t,
          now);
}

void ModelIslands::Spin(int rotor, double speed_radps, VirtualTime t, VirtualTime now) {
  const ModelPart& part = parts_.RotorAt(rotor);
  const RobotModel& model = models_[static_cast<std::size_t>(part.model)];
  const Rotor& spun = model.rotors[static_cast<std::size_t>(part.index)];
  if (!(speed_radps >= 0 && speed_radps <= spun.most_radps) || !std::isfinite(speed_radps)) {
    throw DynamicsError(fmt::format("rotor '{}': its speed must be between 0 and {} rad/s",
                                    spun.name, spun.most_radps));
  }
  const int links = static_cast<int>(model.links.size());
  const int joints = static_cast<int>(model.joints.size());
  Command(part.model, PlaceOfRotor(links, joints, part.index),
          AsNumbers(speed_radps, spun.time_constant), t, now);
}

// Islands from before a regrouping may be needed again: so all islands that the model was in get
// the command.
void ModelIslands::Command(int model, int place, const Wrench& wrench, VirtualTime t,
                           VirtualTime now) {
  TakeBackMeetings(t);
  if (IslandOf(model).island.CommandsUntil(now) >= kMostPending) {
    asked_.assign(1, &IslandOf(model));
    Reach(now, now);
  }
  const auto apply = [&](GroupIsland& of) {
    of.island.Apply(of.group->PlaceIn(of.group->MemberOf(model), place), wrench, t);
  };
  for (const Regrouping& regrouping : regroupings_) {
    for (const Owned& of : regrouping.before) {
      if (of->group->Has(model)) apply(*of);
    }
  }
  GroupIsland& of = IslandOf(model);
  of.island.Settle(Meets(of) ? SettledAt(now) : now);
  apply(of);
  if (Meets(of)) met_until_ = std::min(met_until_, of.island.known_until());
}

ModelIslands::GroupIsland& ModelIslands::HoldingAt(int model, VirtualTime t) const {
  GroupIsland* holding = of_model_[static_cast<std::size_t>(model)];
  for (auto regrouping = regroupings_.rbegin();
       regrouping != regroupings_.rend() && regrouping->at >= t; ++regrouping) {
    for (const Owned& of : regrouping->before) {
      if (of->group->Has(model)) holding = of.get();
    }
  }
  return *holding;
}

template <class NumberIn, class ReadStretch>
void ModelIslands::ReadParts(VirtualTime t, VirtualTime now, std::span<const ModelPart> parts,
                             const NumberIn& number_in, const ReadStretch& read) {
  asked_.clear();
  for (const ModelPart& part : parts) asked_.push_back(&IslandOf(part.model));
  Reach(t, now);
  for (std::size_t first = 0; first < parts.size(); first += local_.size()) {
    GroupIsland& of = HoldingAt(parts[first].model, t);
    local_.clear();
    for (const ModelPart& part : parts.subspan(first)) {
      if (&HoldingAt(part.model, t) != &of) break;
      local_.push_back(number_in(*of.group, of.group->MemberOf(part.model), part.index));
    }
    of.island.StateAt(t, &state_);
    CheckState(*engine_, of.group->island(), state_, t,
               [this](int island, auto) { return NameOf(island); });
    read(of, first, local_.size());
  }
}

void ModelIslands::ReadLinks(VirtualTime t, VirtualTime now, std::span<const int> links,
                             std::span<LinkState> states) {
  read_.clear();
  for (const int link : links) read_.push_back(parts_.LinkAt(link));
  ReadParts(
      t, now, read_,
      [](const ModelGroup& group, std::size_t member, int link) {
        return group.LinkOf(member, link);
      },
      [&](GroupIsland& of, std::size_t first, std::size_t count) {
        engine_->ReadLinks(of.group->island(), state_, local_, states.subspan(first, count));
      });
}

void ModelIslands::ReadJoints(VirtualTime t, VirtualTime now, std::span<const int> joints,
                              std::span<JointState> states) {
  read_.clear();
  for (const int joint : joints) read_.push_back(parts_.JointAt(joint));
  ReadParts(
      t, now, read_,
      [](const ModelGroup& group, std::size_t member, int joint) {
        return group.JointOf(member, joint);
      },
      [&](GroupIsland& of, std::size_t first, std::size_t count) {
        engine_->ReadJoints(of.group->island(), state_, of.island.ActingUntil(t), local_,
                            states.subspan(first, count));
      });
}

void ModelIslands::ReadContacts(VirtualTime t, VirtualTime now,
                                std::vector<ContactForce>* contacts) {
  asked_.clear();
  for (const Owned& of : islands_) asked_.push_back(of.get());
  Reach(t, now);
  std::vector<const GroupIsland*> read;
  for (std::size_t model = 0; model < models_.size(); ++model) {
    const GroupIsland& of = HoldingAt(static_cast<int>(model), t);
    if (std::ranges::find(read, &of) != read.end()) continue;
    read.push_back(&of);
    const IslandStep* step = of.island.StepTo(t);
    if (step != nullptr) engine_->ReadContacts(*step, t - step->at, contacts);
  }
}

// Brings the islands in `asked_` to `t`; where one of them can meet others, all islands that can.
void ModelIslands::Reach(VirtualTime t, VirtualTime now) {
  const bool may_meet =
      std::any_of(asked_.begin(), asked_.end(), [this](auto* of) { return Meets(*of); });
  std::erase_if(asked_, [this](auto* of) { return Meets(*of); });
  ReachAlone(t, now);
  if (!may_meet || t <= met_until_) return;
  SettleMeeting(SettledAt(now));
  while (met_until_ < t) {
    const VirtualTime until = std::min(t, met_until_ + kWindow);
    ReachTogether(until);
    met_until_ = until;
    SettleMeeting(SettledAt(now));
  }
}

void ModelIslands::ReachAlone(VirtualTime t, VirtualTime now) {
  std::sort(asked_.begin(), asked_.end(),
            [](const auto* a, const auto* b) { return a->group->island() < b->group->island(); });
  asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
  for (GroupIsland* of : asked_) of->island.Settle(now);
  AdvanceAll(asked_, t);
  for (GroupIsland* of : asked_) of->island.Settle(now);
}

void ModelIslands::SettleMeeting(VirtualTime t) {
  std::erase_if(regroupings_, [t](const Regrouping& of) { return of.at < t; });
  for (const Owned& of : islands_) {
    if (Meets(*of)) of->island.Settle(t);
  }
}

// The earliest island that is about to leave its zone waits until all others have come as far: only
// then is it known that no island has met another one before.
void ModelIslands::ReachTogether(VirtualTime t) {
  for (;;) {
    going_.clear();
    for (const Owned& of : islands_) {
      if (Meets(*of) && of->island.known_until() < t) going_.push_back(of.get());
    }
    AdvanceAll(going_, t);
    GroupIsland* leaving = nullptr;
    const auto order = [](const GroupIsland& of) {
      return std::pair(of.island.known_until(), of.group->models().front());
    };
    for (GroupIsland* of : going_) {
      if (of->is_leaving && (leaving == nullptr || order(*of) < order(*leaving))) leaving = of;
    }
    if (leaving == nullptr) return;
    const VirtualTime at = leaving->island.known_until();
    Regroup(InTheWayOf(*leaving, at), at);
  }
}

// Advances the islands side by side. The failure is that of the island that came least far,
// whichever island was first to fail.
void ModelIslands::AdvanceAll(const std::vector<GroupIsland*>& islands, VirtualTime t) {
  const auto advance = [&](std::size_t i, std::size_t /*worker*/) {
    try {
      Advance(*islands[i], t);
    } catch (...) {
      islands[i]->failure = std::current_exception();
    }
  };
  if (team_ != nullptr) {
    team_->ForEach(islands.size(), &cost_, advance);
  } else {
    for (std::size_t i = 0; i < islands.size(); ++i) advance(i, 0);
  }
  GroupIsland* failed = nullptr;
  for (GroupIsland* of : islands) {
    if (of->failure == nullptr) continue;
    if (failed == nullptr || of->island.known_until() < failed->island.known_until()) failed = of;
  }
  if (failed == nullptr) return;
  const std::exception_ptr failure = failed->failure;
  for (GroupIsland* of : islands) of->failure = nullptr;
  std::rethrow_exception(failure);
}

// Advances to `t`, or to where one of the models is about to leave its zone.
void ModelIslands::Advance(GroupIsland& of, VirtualTime t) {
  of.is_leaving = false;
  for (int round = 1; of.island.known_until() < t; ++round) {
    if (is_interrupted_ && round % kStepsBetweenLooks == 0 && is_interrupted_()) {
      throw DynamicsInterrupted();
    }
    VirtualDuration most = kAnyLength;
    if (Meets(of)) {
      const double stays_s = TimeToLeave(of, of.island.StateAtFrontier());
      if (stays_s < brief_.seconds()) {
        of.is_leaving = true;
        return;
      }
      most = VirtualDuration::Nanoseconds(
          static_cast<std::int64_t>(std::min(stays_s, kLongestWay.seconds()) * 1e9));
    }
    Take(of, *of.island.NextStepTo(t, most));
  }
}

void ModelIslands::Take(GroupIsland& of, IslandStep& step) {
  const WhoDiverged who = [this](int island, auto) { return NameOf(island); };
  if (engine_->has_set_steps()) {
    // The state where the step leads is computed when it is needed: a command may come before.
    CheckState(*engine_, step.island, step.from, step.at, who);
    step.length_s = step.limit.seconds();
    step.to.clear();
    of.island.Took();
    return;
  }
  IslandStep* steps[] = {&step};
  TakeSteps(*engine_, steps, who);
  // A model was pushed harder than is trusted.
  while (Meets(of) && LengthOf(step) > kBrief && HasLeft(of, step)) {
    step.limit = std::max(kBrief, VirtualDuration::Nanoseconds(LengthOf(step).ns() / 2));
    TakeSteps(*engine_, steps, who);
  }
  CheckLength(of, step);
  of.island.Took();
}

// A motion that error control cuts to so short steps, again and again, never comes to its end.
void ModelIslands::CheckLength(GroupIsland& of, const IslandStep& step) {
  const bool is_brief = step.length_s < kBriefest.seconds() && LengthOf(step) < step.limit;
  of.briefest_steps = is_brief ? of.briefest_steps + 1 : 0;
  if (of.briefest_steps < kMostBriefest) return;
  throw DynamicsError(fmt::format("{}: it takes steps of less than {} us from {:.12g} s on{}",
                                  NameOf(step.island), kBriefest.ns() / 1000, step.at.seconds(),
                                  RemedyFor(*engine_, step.island)));
}

// Whether a model has left its zone at the end of the step, or half way there.
bool ModelIslands::HasLeft(GroupIsland& of, const IslandStep& step) {
  if (TimeToLeave(of, step.to) == 0) return true;
  std::vector<double> state;
  engine_->Within(step, VirtualDuration::Nanoseconds(LengthOf(step).ns() / 2), &state);
  return TimeToLeave(of, state) == 0;
}

double ModelIslands::TimeToLeave(GroupIsland& of, std::span<const double> state) {
  of.group->FindBalls(*engine_, state);
  double least_s = std::numeric_limits<double>::infinity();
  for (std::size_t member = 0; member < of.zones.size(); ++member) {
    for (const MovingBall& ball : of.group->BallsOf(member)) {
      least_s = std::min(least_s, tcs::TimeToLeave(of.zones[member], ball));
    }
  }
  return least_s;
}

void ModelIslands::AddMovers(GroupIsland& of, VirtualTime at) {
  of.island.StateAt(at, &state_);
  of.group->FindBalls(*engine_, state_);
  for (std::size_t member = 0; member < of.group->models().size(); ++member) {
    const int model = of.group->models()[member];
    movers_.push_back({Around(of.group->BallsOf(member)), unit_of_[static_cast<std::size_t>(model)],
                       of.group->island(), model});
    mover_models_.push_back(model);
  }
}

// An island that is too near to one that needs a new zone needs a new zone, too.
std::vector<ModelIslands::GroupIsland*> ModelIslands::InTheWayOf(GroupIsland& leaving,
                                                                 VirtualTime at) {
  std::vector<GroupIsland*> concerned = {&leaving};
  movers_.clear();
  mover_models_.clear();
  AddMovers(leaving, at);
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    for (const Owned& of : islands_) {
      if (!Meets(*of) || std::find(concerned.begin(), concerned.end(), of.get()) != concerned.end())
        continue;
      const Mover mover = movers_[i];
      if (std::none_of(of->zones.begin(), of->zones.end(),
                       [&](const Ball& zone) { return rules_->IsInTheWay(zone, mover); })) {
        continue;
      }
      concerned.push_back(of.get());
      AddMovers(*of, at);
    }
  }
  return concerned;
}

// `movers_` are the models of the islands concerned.
void ModelIslands::Regroup(const std::vector<GroupIsland*>& concerned, VirtualTime at) {
  ++work_.regrouped;
  std::vector<Ball> others;
  for (const Owned& of : islands_) {
    if (std::find(concerned.begin(), concerned.end(), of.get()) != concerned.end()) continue;
    others.insert(others.end(), of->zones.begin(), of->zones.end());
  }
  const Grouping grouping = rules_->Group(movers_, others, statics_);
  std::vector<GroupPast> from;
  for (GroupIsland* of : concerned) {
    from.push_back({of->group, of->island.NodeAt(at), of->island.commands()});
  }
  std::vector<Owned> joined;
  for (std::size_t number = 0; number < grouping.groups.size(); ++number) {
    const std::vector<std::size_t>& group = grouping.groups[number];
    std::vector<std::pair<int, Ball>> members;
    for (const std::size_t i : group) members.emplace_back(mover_models_[i], grouping.zones[i]);
    std::sort(members.begin(), members.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<int> models;
    std::vector<Ball> zones;
    for (const auto& [model, zone] : members) {
      models.push_back(model);
      zones.push_back(zone);
    }
    ModelGroup& of = GroupOf(models, grouping.bases[number]);
    GroupFuture future = GoOn(*engine_, of, from);
    joined.push_back(std::make_unique<GroupIsland>(
        GroupIsland{&of, zones,
                    Island(of.island(), std::move(future.start), std::move(future.commands),
                           *engine_, work_)}));
  }
  Regrouping regrouping{at, {}, {}};
  for (Owned& of : islands_) {
    if (std::find(concerned.begin(), concerned.end(), of.get()) == concerned.end()) continue;
    regrouping.before.push_back(std::move(of));
  }
  std::erase(islands_, nullptr);
  for (Owned& of : joined) {
    regrouping.after.push_back(of.get());
    AddIsland(std::move(of));
  }
  regroupings_.push_back(std::move(regrouping));
}

ModelGroup& ModelIslands::GroupOf(const std::vector<int>& models, const std::vector<int>& bases) {
  const std::pair key(models, bases);
  std::unique_ptr<ModelGroup>& group = groups_[key];
  if (group == nullptr) {
    try {
      group = std::make_unique<ModelGroup>(models_, models, engine_->AddIsland(models, bases));
    } catch (const std::exception& e) {
      groups_.erase(key);
      throw DynamicsError(fmt::format("model '{}' and those near it cannot be one system: {}",
                                      models_[static_cast<std::size_t>(models[0])].name, e.what()));
    }
    group_of_island_.push_back(group.get());
  }
  return *group;
}

// Islands that met after `t` go on from there as if they had not met.
void ModelIslands::TakeBackMeetings(VirtualTime t) {
  while (!regroupings_.empty() && regroupings_.back().at > t) {
    Regrouping& last = regroupings_.back();
    std::erase_if(islands_, [&](const Owned& of) {
      return std::find(last.after.begin(), last.after.end(), of.get()) != last.after.end();
    });
    for (Owned& of : last.before) AddIsland(std::move(of));
    met_until_ = std::min(met_until_, last.at);
    regroupings_.pop_back();
  }
}

std::string ModelIslands::NameOf(int island) const {
  const std::vector<int>& models = group_of_island_[static_cast<std::size_t>(island)]->models();
  std::string text = "model '" + models_[static_cast<std::size_t>(models[0])].name + "'";
  if (models.size() > 1) text += fmt::format(" or one of {} near it", models.size() - 1);
  return text;
}

void ModelIslands::Save(VirtualTime now, Saved* saved) const {
  const VirtualTime at = SettledAt(now);
  std::vector<const GroupIsland*> holding;
  for (std::size_t model = 0; model < of_model_.size(); ++model) {
    holding.push_back(&HoldingAt(static_cast<int>(model), at));
  }
  std::sort(holding.begin(), holding.end(), [](const GroupIsland* a, const GroupIsland* b) {
    return a->group->models() < b->group->models();
  });
  holding.erase(std::unique(holding.begin(), holding.end()), holding.end());
  saved->resize(holding.size());
  for (std::size_t i = 0; i < holding.size(); ++i) {
    (*saved)[i].group = holding[i]->group;
    (*saved)[i].zones = holding[i]->zones;
    holding[i]->island.Save(&(*saved)[i].island);
  }
}

void ModelIslands::Restore(const Saved& saved) {
  islands_.clear();
  regroupings_.clear();
  met_until_ = VirtualTime::Never();
  for (const SavedIsland& one : saved) {
    AddIsland(std::make_unique<GroupIsland>(GroupIsland{
        one.group, one.zones,
        Island(one.group->island(), one.island.origin, one.island.commands, *engine_, work_)}));
    if (!one.zones.empty()) met_until_ = std::min(met_until_, one.island.origin.at);
  }
}

}  // namespace tcs
