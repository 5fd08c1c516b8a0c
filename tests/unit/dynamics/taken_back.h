// Commands that come for times which have been read already.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {

// Of two of one world, `known` has all commands before it begins. `leading` is read up to 40 ms
// ahead of each, and now and then saved, restored, and given again what came since. They stay the
// same to the byte. `apply` gives a command, which has the time `at_ns`; `read` reads all there is
// at a time.
template <class Timed, class Apply, class Read, class Draw>
void ExpectTheSameToTheByte(Dynamics& known, Dynamics& leading, const std::vector<Timed>& commands,
                            const Apply& apply, const Read& read, const Draw& draw) {
  for (const Timed& command : commands) apply(known, command);
  std::unique_ptr<Dynamics::Checkpoint> checkpoint;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::int64_t now_ns = commands[i].at_ns;
    known.AdvanceTo(At(now_ns));
    leading.AdvanceTo(At(now_ns));
    const auto a = read(known, now_ns), b = read(leading, now_ns);
    ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << "before command " << i << " at " << now_ns;
    (void)read(leading, now_ns + draw(40'000'000));
    if (draw(8) == 0) checkpoint = leading.Save(std::move(checkpoint));
    apply(leading, commands[i]);
    if (checkpoint != nullptr && draw(8) == 0) {
      leading.Restore(*checkpoint);
      const VirtualTime from = leading.Now();
      std::size_t first = i + 1;
      while (first > 0 && At(commands[first - 1].at_ns) >= from) --first;
      for (std::size_t k = first; k <= i; ++k) apply(leading, commands[k]);
    }
  }
  EXPECT_GT(leading.work().taken_back, 300);
  EXPECT_EQ(known.work().taken_back, 0);
}

}  // namespace tcs
