// The islands of models. A model that others can touch is an island by itself as long as none of
// them is near: as long as it stays in its zone (model/zones.h). When it is about to leave that, it
// is looked anew who is near whom: those who are go on as one island from that instant, and those
// who have parted as several. What of a model is fixed to the world is like the world's own: it is
// in the island of whoever is near, and joins nobody. When that is follows from the models' motion
// alone; so their motion remains a function of the commands, and what is taken back takes back the
// meetings, too.
#pragma once

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

  // Those whom islands are shared out to; outlives this.
  void UseTeam(Team& team) { team_ = &team; }

  void InterruptBy(const std::function<bool()>& asked) { is_interrupted_ = asked; }

  int count() const { return static_cast<int>(islands_.size()); }
  const ModelParts& parts() const { return parts_; }

  // As of Dynamics. Nothing before `now` matters any more.
  void ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t,
                   VirtualTime now);
  void Drive(int joint, const JointDrive& drive, VirtualTime t, VirtualTime now);
  void Spin(int rotor, double speed_radps, VirtualTime t, VirtualTime now);
  void ReadLinks(VirtualTime t, VirtualTime now, std::span<const int> links,
                 std::span<LinkState> states);
  void ReadJoints(VirtualTime t, VirtualTime now, std::span<const int> joints,
                  std::span<JointState> states);
  // Those of each island after each other.
  void ReadContacts(VirtualTime t, VirtualTime now, std::vector<ContactForce>* contacts);

  // What is gone on from.
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
    std::vector<Ball> zones;  // of each of the models; none where none meets another
    Island island;
    bool is_leaving = false;  // one of them its zone, at the island's frontier
    std::exception_ptr failure = nullptr;
    int briefest_steps = 0;  // in a row
  };
  using Owned = std::unique_ptr<GroupIsland>;
  // When models were grouped anew.
  struct Regrouping {
    VirtualTime at;
    std::vector<Owned> before;  // go on if it is taken back
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
  std::unique_ptr<ModelEngine> engine_;  // none where there is no model
  std::vector<int> unit_of_;             // of each model
  VirtualDuration brief_;                // no step is worth less
  std::optional<Zones> rules_;           // none where no model can meet another one

  std::vector<StaticBall> statics_;  // of models that touch others
  // By their models, and by those whose static shapes these touch.
  std::map<std::pair<std::vector<int>, std::vector<int>>, std::unique_ptr<ModelGroup>> groups_;
  std::vector<ModelGroup*> group_of_island_;  // by the engine's index
  std::vector<Owned> islands_;
  std::vector<GroupIsland*> of_model_;
  std::vector<Regrouping> regroupings_;  // that can still be taken back, the latest last
  // All islands that can meet are known until here, and so is who meets before.
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
