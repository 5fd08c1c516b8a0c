// Sums, differences, products, norms and distances of the quantities of a run, as a scenario writes
// them: `norm(rover.x, rover.y) - 1.5`. Pure: ExpressionNames knows what a name stands for.
//
//   condition := sum ('<' | '<=' | '>' | '>=') sum
//   sum       := product (('+' | '-') product)*
//   product   := factor (('*' | '/') factor)*         what divides is a number, and not 0
//   factor    := ('-' | '+') factor | number | name | '(' sum ')'
//              | 'norm' '(' sum (',' sum)* ')' | 'abs' '(' sum ')' | 'distance' '(' name ',' name
//              ')'
//
// A name is of letters, digits, '_', '.', '/' and '-', and the longest name that exists is meant:
// `a-b.x` is one quantity if there is such a thing, and `a.x-1` a difference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tcs {

// The quantities that names stand for.
class ExpressionNames {
 public:
  virtual ~ExpressionNames() = default;
  // The index of the quantity's value among the values that Evaluate is given; or why there is no
  // such quantity, as a sentence.
  [[nodiscard]] virtual std::variant<std::size_t, std::string> ValueOf(std::string_view name) = 0;
  // The same, for the x, y and z of a body or another thing that has a place.
  [[nodiscard]] virtual std::variant<std::array<std::size_t, 3>, std::string> PlaceOf(
      std::string_view name) = 0;
};

class Expression {
 public:
  // The expression's value, given the values of the quantities; of a condition 1 or 0. The result
  // may be infinite, or no number, where the quantities' values are.
  [[nodiscard]] double Evaluate(std::span<const double> values) const;
  // The indices of the values that the expression needs.
  [[nodiscard]] std::vector<std::size_t> Needs() const;

 private:
  friend class ExpressionParser;
  enum class Kind : std::uint8_t {
    kNumber,
    kValue,
    kAdd,
    kSubtract,
    kMultiply,
    kNegate,
    kNorm,
    kLess,
    kLessOrEqual,
    kMore,
    kMoreOrEqual
  };
  struct Step {
    Kind kind;
    double number = 0;      // of kNumber
    std::size_t count = 0;  // which value; of kNorm, of how many
  };
  // The most numbers that are kept at a time while the expression is evaluated.
  static constexpr std::size_t kMostKept = 64;
  std::vector<Step> steps_;  // each step takes its operands from the steps before, last first
};

// Either the expression, or what is wrong with the text, as a sentence. Whatever the text, parsing
// takes little memory and no deep recursion.
[[nodiscard]] std::variant<Expression, std::string> ParseExpression(std::string_view text,
                                                                    ExpressionNames& names);
[[nodiscard]] std::variant<Expression, std::string> ParseCondition(std::string_view text,
                                                                   ExpressionNames& names);

}  // namespace tcs
