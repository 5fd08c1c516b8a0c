#include "coordinator/report/live_run.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "coordinator/report/csv_tail.h"
#include "coordinator/report/replay.h"
#include "coordinator/report/timeline.h"
#include "tests/unit/report/result_folder.h"

namespace tcs::report {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kHead =
    "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";

class LiveRunTest : public ResultFolderTest {
 protected:
  void Append(const std::string& name, const std::string& text) {
    std::ofstream(root_ / name, std::ios::app) << text;
  }
  std::string folder() const { return (root_ / "run").string(); }
  // A body that goes along x, 1 m/s, a line each 10 ms.
  static std::string Lines(int from, int to) {
    std::string lines;
    for (int i = from; i < to; ++i) {
      lines += fmt::format("{0:.2f},a,{0:.2f},0,0,0,0,0,1,1,0,0,0,0,0\n", i * 0.01);
    }
    return lines;
  }
  static std::size_t Moments(const Json& news) { return news["replay"]["count"]; }
};

TEST_F(LiveRunTest, AnEmptyFolderHasNothing) {
  LiveRun run(folder());
  run.Look();
  EXPECT_FALSE(run.HasMoments());
  EXPECT_FALSE(run.NewsSince({}).contains("replay"));
}

TEST_F(LiveRunTest, AMomentIsThereAtTheSecondLook) {
  Write("run/bodies.csv", kHead + Lines(0, 3));
  LiveRun run(folder());
  run.Look();
  EXPECT_FALSE(run.HasMoments());
  run.Look();
  EXPECT_TRUE(run.HasMoments());
  EXPECT_DOUBLE_EQ(run.LastS(), 0.02);
}

TEST_F(LiveRunTest, EachPartBeginsWhereTheOneBeforeEnded) {
  Write("run/bodies.csv", kHead + Lines(0, 5));
  LiveRun run(folder());
  run.Look();
  run.Look();
  const Json first = run.NewsSince({});
  Append("run/bodies.csv", Lines(5, 11));
  run.Look();
  run.Look();
  const LiveRun::Place have{.generation = first["generation"], .moments = first["to"]["moments"]};
  const Json second = run.NewsSince(have);
  EXPECT_EQ(Moments(first), 3u);  // of 20 ms each
  EXPECT_EQ(second["from"]["moments"], 3);
  EXPECT_EQ(Moments(second), 3u);
  EXPECT_TRUE(second["replay"]["scene"].is_null());
  EXPECT_DOUBLE_EQ(second["replay"]["end"], 0.1);
  const Json nothing = run.NewsSince(run.place());
  EXPECT_EQ(Moments(nothing), 0u);
  EXPECT_THAT(nothing["replay"]["said"], IsEmpty());
}

// In pieces that end anywhere, also in the middle of a line.
TEST_F(LiveRunTest, WhatIsReadInPiecesIsWhatIsReadAtOnce) {
  const std::pair<std::string, std::string> files[] = {
      {"run/bodies.csv", kHead + Lines(0, 300)},
      {"run/joints.csv",
       [] {
         std::string text = "time_s,joint,position,velocity,effort\n";
         for (int i = 0; i < 300; ++i)
           text += fmt::format("{:.2f},a/j,{},0.5,{}\n", i * 0.01, i, 300 - i);
         return text;
       }()},
      {"run/contacts.csv",
       [] {
         std::string text = "time_s,first,second,x_m,y_m,z_m,force_x_n,force_y_n,force_z_n\n";
         for (int i = 1; i < 300; ++i) {
           for (int k = 0; k < i % 3; ++k)
             text +=
                 fmt::format("{:.2f},a,floor,{},{},0,0,1,{}\n", i * 0.01, i * 0.1, k, 9 + i % 7);
         }
         return text;
       }()},
      {"run/commands.csv",
       "acts_ns,target,quantity,value\n300000000,a,force_x,2\n310000000,a,force_x,3\n"
       "2000000000,a,force_y,-1\n"},
      {"run/a-talker.out.log", "one\nmark: two\nthree"},
      {"run/output.csv",
       "time_ns,client,stream,begin,end\n100000000,a/talker,out,0,6\n"
       "200000000,a/talker,out,6,14\n"},
      {"run/dispatches.csv",
       "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns\n"
       "dynamics,0,1000000,0,2000\na/talker,1000000,2000000,2000,9000\n"}};
  for (const std::size_t piece : {7u, 61u, 4096u}) {
    std::filesystem::remove_all(root_);
    LiveRun run(folder());
    std::size_t longest = 0;
    for (const auto& [name, text] : files) {
      Write(name, "");
      longest = std::max(longest, text.size());
    }
    for (std::size_t at = 0; at < longest; at += piece) {
      for (const auto& [name, text] : files) {
        if (at < text.size()) Append(name, text.substr(at, piece));
      }
      run.Look();
    }
    run.Look();
    std::vector<std::string> warnings;
    auto read = ReadReplay(folder(), "run", 2.98, kRoom, &warnings);
    Json whole = ToJson(std::get<Replay>(read)), live = run.NewsSince({})["replay"];
    // What has no end of line is not there yet.
    EXPECT_EQ(whole["said"].size(), 3u);
    whole["said"].erase(2);
    const auto sorted = [](Json* json) {
      std::sort((*json)["signals"].begin(), (*json)["signals"].end(),
                [](const Json& a, const Json& b) {
                  return a["panel"].get<std::string>() + a["name"].get<std::string>() <
                         b["panel"].get<std::string>() + b["name"].get<std::string>();
                });
    };
    sorted(&whole);
    sorted(&live);
    EXPECT_EQ(whole, live) << piece;
    EXPECT_EQ(live["contacts"]["pairs"][0][1], "floor");
    EXPECT_EQ(run.place().slices, 2u);
  }
}

TEST_F(LiveRunTest, AnotherRunInTheFolderIsAnotherGeneration) {
  Write("run/bodies.csv", kHead + Lines(0, 50));
  LiveRun run(folder());
  run.Look();
  run.Look();
  const LiveRun::Place have = run.place();
  // It keeps its place on the disk, so that the other one has another place.
  std::filesystem::rename(root_ / "run/bodies.csv", root_ / "run/other");
  Write("run/bodies.csv", kHead + Lines(0, 3));
  for (int i = 0; i < 3; ++i) run.Look();
  const Json news = run.NewsSince(have);
  EXPECT_NE(news["generation"], have.generation);
  EXPECT_EQ(news["from"]["moments"], 0);
  EXPECT_EQ(Moments(news), 2u);
}

TEST_F(LiveRunTest, WhatThereIsTooMuchOfIsMadeCoarser) {
  Write("run/bodies.csv", kHead);
  LiveRun run(folder());
  run.Look();
  const auto generation = run.place().generation;
  Append("run/bodies.csv", Lines(0, 250'000));
  run.Look();
  run.Look();
  EXPECT_NE(run.place().generation, generation);
  EXPECT_LT(run.place().moments, 105'000u);
  EXPECT_GT(run.place().moments, 50'000u);
  EXPECT_NEAR(run.LastS(), 2500, 0.1);
  const auto moments = run.place().moments;
  Append("run/bodies.csv", Lines(250'000, 250'100));  // a second, 25 of its moments
  run.Look();
  run.Look();
  EXPECT_NEAR(static_cast<double>(run.place().moments - moments), 25, 1);
}

TEST_F(LiveRunTest, APlaceThatCannotBeGetsEverything) {
  Write("run/bodies.csv", kHead + Lines(0, 5));
  LiveRun run(folder());
  run.Look();
  run.Look();
  LiveRun::Place beyond = run.place();
  beyond.moments = 1'000'000'000;
  EXPECT_EQ(run.NewsSince(beyond)["from"]["moments"], 0);
}

TEST_F(LiveRunTest, ALineThatIsLeftForLaterComesAgainBeforeThoseBehindIt) {
  Write("run/table.csv", "a,b\n1,x\n2,y\n3,z\n");
  CsvTail tail(folder() + "/table.csv", {"a"}, 1);
  std::vector<std::string> taken;
  int most = 2;
  const auto take = [&](const CsvFields& fields) {
    if (most-- == 0) return CsvTail::Taken::kLater;
    taken.emplace_back(fields[0]);
    return CsvTail::Taken::kYes;
  };
  EXPECT_EQ(tail.Look(take), CsvTail::Found::kMore);
  EXPECT_THAT(taken, ElementsAre("1", "2"));
  most = 9;
  EXPECT_EQ(tail.Look(take), CsvTail::Found::kMore);
  EXPECT_THAT(taken, ElementsAre("1", "2", "3"));
}

}  // namespace
}  // namespace tcs::report
