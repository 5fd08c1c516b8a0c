#include "coordinator/explain/explanation.h"

#include <gmock/gmock.h>

#include <numeric>

namespace tcs::explain {
namespace {

constexpr std::int64_t kMs = 1'000'000;

const std::map<std::string, Client> kClients = {
    {"r/controller", {.priority = 10, .has_deadline = true}}, {"r/planner", {.priority = 20}}};

Activation Late() {
  return {.client = "r/controller",
          .release_ns = 3120 * kMs,
          .start_ns = 3160 * kMs,
          .end_ns = 3171 * kMs,
          .deadline_ns = 10 * kMs,
          .queued_ns = 2 * kMs,
          .executed_ns = 9 * kMs,
          .room_ns = kMs,
          .cores = {{"r/planner", 39 * kMs}}};
}

TEST(ExplanationTest, NamesTheGreatestPart) {
  EXPECT_EQ(SentenceOn(Late(), kClients),
            "at 3.120 s r/controller answered 41 ms late, after 51 ms: r/planner, of higher "
            "priority, had the core for 39 ms of it");
}

TEST(ExplanationTest, ThePartsAreTheWhole) {
  const std::vector<Part> parts = PartsOf(Late(), kClients);
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[1].what, "r/planner, of higher priority, had the core");
  EXPECT_EQ(std::accumulate(parts.begin(), parts.end(), std::int64_t{0},
                            [](std::int64_t sum, const Part& part) { return sum + part.ns; }),
            Late().TookNs());
}

TEST(ExplanationTest, WakingIsAPart) {
  Activation activation = Late();
  activation.cores.clear();
  activation.wakeup_ns = 39 * kMs;
  EXPECT_EQ(SentenceOn(activation, kClients),
            "at 3.120 s r/controller answered 41 ms late, after 51 ms: waking its thread took "
            "39 ms of it (cpu.wakeup)");
}

TEST(ExplanationTest, WhatHasNoDeadlineIsNotLate) {
  Activation activation = Late();
  activation.client = "r/planner";
  activation.deadline_ns = 0;
  activation.cores.clear();
  activation.locks = {{"", 39 * kMs}};
  EXPECT_EQ(SentenceOn(activation, kClients),
            "at 3.120 s r/planner took 51 ms: it waited for a lock that somebody unknown had for "
            "39 ms of it");
}

TEST(ExplanationTest, AQueueGoesBackToWhatWasNotQueuedItself) {
  Told told;
  told.activations = {
      {.client = "a", .release_ns = 0, .end_ns = 5},
      {.client = "a", .release_ns = 10, .end_ns = 60, .executed_ns = 50},
      {.client = "b", .release_ns = 10, .end_ns = 65},
      {.client = "a", .release_ns = 20, .end_ns = 70, .queued_ns = 40, .executed_ns = 10},
      {.client = "a", .release_ns = 30, .end_ns = 80, .queued_ns = 40, .executed_ns = 10}};
  EXPECT_EQ(QueuedBehind(told, told.activations[4]), &told.activations[1]);
  EXPECT_EQ(QueuedBehind(told, told.activations[1]), nullptr);
}

TEST(ExplanationTest, TheWorstAreThoseThatAreMostLate) {
  Told told{.clients = kClients};
  for (const std::int64_t took : {5, 60, 20}) {
    told.activations.push_back(
        {.client = "r/controller", .end_ns = took * kMs, .deadline_ns = 10 * kMs});
  }
  told.activations.push_back({.client = "r/planner", .end_ns = 500 * kMs});
  const auto worst = Choose(told, {.most = 3});
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0]->TookNs(), 60 * kMs);
  EXPECT_EQ(worst[1]->TookNs(), 20 * kMs);
  EXPECT_EQ(worst[2]->client, "r/planner");
  EXPECT_EQ(Choose(told, {.client = "r/planner"}).size(), 1u);
  EXPECT_EQ(Choose(told, {.at_ns = 30 * kMs}).size(), 2u);
}

TEST(ExplanationTest, OneOfEachQueueComesBeforeTheOthersOfIt) {
  // At 0 and at 1000 something is late, and two wait behind it; in between is another client's.
  Told told{.clients = kClients};
  for (const std::int64_t at : {0, 1000}) {
    const std::int64_t more = at / 500;
    told.activations.push_back({.client = "a", .release_ns = at, .end_ns = at + 50 + more});
    told.activations.push_back({.client = "b", .release_ns = at + 5, .end_ns = at + 55});
    told.activations.push_back(
        {.client = "a", .release_ns = at + 10, .end_ns = at + 58 + more, .queued_ns = 40});
    told.activations.push_back(
        {.client = "a", .release_ns = at + 20, .end_ns = at + 66 + more, .queued_ns = 38});
  }
  for (Activation& one : told.activations) one.deadline_ns = 10;
  std::vector<std::int64_t> releases;
  for (const Activation* one : Choose(told, {.client = "a", .most = 9}))
    releases.push_back(one->release_ns);
  EXPECT_THAT(releases, testing::ElementsAre(1000, 0, 1010, 10, 1020, 20));
}

}  // namespace
}  // namespace tcs::explain
