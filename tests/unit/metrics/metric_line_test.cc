// What a program may print of a metric, and what is said of what it may not.
#include "coordinator/metrics/metric_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using testing::HasSubstr;

MetricLine Parsed(std::string_view line) {
  auto parsed = ParseMetricLine(line);
  if (const auto* why = std::get_if<std::string>(&parsed)) {
    ADD_FAILURE() << line << ": " << *why;
    return {};
  }
  return std::get<MetricLine>(parsed);
}

std::string RefusedLine(std::string_view line) {
  auto parsed = ParseMetricLine(line);
  const auto* why = std::get_if<std::string>(&parsed);
  return why == nullptr ? "" : *why;
}

TEST(MetricLineTest, IsOneIfItBeginsWithTheWord) {
  EXPECT_TRUE(IsMetricLine("tcs-metric error 0.25"));
  EXPECT_TRUE(IsMetricLine("tcs-metric\terror 0.25"));
  EXPECT_TRUE(IsMetricLine("tcs-metric"));
  EXPECT_FALSE(IsMetricLine("tcs-metrics error 0.25"));
  EXPECT_FALSE(IsMetricLine(" tcs-metric error 0.25"));
  EXPECT_FALSE(IsMetricLine("tcs-metri"));
  EXPECT_FALSE(IsMetricLine(""));
}

TEST(MetricLineTest, HasANameAndAValue) {
  const MetricLine line = Parsed("tcs-metric arm/tip.error-1_x  -2.5e-3\r");
  EXPECT_EQ(line.name, "arm/tip.error-1_x");
  EXPECT_EQ(line.value, -2.5e-3);
  EXPECT_FALSE(line.reading_ns.has_value());
  EXPECT_EQ(Parsed("tcs-metric n +7").value, 7);
  EXPECT_EQ(Parsed("tcs-metric n 0").value, 0);
  EXPECT_EQ(Parsed("tcs-metric n 1e-400").value, 0);
}

TEST(MetricLineTest, MayHaveATimeWhichIsExact) {
  const auto time_of = [](const std::string& time) {
    return Parsed("tcs-metric n 1 " + time).reading_ns.value_or(-1);
  };
  EXPECT_EQ(time_of("1.5"), 1'500'000'000);
  EXPECT_EQ(time_of("0"), 0);
  EXPECT_EQ(time_of("12s"), 12'000'000'000);
  EXPECT_EQ(time_of("40ms"), 40'000'000);
  EXPECT_EQ(time_of("0.25us"), 250);
  EXPECT_EQ(time_of("7ns"), 7);
  // A double would not hold these nanoseconds.
  EXPECT_EQ(time_of("1704067200.123456789"), 1'704'067'200'123'456'789);
  EXPECT_EQ(time_of("1704067200123456789"), 1'704'067'200'123'456'789);
  EXPECT_EQ(time_of("1000123456789"), 1'000'123'456'789);
  // To the nearest one: what Python makes of 1000.1.
  EXPECT_EQ(time_of("1000.1000000000000227"), 1'000'100'000'000);
  EXPECT_EQ(time_of("0.0000000005"), 1);
  EXPECT_EQ(time_of("0.00000000000000000000000000049"), 0);
}

TEST(MetricLineTest, IsToldWhatIsWrongWithIt) {
  EXPECT_THAT(RefusedLine("tcs-metric"), HasSubstr("no name"));
  EXPECT_THAT(RefusedLine("tcs-metric error"), HasSubstr("no value for error"));
  EXPECT_THAT(RefusedLine("tcs-metric a,b 1"), HasSubstr("the name 'a,b'"));
  EXPECT_THAT(RefusedLine("tcs-metric " + std::string(65, 'a') + " 1"), HasSubstr("64 letters"));
  for (const char* value : {"3,5", "nan", "inf", "-inf", "1e200", "0x10", "1.5m", "--1", "+-1"}) {
    EXPECT_THAT(RefusedLine("tcs-metric a " + std::string(value)), HasSubstr("no finite number"))
        << value;
  }
  for (const char* time : {"now", "1.5h", "-1", ".", "1..5", "1e3", "99999999999999999999s"}) {
    EXPECT_THAT(RefusedLine("tcs-metric a 1 " + std::string(time)), HasSubstr("the time")) << time;
  }
  EXPECT_THAT(RefusedLine("tcs-metric a 1 2 3"), HasSubstr("'3' behind"));
  EXPECT_THAT(RefusedLine("tcs-metric a 1" + std::string(600, ' ')), HasSubstr("512 bytes"));
  // What a terminal would obey is not repeated.
  EXPECT_EQ(RefusedLine("tcs-metric a\x1b[2J 1").find('\x1b'), std::string::npos);
}

TEST(MetricLineTest, ItsTimeIsThatOfAnyClockOfTheProgram) {
  const std::int64_t s = 1'000'000'000;
  const ProgramClocks clocks{
      .monotonic_ns = 1000 * s, .realtime_ns = 1'704'067'200 * s, .duration_ns = 20 * s};
  EXPECT_EQ(VirtualTimeOfReading(3 * s, 4 * s, clocks), 3 * s);
  EXPECT_EQ(VirtualTimeOfReading(1003 * s, 4 * s, clocks), 3 * s);
  EXPECT_EQ(VirtualTimeOfReading(1'704'067'203 * s, 4 * s, clocks), 3 * s);
  EXPECT_EQ(VirtualTimeOfReading(500 * s, 4 * s, clocks), std::nullopt);
  EXPECT_EQ(VirtualTimeOfReading(1021 * s, 20 * s, clocks), 20 * s) << "while it ends";
  EXPECT_EQ(VirtualTimeOfReading(1100 * s, 20 * s, clocks), std::nullopt);
  EXPECT_EQ(VirtualTimeOfReading(0, 4 * s, clocks), 0);
  // Of a long run, what is nearest to the write.
  const ProgramClocks of_hour{
      .monotonic_ns = 1000 * s, .realtime_ns = 1'704'067'200 * s, .duration_ns = 3600 * s};
  EXPECT_EQ(VirtualTimeOfReading(1003 * s, 1004 * s, of_hour), 1003 * s);
  EXPECT_EQ(VirtualTimeOfReading(1003 * s, 4 * s, of_hour), 3 * s);
}

}  // namespace
}  // namespace tcs
