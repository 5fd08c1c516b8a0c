#include "coordinator/view/control_request.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <new>

#include "coordinator/view/view_link.h"

namespace tcs {
namespace {

TEST(ControlRequestTest, WordsAreRequests) {
  EXPECT_EQ(ParseControlRequest("stand")->kind, ControlRequest::Kind::kStand);
  EXPECT_EQ(ParseControlRequest("go")->kind, ControlRequest::Kind::kGo);
  EXPECT_EQ(ParseControlRequest("step 10000000")->step_ns, 10'000'000);
  EXPECT_EQ(ParseControlRequest("pace 0.5")->pace, 0.5);
  EXPECT_EQ(ParseControlRequest("pace 0")->pace, 0);
}

TEST(ControlRequestTest, GarbageIsNone) {
  for (const char* words : {"",
                            "Stand",
                            "stand ",
                            "go\n",
                            "step",
                            "step ",
                            "step 0",
                            "step -1",
                            "step 1.5",
                            "step 1s",
                            "step 99999999999999999999",
                            "step 3600000000001",
                            "pace",
                            "pace -1",
                            "pace 0.0001",
                            "pace 1001",
                            "pace nan",
                            "pace inf",
                            "pace 1x",
                            "\xff\xfe",
                            "{\"step\":1}"}) {
    EXPECT_FALSE(ParseControlRequest(words)) << words;
  }
}

class ViewLinkTest : public testing::Test {
 protected:
  static ControlPage* NewPage() {
    void* at = mmap(nullptr, sizeof(ControlPage), PROT_READ | PROT_WRITE,
                    MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return new (at) ControlPage;
  }
  static UniqueFd Alive() {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    close(ends[1]);
    return UniqueFd(ends[0]);
  }
  ControlPage* page_ = NewPage();
  ViewLink link_{page_, Alive(), "http://there/"};
};

TEST_F(ViewLinkTest, NothingIsTakenThatNobodyAskedFor) {
  link_.Begin(1, true);
  EXPECT_FALSE(link_.Take());
}

TEST_F(ViewLinkTest, WhatIsAskedForIsTakenOnce) {
  link_.Begin(1, true);
  Ask(*ParseControlRequest("go"), page_);
  const auto asked = link_.Take();
  ASSERT_TRUE(asked);
  EXPECT_FALSE(asked->stands);
  EXPECT_EQ(asked->pace, 1);
  EXPECT_EQ(asked->step_ns, 0);
  EXPECT_FALSE(link_.Take());
}

TEST_F(ViewLinkTest, StepsThatComeBetweenTwoLooksAddUp) {
  Ask(*ParseControlRequest("step 10"), page_);
  Ask(*ParseControlRequest("step 5"), page_);
  const auto asked = link_.Take();
  ASSERT_TRUE(asked);
  EXPECT_TRUE(asked->stands);
  EXPECT_EQ(asked->step_ns, 15);
  Ask(*ParseControlRequest("step 7"), page_);
  EXPECT_EQ(link_.Take()->step_ns, 7);
}

TEST_F(ViewLinkTest, AServerThatErrsAsksForNothingImpossible) {
  for (const double pace : {std::nan(""), -1.0, 1e300}) {
    page_->pace.store(pace);
    page_->stepped_ns.store(-5);
    page_->asked.fetch_add(1);
    const auto asked = link_.Take();
    ASSERT_TRUE(asked);
    EXPECT_GE(asked->pace, 0);
    EXPECT_LE(asked->pace, 1000);
    EXPECT_EQ(asked->step_ns, 0);
  }
}

}  // namespace
}  // namespace tcs
