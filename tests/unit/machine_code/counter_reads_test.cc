#include <gtest/gtest.h>

#include <vector>

#include "shm/machine_code/replacement_plan.h"

namespace tcs::shm {
namespace {

// A function from its begin on, without any table of others.
struct Function {
  std::vector<std::uint8_t> bytes;

  CodeRange range() const { return {bytes.data(), bytes.data() + bytes.size()}; }
  Code First() const {
    Code first = nullptr;
    ForEachLookingLikeARead(range(), {}, [&](Code at) { first = first == nullptr ? at : first; });
    return first;
  }
  NotReplaced Plan(Replacement* replacement, std::vector<Code> targets = {}) const {
    const UnwindTable none;
    ReplacementPlan plan(range(), none);
    return plan.NextIn(range(), First(), targets.data(), targets.size(), replacement);
  }
  // The range that is moved, as places in the function.
  std::pair<long, long> Moved(std::vector<Code> targets = {}) const {
    Replacement one;
    if (Plan(&one, targets) != NotReplaced::kNo) return {-1, -1};
    return {one.moved.begin - bytes.data(), one.moved.end - bytes.data()};
  }
};

using Range = std::pair<long, long>;
constexpr Range kNone{-1, -1};

TEST(CounterReads, AreFoundByTheirBytesWhereverTheyStand) {
  for (std::size_t place = 0; place < 70; ++place) {
    std::vector<std::uint8_t> bytes(72, 0x90);
    bytes[place] = 0x0f;
    bytes[place + 1] = 0x31;
    const Function function{bytes};
    int count = 0;
    ForEachLookingLikeARead(function.range(), {}, [&](Code) { ++count; });
    EXPECT_EQ(count, 1) << place;
    EXPECT_EQ(function.First() - function.bytes.data(), static_cast<long>(place));
  }
  const Function with_processor{{0x90, 0x0f, 0x01, 0xf9, 0x0f, 0x01, 0xd0}};
  EXPECT_EQ(with_processor.First() - with_processor.bytes.data(), 1);
}

TEST(CounterReads, GoWithWhatFollows) {
  // rdtsc; shl $32, %rdx; or %rdx, %rax; ret
  EXPECT_EQ((Function{{0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0x48, 0x09, 0xd0, 0xc3}}.Moved()),
            (Range{0, 6}));
}

TEST(CounterReads, GoWithWhatIsBeforeWhereSomethingLeadsBehindThem) {
  // jne 5; rdtscp; 5: shl $32, %rdx; ret; mfence; rdtsc; jmp 5
  const Function go{{0x75, 0x08, 0x0f, 0x01, 0xf9, 0x48, 0xc1, 0xe2, 0x20, 0xc3, 0x0f, 0xae, 0xf0,
                     0x0f, 0x31, 0xeb, 0xf4}};
  EXPECT_EQ(go.Moved(), (Range{0, 5}));
}

TEST(CounterReads, AreLeftWhereSomethingLeadsIntoEveryRange) {
  // 0: nop; rdtsc; 3: nop; jmp 3; jmp 1; ret
  EXPECT_EQ((Function{{0x90, 0x0f, 0x31, 0x90, 0xeb, 0xfd, 0xeb, 0xf9, 0xc3}}.Moved()), kNone);
}

TEST(CounterReads, AreNotMovedWithCalls) {
  // call; rdtsc; call; ret
  EXPECT_EQ((Function{{0xe8, 0, 0, 0, 0, 0x0f, 0x31, 0xe8, 0, 0, 0, 0, 0xc3}}.Moved()), kNone);
}

TEST(CounterReads, AreKnownFromBytesWithinOtherInstructions) {
  // mov $0x310f, %eax; ret
  Replacement one;
  EXPECT_EQ((Function{{0xb8, 0x0f, 0x31, 0, 0, 0xc3}}.Plan(&one)), NotReplaced::kIsNoInstruction);
}

TEST(CounterReads, AreLeftWhereNotAllOfTheFunctionIsCode) {
  Replacement one;
  EXPECT_EQ((Function{{0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0xc3, 0x06}}.Plan(&one)),
            NotReplaced::kCodeIsUnknown);
  EXPECT_EQ((Function{{0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0xc3, 0xe8}}.Plan(&one)),
            NotReplaced::kCodeIsUnknown);
}

TEST(CounterReads, GoWithAJumpAndWhatFillsTheRoomBehindIt) {
  // rdtsc; jmp 0; nopw 0(%rax,%rax); ret
  const Function loop{{0x0f, 0x31, 0xeb, 0xfc, 0x66, 0x0f, 0x1f, 0x44, 0, 0, 0xc3}};
  EXPECT_EQ(loop.Moved(), (Range{0, 10}));
  EXPECT_EQ(loop.Moved({loop.bytes.data() + 4}), kNone);
  // What may be executed does not: rdtsc; jmp 0; inc %eax; ret
  EXPECT_EQ((Function{{0x0f, 0x31, 0xeb, 0xfc, 0xff, 0xc0, 0xc3}}.Moved()), kNone);
}

TEST(CounterReads, PausesAreFoundWhereTheyAreSought) {
  for (std::size_t place = 0; place < 70; ++place) {
    std::vector<std::uint8_t> bytes(72, 0xcc);
    bytes[place] = 0xf3;
    bytes[place + 1] = 0x90;
    const Function function{bytes};
    int count = 0;
    ForEachLookingLikeARead(function.range(), {}, [&](Code) { ++count; });
    EXPECT_EQ(count, 0);
    ForEachLookingLikeARead(function.range(), {.pauses = true}, [&](Code at) {
      ++count;
      EXPECT_EQ(at, function.bytes.data() + place);
    });
    EXPECT_EQ(count, 1) << place;
  }
}

TEST(CounterReads, HeedATableOfTargetsThatIsNotKnown) {
  // nop; nop; nop; rdtsc; nop; nop; nop; jmp *%rcx
  EXPECT_EQ((Function{{0x90, 0x90, 0x90, 0x0f, 0x31, 0x90, 0x90, 0x90, 0xff, 0xe1}}.Moved()),
            kNone);
  // Behind the read its result is taken up: rdtsc; shl $32, %rdx; jmp *%rcx
  EXPECT_EQ((Function{{0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0xff, 0xe1}}.Moved()), (Range{0, 6}));
}

TEST(CounterReads, HeedWhatIsKnownToLeadIntoThem) {
  const Function function{{0x90, 0x90, 0x90, 0x0f, 0x31, 0x48, 0xc1, 0xe2, 0x20, 0xc3}};
  EXPECT_EQ(function.Moved(), (Range{3, 9}));
  EXPECT_EQ(function.Moved({function.bytes.data() + 5}), (Range{0, 5}));
}

TEST(CounterReads, GoWithEachOther) {
  // rdtsc; mov %eax, %ecx; rdtsc; nop; nop; nop; ret
  const Function function{{0x0f, 0x31, 0x89, 0xc1, 0x0f, 0x31, 0x90, 0x90, 0x90, 0xc3}};
  const UnwindTable none;
  ReplacementPlan plan({}, none);
  Replacement first, second;
  EXPECT_EQ(plan.NextIn(function.range(), function.bytes.data(), nullptr, 0, &first),
            NotReplaced::kNo);
  EXPECT_EQ(first.moved.end, function.bytes.data() + 6);
  EXPECT_EQ(plan.NextIn(function.range(), function.bytes.data() + 4, nullptr, 0, &second),
            NotReplaced::kWithAnother);
}

TEST(CounterReads, ThatAreTakenUpAreInstructions) {
  const Function read{{0x0f, 0x31, 0x89, 0xc0, 0x48, 0xc1, 0xe2, 0x20}};
  EXPECT_TRUE(TakesUpCounter(read.range(), read.bytes.data()));
  const Function none{{0x0f, 0x31, 0xc3, 0x48, 0xc1, 0xe2, 0x20}};
  EXPECT_FALSE(TakesUpCounter(none.range(), none.bytes.data()));
}

TEST(CounterReads, GoIntoWhatFillsAGap) {
  const std::vector<std::uint8_t> filled(64, 0x90);
  const Code aligned = filled.data() + (16 - reinterpret_cast<std::uintptr_t>(filled.data()) % 16);
  const CodeRange padding = machine_code::PaddingIn({aligned + 3, aligned + 40});
  EXPECT_EQ(padding.begin, aligned + 3);
  EXPECT_EQ(padding.end, aligned + 16) << "what begins there may be a function";
  EXPECT_EQ(machine_code::RoomFor(padding, aligned - 20, nullptr), aligned + 3);
  EXPECT_EQ(machine_code::RoomFor(padding, aligned - 20, aligned + 11), aligned + 11);
  EXPECT_EQ(machine_code::RoomFor(padding, aligned - 20, aligned + 12), nullptr);
  EXPECT_EQ(machine_code::RoomFor(padding, aligned - 200, nullptr), nullptr);
}

}  // namespace
}  // namespace tcs::shm
