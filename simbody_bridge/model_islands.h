// The islands of models. A model that others can touch is an island by itself as long as no other
// is near: as long as the model stays in its zone (model/zones.h). When a model is about to leave
// its zone, models are grouped anew: models that are near each other go on as one island from that
// instant, and models that have parted go on as several islands. The part of a model that is fixed
// to the world is like a fixture of the world: it is in the island of each model that is near, and
// joins no models. The instants of grouping follow from the models' motion alone; so their motion
// remains a function of the commands, and to take back motion takes back the meetings, too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simbody_bridge/island.h"
#include "simbody_bridge/model/zones.h"
#include "simbody_bridge/model_group.h"
#include "simbody_bridge/model_parts.h"
#include "simbody_bridge/team.h"

namespace tcs {

class ModelIslands {
 public:
  // `work` outlives this.
  ModelIslands(const WorldSpec& world, Dynamics::Work& work);

  // Islands are shared out to `team`, which outlives this.
  void UseTeam(Team& team) { team_ = &team; }

  void InterruptBy(const std::function<bool()>& asked) { is_interrupted_ = asked; }

  int count() const { return static_cast<int>(islands_.size()); }
  const ModelParts& parts() const { return parts_; }

  // As Dynamics' functions. Nothing before `now` matters any more.
  void ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t,
                   VirtualTime now);
  void Drive(int joint, const JointDrive& drive, VirtualTime t, VirtualTime now);
  void Spin(int rotor, double speed_radps, VirtualTime t, VirtualTime now);
  void ReadLinks(VirtualTime t, VirtualTime now, std::span<const int> links,
                 std::span<LinkState> states);
  void ReadJoints(VirtualTime t, VirtualTime now, std::span<const int> joints,
                  std::span<JointState> states);
  // The contacts of one island after those of the other.
  void ReadContacts(VirtualTime t, VirtualTime now, std::vector<ContactForce>* contacts);

  // The state that an island goes on from.
  struct SavedIsland {
    ModelGroup* group = nullptr;
    std::vector<Ball> zones;
    Island::Saved island;
  };
  using Saved = std::vector<SavedIsland>;
  void Save(VirtualTime now, Saved* saved) const;
  void Restore(const Saved& saved);

 private:
  struct GroupIsland {
    ModelGroup* group;
    std::vector<Ball> zones;  // of each model; empty: no model can meet another one
    Island island;
    bool is_leaving = false;  // a model its zone, at the island's frontier
    std::exception_ptr failure = nullptr;
    int briefest_steps = 0;  // in a row
  };
  using Owned = std::unique_ptr<GroupIsland>;
  // When models were grouped anew.
  struct Regrouping {
    VirtualTime at;
    std::vector<Owned> before;  // to go on with if the regrouping is taken back
    std::vector<GroupIsland*> after;
  };

  ModelGroup& GroupOf(const std::vector<int>& models, const std::vector<int>& bases);
  void AddUnit(const std::vector<int>& models);
  void AddStatics();
  void AddIsland(Owned island);
  bool Meets(const GroupIsland& of) const { return !of.zones.empty(); }
  bool CanAnyMeet(const std::vector<GroupIsland*>& meeting) const;
  GroupIsland& IslandOf(int model) { return *of_model_[static_cast<std::size_t>(model)]; }
  // The island in which the model comes to `t`.
  GroupIsland& HoldingAt(int model, VirtualTime t) const;
  VirtualTime SettledAt(VirtualTime now) const { return std::min(now, met_until_); }

  void Command(int model, int place, const Wrench& wrench, VirtualTime t, VirtualTime now);
  void Reach(VirtualTime t, VirtualTime now);
  void ReachAlone(VirtualTime t, VirtualTime now);
  void ReachTogether(VirtualTime t);
  void AdvanceAll(const std::vector<GroupIsland*>& islands, VirtualTime t);
  void Advance(GroupIsland& of, VirtualTime t);
  void Take(GroupIsland& of, IslandStep& step);
  void CheckLength(GroupIsland& of, const IslandStep& step);
  bool HasLeft(GroupIsland& of, const IslandStep& step);
  double TimeToLeave(GroupIsland& of, std::span<const double> state);
  void SettleMeeting(VirtualTime t);

  std::vector<GroupIsland*> InTheWayOf(GroupIsland& leaving, VirtualTime at);
  void AddMovers(GroupIsland& of, VirtualTime at);
  void Regroup(const std::vector<GroupIsland*>& concerned, VirtualTime at);
  void TakeBackMeetings(VirtualTime t);
  std::string NameOf(int island) const;

  // Calls `read` for each stretch of parts that are in one island, with their numbers there.
  template <class NumberIn, class ReadStretch>
  void ReadParts(VirtualTime t, VirtualTime now, std::span<const ModelPart> parts,
                 const NumberIn& number_in, const ReadStretch& read);

  const std::vector<RobotModel> models_;
  const ModelParts parts_;
  Dynamics::Work& work_;
  std::unique_ptr<ModelEngine> engine_;  // null: there is no model
  std::vector<int> unit_of_;             // of each model
  VirtualDuration brief_;                // no step is worth less
  std::optional<Zones> rules_;           // none: no model can meet another one

  std::vector<StaticBall> statics_;  // of models that touch others
  // Groups by their models, and by the models whose static shapes these touch.
  std::map<std::pair<std::vector<int>, std::vector<int>>, std::unique_ptr<ModelGroup>> groups_;
  std::vector<ModelGroup*> group_of_island_;  // by the engine's index
  std::vector<Owned> islands_;
  std::vector<GroupIsland*> of_model_;
  std::vector<Regrouping> regroupings_;  // can still be taken back; the latest last
  // Islands that can meet are known until this time, and so are the meetings before it.
  VirtualTime met_until_;

  std::function<bool()> is_interrupted_;  // see Dynamics::InterruptBy
  Team* team_ = nullptr;
  PieceCost cost_;  // of an island, to where all are to go
  // Memory of the functions above.
  std::vector<GroupIsland*> asked_, going_;
  std::vector<Mover> movers_;
  std::vector<int> mover_models_, local_;
  std::vector<ModelPart> read_;
  std::vector<double> state_;
};

}  // namespace tcs
