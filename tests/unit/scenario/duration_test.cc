#include "coordinator/scenario/duration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace tcs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::int64_t Ns(std::string_view text) {
  const auto result = ParseDuration(text);
  if (const auto* error = std::get_if<LoadError>(&result)) {
    ADD_FAILURE() << error->message;
    return -1;
  }
  return std::get<VirtualDuration>(result).ns();
}

std::string ComplaintAbout(std::string_view text) {
  const auto result = ParseDuration(text);
  const auto* error = std::get_if<LoadError>(&result);
  return error != nullptr ? error->message : "";
}

TEST(Duration, HasAUnitOrIsInSeconds) {
  EXPECT_EQ(Ns("7ns"), 7);
  EXPECT_EQ(Ns("7us"), 7'000);
  EXPECT_EQ(Ns("7µs"), 7'000);
  EXPECT_EQ(Ns("7ms"), 7'000'000);
  EXPECT_EQ(Ns("7s"), 7'000'000'000);
  EXPECT_EQ(Ns("7min"), 420'000'000'000);
  EXPECT_EQ(Ns("7h"), 25'200'000'000'000);
  EXPECT_EQ(Ns("7"), 7'000'000'000);
}

TEST(Duration, MayBeSpacedAndFractional) {
  EXPECT_EQ(Ns("1.5 s"), 1'500'000'000);
  EXPECT_EQ(Ns("  +.25ms "), 250'000);
  EXPECT_EQ(Ns("3.s"), 3'000'000'000);
  EXPECT_EQ(Ns("1e-3"), 1'000'000);
  EXPECT_EQ(Ns("2.5E+1 ms"), 25'000'000);
  EXPECT_EQ(Ns("0"), 0);
  EXPECT_EQ(Ns("0.000ns"), 0);
}

TEST(Duration, IsExactToTheNanosecond) {
  EXPECT_EQ(Ns("0.1"), 100'000'000);
  EXPECT_EQ(Ns("0.3"), 300'000'000);
  EXPECT_EQ(Ns("4294967296.000000001"), 4'294'967'296'000'000'001);
  EXPECT_EQ(Ns("1.10000000000000000000000000000000000000"), 1'100'000'000);
  EXPECT_EQ(Ns("0.0000000000025h"), 9);
  EXPECT_EQ(Ns("0.00000000005min"), 3);
}

TEST(Duration, ThatIsNoDurationIsExplained) {
  EXPECT_THAT(ComplaintAbout(""), HasSubstr("is not a duration; write it like 20s"));
  EXPECT_THAT(ComplaintAbout("soon"), HasSubstr("'soon' is not a duration"));
  EXPECT_THAT(ComplaintAbout("."), HasSubstr("is not a duration"));
  EXPECT_THAT(ComplaintAbout("1e"), HasSubstr("is not a duration"));
  EXPECT_THAT(ComplaintAbout("1e99999999999"), HasSubstr("is not a duration"));
  EXPECT_THAT(ComplaintAbout("nan"), HasSubstr("is not a duration"));
  EXPECT_THAT(ComplaintAbout("-1s"), HasSubstr("must not be negative"));
}

TEST(Duration, WithAnUnknownUnitListsTheUnits) {
  EXPECT_THAT(ComplaintAbout("10 sec"),
              AllOf(HasSubstr("unknown unit 'sec'"), HasSubstr("ns, us, ms, s, min or h")));
  EXPECT_THAT(ComplaintAbout("1s2"), HasSubstr("unknown unit 's2'"));
  EXPECT_THAT(ComplaintAbout("0x10"), HasSubstr("unknown unit 'x10'"));
  EXPECT_THAT(ComplaintAbout("1 5ms"), HasSubstr("unknown unit '5ms'"));
}

TEST(Duration, FinerThanANanosecondIsAnError) {
  EXPECT_THAT(ComplaintAbout("0.5ns"), HasSubstr("not a whole number of nanoseconds"));
  EXPECT_THAT(ComplaintAbout("1.0000000001s"), HasSubstr("not a whole number of nanoseconds"));
  EXPECT_THAT(ComplaintAbout("0.1111111111111111111111111111111111111111"),
              HasSubstr("not a whole number of nanoseconds"));
  EXPECT_THAT(ComplaintAbout("1e-300"), HasSubstr("not a whole number of nanoseconds"));
}

TEST(Duration, OfMoreThan146YearsIsAnError) {
  EXPECT_EQ(Ns("4611686018427387904ns"), kLongestDuration.ns());
  EXPECT_THAT(ComplaintAbout("4611686018427387905ns"), HasSubstr("too long"));
  EXPECT_THAT(ComplaintAbout("99999999999999999999999999999999999999999"), HasSubstr("too long"));
  EXPECT_THAT(ComplaintAbout("1e300"), HasSubstr("too long"));
  EXPECT_THAT(ComplaintAbout("2000000h"), HasSubstr("too long"));
}

}  // namespace
}  // namespace tcs
