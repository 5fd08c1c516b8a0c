// What scenarios may write of their quantities, and that no text is too much.
#include "coordinator/metrics/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// a.x, a.y, a.z, b.x, b.y, b.z and a-b.x, at the places of kValues.
constexpr std::array kValues = {1.0, 2.0, 3.0, 4.0, 6.0, 3.0, 50.0};

class TwoBodies final : public ExpressionNames {
 public:
  std::variant<std::size_t, std::string> ValueOf(std::string_view name) override {
    static constexpr std::array<std::string_view, 7> kNames = {"a.x", "a.y", "a.z",  "b.x",
                                                               "b.y", "b.z", "a-b.x"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (kNames[i] == name) return i;
    }
    return "there is no quantity '" + std::string(name) + "'";
  }
  std::variant<std::array<std::size_t, 3>, std::string> PlaceOf(std::string_view name) override {
    if (name == "a") return std::array<std::size_t, 3>{0, 1, 2};
    if (name == "b") return std::array<std::size_t, 3>{3, 4, 5};
    return "there is no body '" + std::string(name) + "'";
  }
};

double Value(std::string_view text) {
  TwoBodies names;
  auto parsed = ParseExpression(text, names);
  if (const auto* why = std::get_if<std::string>(&parsed)) {
    ADD_FAILURE() << text << ": " << *why;
    return -1;
  }
  return std::get<Expression>(parsed).Evaluate(kValues);
}

double Holds(std::string_view text) {
  TwoBodies names;
  auto parsed = ParseCondition(text, names);
  if (const auto* why = std::get_if<std::string>(&parsed)) {
    ADD_FAILURE() << text << ": " << *why;
    return -1;
  }
  return std::get<Expression>(parsed).Evaluate(kValues);
}

std::string Refused(std::string_view text, bool is_condition = false) {
  TwoBodies names;
  auto parsed = is_condition ? ParseCondition(text, names) : ParseExpression(text, names);
  const auto* why = std::get_if<std::string>(&parsed);
  return why == nullptr ? "" : *why;
}

TEST(ExpressionTest, AddsAndSubtracts) {
  EXPECT_EQ(Value("a.z"), 3);
  EXPECT_EQ(Value("a.z - 1.0"), 2);
  EXPECT_EQ(Value("b.x-1"), 3);
  EXPECT_EQ(Value("a.x - a.y - a.z"), -4);
  EXPECT_EQ(Value("a.x - (a.y - a.z)"), 2);
  EXPECT_EQ(Value(" -a.x + +2 "), 1);
  EXPECT_EQ(Value("2 - -1"), 3);
}

TEST(ExpressionTest, MultipliesFirst) {
  EXPECT_EQ(Value("2 * a.z + 1"), 7);
  EXPECT_EQ(Value("1 + a.z * 2"), 7);
  EXPECT_EQ(Value("a.y * a.z"), 6);
  EXPECT_EQ(Value("a.y / 4"), 0.5);
  EXPECT_EQ(Value("(a.x + a.y) * (1 + 1)"), 6);
  EXPECT_EQ(Value("1e1 * .5"), 5);
}

TEST(ExpressionTest, KnowsNormsAndDistances) {
  EXPECT_EQ(Value("norm(b.x - a.x, 4)"), 5);
  EXPECT_EQ(Value("abs(a.x - a.z)"), 2);
  EXPECT_EQ(Value("norm(0 - a.z)"), 3);
  EXPECT_EQ(Value("distance(a, b)"), 5);
  EXPECT_EQ(Value("distance(a,b) - norm(3, 4)"), 0);
}

TEST(ExpressionTest, ComparesInConditions) {
  EXPECT_EQ(Holds("distance(a, b) < 0.3"), 0);
  EXPECT_EQ(Holds("distance(a, b) <= 5"), 1);
  EXPECT_EQ(Holds("a.x + a.y >= a.z"), 1);
  EXPECT_EQ(Holds("a.x>a.y"), 0);
}

