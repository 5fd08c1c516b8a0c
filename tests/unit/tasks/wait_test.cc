#include "coordinator/tasks/wait.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace tcs {
namespace {

// What the engine asks of each kind of wait.
struct Case {
  std::string name;
  Wait::What what;
  bool looks_at_others = false;
  bool is_for_input = false;
};

std::vector<Case> EveryKind() {
  std::vector<Case> cases;
  const auto add = [&](std::string name, Wait::What what, bool looks_at_others, bool is_for_input) {
    cases.push_back({std::move(name), std::move(what), looks_at_others, is_for_input});
  };
  add("nothing", awaited::Nothing{}, false, false);
  add("time", awaited::Time{}, false, false);
  add("signals", awaited::Signals{1}, true, true);
  add("descriptors", awaited::Descriptors{}, true, true);
  // A child is of the same robot, and its end is known there.
  add("child", awaited::Child{}, true, false);
  // Whoever wakes it runs on the same robot, and holds before it does.
  add("futex", awaited::Futex{}, false, false);
  add("queue", awaited::Queue{}, true, true);
  add("messages", awaited::Messages{}, true, true);
  add("deliverer", awaited::Deliverer{}, false, false);
  // It reads nothing once there is room, but another robot may make it.
  add("room", awaited::Room{1}, false, true);
  add("others", awaited::OthersRun{}, false, false);
  return cases;
}

TEST(Wait, EveryKindIsInTheTable) {
  EXPECT_EQ(EveryKind().size(), std::variant_size_v<Wait::What>);
}

TEST(Wait, WhoeverLooksAtWhatOthersDidHoldsAsAtARead) {
  for (Case& one : EveryKind()) {
    EXPECT_EQ(LooksAtOthers({std::move(one.what)}), one.looks_at_others) << one.name;
  }
}

TEST(Wait, InputEndsThoseThatOthersCanEnd) {
  for (Case& one : EveryKind()) {
    EXPECT_EQ(IsForInput({std::move(one.what)}), one.is_for_input) << one.name;
  }
}

TEST(Wait, EndsByTimeOnlyWhereItHasADeadline) {
  EXPECT_TRUE(Wait{awaited::Time{}}.deadline.IsNever());
  EXPECT_EQ((Wait{awaited::Time{}, RobotTime(7)}).deadline, RobotTime(7));
}

TEST(Wait, SignalsEndThoseThatAcceptThemAndThoseForDescriptorsWithAMask) {
  EXPECT_EQ(SignalsThatEnd({awaited::Signals{0b101}}), 0b101u);
  EXPECT_EQ(SignalsThatEnd({awaited::Descriptors{.signals = 0b110}}), 0b110u);
  EXPECT_EQ(SignalsThatEnd({awaited::Descriptors{}}), 0u);
  EXPECT_EQ(SignalsThatEnd({awaited::Time{.mask = 0b111}}), 0u);
}

TEST(Wait, OnlyASleepBringsAMaskWithIt) {
  EXPECT_EQ(MaskOf({awaited::Time{.mask = 0}}), 0u);
  EXPECT_EQ(MaskOf({awaited::Time{}}), std::nullopt);
  EXPECT_EQ(MaskOf({awaited::Signals{0b101}}), std::nullopt);
}

TEST(Wait, ForAChildIsForThatOneOrAny) {
  EXPECT_TRUE(awaited::Child{}.MayBe(17));
  EXPECT_TRUE((awaited::Child{.which = 17}).MayBe(17));
  EXPECT_FALSE((awaited::Child{.which = 17}).MayBe(18));
}

TEST(Wait, IsAskedForItsKind) {
  Wait wait{awaited::Room{3}};
  ASSERT_NE(wait.As<awaited::Room>(), nullptr);
  EXPECT_EQ(wait.As<awaited::Room>()->process, 3u);
  EXPECT_EQ(wait.As<awaited::Child>(), nullptr);
}

TEST(WaitCounts, CountWhatOnlyALookFinds) {
  WaitCounts counts;
  const Wait child{awaited::Child{}}, stop{awaited::Child{.stops = true}};
  const Wait signals{awaited::Signals{1}}, masked{awaited::Descriptors{.signals = 1}};
  const Wait queue{awaited::Queue{}}, terminal{awaited::Descriptors{.has_terminal = true}};
  const Wait room{awaited::Room{1}}, deliverer{awaited::Deliverer{}};
  const Wait futex{awaited::Futex{}}, time{awaited::Time{}};
  for (const Wait* wait :
       {&child, &stop, &signals, &masked, &queue, &terminal, &room, &deliverer, &futex, &time}) {
    counts.Entered(*wait);
  }
  EXPECT_EQ(counts.for_child(), 2);
  EXPECT_EQ(counts.for_stops(), 1);
  EXPECT_EQ(counts.for_signals(), 2);
  EXPECT_EQ(counts.for_objects(), 2);
  EXPECT_EQ(counts.for_room(), 1);
  EXPECT_EQ(counts.for_deliverer(), 1);
  counts.Left(stop);
  counts.Left(terminal);
  counts.Left(masked);
  EXPECT_EQ(counts.for_child(), 1);
  EXPECT_EQ(counts.for_stops(), 0);
  EXPECT_EQ(counts.for_signals(), 1);
  EXPECT_EQ(counts.for_objects(), 1);
}

}  // namespace
}  // namespace tcs
