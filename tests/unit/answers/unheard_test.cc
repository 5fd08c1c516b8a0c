#include "coordinator/answers/unheard.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(Unheard, SaysWhereOthersReceived) {
  EXPECT_EQ(SentencesOn({{"r/a", "UDP port 27999", 300}}, {{"r/b", "UDP port 27601"}}).front(),
            "r/a sent 300 datagrams to UDP port 27999, where nobody received any; received was by "
            "r/b at UDP port 27601");
  EXPECT_EQ(SentencesOn({{"r/a", "UDP port 27999", 1}}, {}).front(),
            "r/a sent a datagram to UDP port 27999, where nobody received any; no client received "
            "any anywhere");
  EXPECT_TRUE(SentencesOn({}, {{"r/b", "UDP port 27601"}}).empty());
}

}  // namespace
}  // namespace tcs
