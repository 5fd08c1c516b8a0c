#include "coordinator/trials/record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "coordinator/trials/results.h"

namespace tcs {
namespace {

using ::testing::HasSubstr;

TrialsRecord SomeRecord() {
  TrialsRecord record;
  record.plan.scenario = "/home/me/chase.yaml";
  record.plan.name = "callback on ODE";
  record.plan.first_seed = ~std::uint64_t{0} - 9;
  record.plan.trials = 10;
  record.plan.options = {"callback", "fixed", "20s", "2ms", {"a=1"}};
  record.plan.vary = {Vary{"csv_period", {"1ms", "10ms"}}};
  record.scenario_hash = "0123456789abcdef";
  record.programs = {{"/home/me/planner", "11"}};
  return record;
}

TEST(TrialsRecordTest, ComesBackAsItWasWritten) {
  const auto read = RecordFromJson(ToJson(SomeRecord()));
  ASSERT_TRUE(std::holds_alternative<TrialsRecord>(read)) << std::get<std::string>(read);
  EXPECT_EQ(ToJson(std::get<TrialsRecord>(read)), ToJson(SomeRecord()));
  EXPECT_EQ(WhatDiffers(SomeRecord(), std::get<TrialsRecord>(read)), "");
}

TEST(TrialsRecordTest, OneWithoutVaryComesBack) {
  TrialsRecord record = SomeRecord();
  record.plan.vary.clear();
  EXPECT_THAT(ToJson(record), HasSubstr("\"vary\": null"));
  EXPECT_TRUE(std::get<TrialsRecord>(RecordFromJson(ToJson(record))).plan.vary.empty());
}

TEST(TrialsRecordTest, AGridComesBackAndOneKeyIsWrittenAsEver) {
  TrialsRecord record = SomeRecord();
  EXPECT_THAT(ToJson(record), HasSubstr("\"vary\": {\n    \"key\": \"csv_period\""));
  record.plan.vary.push_back({"drift", {"1ms"}});
  EXPECT_THAT(ToJson(record), HasSubstr("\"vary\": [\n"));
  const auto read = std::get<TrialsRecord>(RecordFromJson(ToJson(record)));
  ASSERT_EQ(read.plan.vary.size(), 2u);
  EXPECT_EQ(read.plan.vary[1].key, "drift");
  EXPECT_EQ(WhatDiffers(SomeRecord(), record),
            "was made with --vary csv_period, not csv_period drift");
}

TEST(TrialsRecordTest, ResultsStandBesideTheRecordAndAreReplaced) {
  TrialsRecord record = SomeRecord();
  const TrialResult result{TrialsOf(record.plan).front(),
                           {{"r/p.misses", {3, MeasureUnit::kCount, WorseWhen::kMore, false}},
                            {"r/p.missed", {0.5, MeasureUnit::kShare, WorseWhen::kMore, true}}}};
  const std::string once = WithResults(ToJson(record), record.plan, {result});
  EXPECT_THAT(
      once, HasSubstr("\"values\":[\"1ms\"],\"measures\":{\"r/p.missed\":0.5,\"r/p.misses\":3}}"));
  EXPECT_EQ(WithResults(once, record.plan, {result}), once);
  EXPECT_EQ(ToJson(std::get<TrialsRecord>(RecordFromJson(once))), ToJson(record));
  EXPECT_THAT(WithResults(once, record.plan, {}), HasSubstr("\"results\": []\n}\n"));
  EXPECT_EQ(WithResults("no record", record.plan, {result}), "no record");
}

TEST(TrialsRecordTest, OtherTextIsNone) {
  for (const char* text : {"", "{", "[]", "{}", R"({"scenario": 1})"}) {
    EXPECT_TRUE(std::holds_alternative<std::string>(RecordFromJson(text))) << text;
  }
}

TEST(TrialsRecordTest, MoreTrialsValuesAndANameBelongTogether) {
  TrialsRecord now = SomeRecord();
  now.plan.trials = 20;
  now.plan.name = "tcs";
  now.plan.vary[0].values.push_back("100ms");
  EXPECT_EQ(WhatDiffers(SomeRecord(), now), "");
}

TEST(TrialsRecordTest, WhateverDeterminesAnOutcomeIsNamedWhenItDiffers) {
  const auto differs = [](auto change) {
    TrialsRecord now = SomeRecord();
    change(&now);
    return WhatDiffers(SomeRecord(), now);
  };
  EXPECT_EQ(differs([](auto* r) { r->plan.options.sync = "consistent"; }),
            "was made with --sync callback, not consistent");
  EXPECT_EQ(differs([](auto* r) { r->plan.options.accounting = "measured"; }),
            "was made with --accounting fixed, not measured");
  EXPECT_EQ(differs([](auto* r) { r->plan.options.duration = "21s"; }),
            "was made with --duration 20s, not 21s");
  EXPECT_EQ(differs([](auto* r) { r->plan.options.drift.clear(); }), "was made with --drift 2ms");
  EXPECT_EQ(differs([](auto* r) { r->plan.options.set.push_back("b=2"); }),
            "was made with --set a=1, not a=1 b=2");
  EXPECT_EQ(differs([](auto* r) { r->plan.vary[0].key = "drift"; }),
            "was made with --vary csv_period, not drift");
  EXPECT_THAT(differs([](auto* r) { r->plan.first_seed = 1; }), HasSubstr("--first-seed"));
  EXPECT_THAT(differs([](auto* r) { r->scenario_hash = "0"; }), HasSubstr("before it was changed"));
  EXPECT_THAT(differs([](auto* r) { r->plan.scenario = "/b.yaml"; }), HasSubstr("chase.yaml"));
}

TEST(TrialsRecordTest, AProgramThatChangedIsKnown) {
  TrialsRecord now = SomeRecord();
  EXPECT_EQ(ChangedProgram(SomeRecord(), now), "");
  now.programs["/home/me/planner"] = "12";
  EXPECT_EQ(ChangedProgram(SomeRecord(), now), "/home/me/planner");
}

TEST(TrialsRecordTest, AFilesHashDependsOnEachByteOfIt) {
  std::string path = ::testing::TempDir() + "hashed.XXXXXX";
  const int fd = mkstemp(path.data());
  ASSERT_GE(fd, 0);
  close(fd);
  const auto hash_of = [&path](const std::string& text) {
    std::ofstream(path) << text;
    return HashOfFile(path);
  };
  const std::string text(200'000, 'x');
  std::string other = text;
  other[150'000] = 'y';
  EXPECT_EQ(hash_of(""), "cbf29ce484222325");
  EXPECT_EQ(hash_of("foobar"), "85944171f73967e8");  // of FNV's authors
  EXPECT_EQ(hash_of(text), hash_of(text));
  EXPECT_NE(hash_of(text), hash_of(other));
  unlink(path.c_str());
  EXPECT_EQ(HashOfFile(path), "");
}

}  // namespace
}  // namespace tcs