TEST(ExpressionTest, TheLongestNameThatThereIsIsMeant) {
  EXPECT_EQ(Value("a-b.x"), 50);
  EXPECT_EQ(Value("a.x - b.x"), -3);
  EXPECT_EQ(Value("a.x- b.x"), -3);
  EXPECT_EQ(Value("a.x -b.x"), -3);
  EXPECT_EQ(Value("a.x-b.x"), -3);
  EXPECT_EQ(Value("b.y/2-a.x-a.y/2"), 1);
  EXPECT_EQ(Value("a-b.x-a.x"), 49);
  EXPECT_THAT(Refused("a.q-b.x"), HasSubstr("'a.q-b.x'"));
}

TEST(ExpressionTest, NeedsWhatItNames) {
  TwoBodies names;
  auto parsed = ParseExpression("b.x + a.y * 2 - b.x", names);
  EXPECT_THAT(std::get<Expression>(parsed).Needs(), ElementsAre(1, 3));
}

TEST(ExpressionTest, SaysWhatIsWrong) {
  EXPECT_THAT(Refused(""), HasSubstr("empty"));
  EXPECT_THAT(Refused("a.q"), HasSubstr("there is no quantity 'a.q'"));
  EXPECT_THAT(Refused("distance(a, c)"), HasSubstr("there is no body 'c'"));
  EXPECT_THAT(Refused("distance(a)"), HasSubstr("')' stands where"));
  EXPECT_THAT(Refused("sin(a.x)"), HasSubstr("no function 'sin'"));
  EXPECT_THAT(Refused("a.x +"), HasSubstr("it ends where a quantity or a number is wanted"));
  EXPECT_THAT(Refused("a.x a.y"), HasSubstr("'a.y' stands where an operator"));
  EXPECT_THAT(Refused("(a.x"), HasSubstr("it ends where ',' or ')'"));
  EXPECT_THAT(Refused("a.x / a.y"), HasSubstr("divides"));
  EXPECT_THAT(Refused("a.x / (1 - 1)"), HasSubstr("divides"));
  EXPECT_THAT(Refused("a.x < 1"), HasSubstr("first_time_when"));
  EXPECT_THAT(Refused("a.x", true), HasSubstr("a comparison"));
  EXPECT_THAT(Refused("a.x < 1 < 2", true), HasSubstr("'<' stands where"));
  EXPECT_THAT(Refused("1e999 * a.x"), HasSubstr("too large"));
  EXPECT_THAT(Refused("1e308 * 1e308"), HasSubstr("too large"));
  EXPECT_THAT(Refused(std::string(1001, ' ')), HasSubstr("longer than 1000"));
  EXPECT_THAT(Refused(std::string(500, '(')), HasSubstr("nested"));
  EXPECT_THAT(Refused(std::string(500, '-') + "1"), HasSubstr("nested"));
}

TEST(ExpressionTest, TakesOrRefusesWhateverIsWritten) {
  static constexpr std::array<std::string_view, 24> kTokens = {
      "a.x", "b.y", "a",  "norm(", "abs(", "distance(", "(", ")", ",", "+", "-", "*",
      "/",   "<",   ">=", "1",     "2.5",  "1e3",       " ", " ", ".", "x", "",  "\xc3\xa9"};
  std::mt19937 random(1);
  int taken = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::string text;
    for (std::size_t i = random() % (round % 10 == 0 ? 300 : 8); i > 0; --i) {
      text += kTokens[random() % kTokens.size()];
    }
    if (round % 3 == 0 && !text.empty()) text[random() % text.size()] = static_cast<char>(random());
    TwoBodies names;
    auto parsed = round % 2 == 0 ? ParseExpression(text, names) : ParseCondition(text, names);
    if (auto* expression = std::get_if<Expression>(&parsed)) {
      ++taken;
      static_cast<void>(expression->Evaluate(kValues));
    } else {
      EXPECT_NE(std::get<std::string>(parsed), "");
    }
  }
  EXPECT_GT(taken, 1000);
}

TEST(ExpressionTest, NestedNormsFitOrAreRefused) {
  std::string text = "a.x";
  for (int depth = 0; depth < 14; ++depth) {
    std::string wider = "norm(";
    for (int i = 0; i < 7; ++i) wider += "1,";
    text = wider + text + ")";
  }
  EXPECT_THAT(Refused(text), HasSubstr("too many parts"));
}

}  // namespace
}  // namespace tcs
