#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "coordinator/metrics/expression.h"

namespace tcs {

namespace {

constexpr std::size_t kLongestExpression = 1000;
constexpr int kDeepestNesting = 16;
constexpr std::size_t kMostOfNorm = 16;

bool IsSpaceChar(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool IsNumeral(char c) { return c >= '0' && c <= '9'; }
bool BeginsName(char c) {
  return IsNumeral(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool IsInName(char c) { return BeginsName(c) || c == '.' || c == '/' || c == '-'; }

// The exception that ends the parsing; it never leaves this file.
struct ParseMistake {
  std::string sentence;
};

}  // namespace

// Parses by recursive descent. The function of a part appends the part's steps, and says whether
// the part is a known number.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, ExpressionNames& names) : text_(text), names_(names) {}

  std::variant<Expression, std::string> Parse(bool is_condition) {
    try {
      if (text_.size() > kLongestExpression) {
        Fail(fmt::format("it is longer than {} characters", kLongestExpression));
      }
      if (AtEnd()) Fail("it is empty; write something like drone.z - 1.0");
      Sum();
      if (is_condition) {
        Comparison();
      } else if (!AtEnd() && (text_[at_] == '<' || text_[at_] == '>')) {
        Fail("it is a condition, and a value is wanted; conditions are for first_time_when");
      }
      if (!AtEnd()) Unexpected("an operator, or the end");
      return std::move(made_);
    } catch (const ParseMistake& mistake) {
      return mistake.sentence;
    }
  }

 private:
  using Kind = Expression::Kind;
  // The number that a part is, if it is made of numbers alone.
  using Known = std::optional<double>;

  [[noreturn]] static void Fail(std::string sentence) { throw ParseMistake{std::move(sentence)}; }

  [[noreturn]] void Unexpected(std::string_view wanted) {
    if (AtEnd()) Fail(fmt::format("it ends where {} is wanted", wanted));
    std::size_t end = at_ + 1;
    while (end < text_.size() && IsInName(text_[at_]) && IsInName(text_[end])) ++end;
    Fail(fmt::format("'{}' stands where {} is wanted", text_.substr(at_, end - at_), wanted));
  }

  bool AtEnd() {
    while (at_ < text_.size() && IsSpaceChar(text_[at_])) ++at_;
    return at_ == text_.size();
  }

  bool Take(std::string_view token) {
    if (AtEnd() || !text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }

  void Emit(Kind kind, double number = 0, std::size_t count = 0) {
    switch (kind) {
      case Kind::kNumber:
      case Kind::kValue:
        ++kept_;
        break;
      case Kind::kNegate:
        break;
      case Kind::kNorm:
        kept_ -= count - 1;
        break;
      default:
        --kept_;
    }
    if (kept_ > Expression::kMostKept) Fail("it has too many parts at once; make it simpler");
    made_.steps_.push_back({kind, number, count});
  }

  // Puts `value` in the place of the steps from `from` on, which are of numbers alone.
  Known Fold(std::size_t from, double value) {
    if (!std::isfinite(value)) Fail("a number in it is too large");
    made_.steps_.resize(from);
    made_.steps_.push_back({Kind::kNumber, value, 0});
    return value;
  }

  void Comparison() {
    static constexpr std::pair<std::string_view, Kind> kComparisons[] = {{"<=", Kind::kLessOrEqual},
                                                                         {">=", Kind::kMoreOrEqual},
                                                                         {"<", Kind::kLess},
                                                                         {">", Kind::kMore}};
    for (const auto& [token, kind] : kComparisons) {
      if (!Take(token)) continue;
      Sum();
      Emit(kind);
      return;
    }
    Unexpected("a comparison (<, <=, > or >=)");
  }

  Known Sum() {
    const std::size_t from = made_.steps_.size();
    Known sum = Product();
    for (;;) {
      const bool adds = Take("+");
      if (!adds && !Take("-")) return sum;
      const Known more = Product();
      Emit(adds ? Kind::kAdd : Kind::kSubtract);
      sum = sum && more ? Fold(from, adds ? *sum + *more : *sum - *more) : Known();
    }
  }

  Known Product() {
    const std::size_t from = made_.steps_.size();
    Known product = Factor();
    for (;;) {
      if (Take("*")) {
        const Known more = Factor();
        Emit(Kind::kMultiply);
        product = product && more ? Fold(from, *product * *more) : Known();
      } else if (Take("/")) {
        const std::size_t divisor_from = made_.steps_.size();
        const Known divisor = Factor();
        if (!divisor || *divisor == 0) {
          Fail("it divides by something that is no number other than 0; multiply instead");
        }
        Fold(divisor_from, 1 / *divisor);
        Emit(Kind::kMultiply);
        product = product ? Fold(from, *product / *divisor) : Known();
      } else {
        return product;
      }
    }
  }

  // One nesting level deeper, as long as the object exists.
  class Deeper {
   public:
    explicit Deeper(int* depth) : depth_(*depth) {
      if (++depth_ > kDeepestNesting) {
        --depth_;
        Fail(fmt::format("it is nested more than {} deep; make it simpler", kDeepestNesting));
      }
    }
    ~Deeper() { --depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

   private:
    int& depth_;
  };

  Known Factor() {
    const Deeper deeper(&depth_);
    const std::size_t from = made_.steps_.size();
    if (Take("-")) {
      const Known negated = Factor();
      Emit(Kind::kNegate);
      return negated ? Fold(from, -*negated) : Known();
    }
    if (Take("+")) return Factor();
    if (Take("(")) {
      const Known sum = Sum();
      Close();
      return sum;
    }
    if (AtEnd()) Unexpected("a quantity or a number");
    if (const Known number = Number()) {
      Emit(Kind::kNumber, *number);
      return number;
    }
    if (!BeginsName(text_[at_])) Unexpected("a quantity or a number");
    const std::string_view name = Name();
    if (Take("(")) {
      Call(name);
    } else {
      Quantity(name);
    }
    return {};
  }

  void Close() {
    if (!Take(")")) Unexpected("',' or ')'");
  }

  // A word that begins like a number may be a name ("2nd.x"), if it goes on like a name.
  Known Number() {
    if (AtEnd() || (!IsNumeral(text_[at_]) && text_[at_] != '.')) return {};
    double number = 0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), number);
    if (end == begin) return {};
    const auto after = at_ + static_cast<std::size_t>(end - begin);
    if (after < text_.size() && text_[after] != '-' && text_[after] != '/' &&
        IsInName(text_[after])) {
      return {};
    }
    if (error != std::errc()) {
      Fail(
          fmt::format("the number '{}' is too large or too small", text_.substr(at_, after - at_)));
    }
    at_ = after;
    return number;
  }

  std::string_view Name() {
    const std::size_t from = at_;
    while (at_ < text_.size() && IsInName(text_[at_])) ++at_;
    // "a - b" and "a -b" are differences, and so is "a- b".
    while (at_ > from + 1 && (text_[at_ - 1] == '-' || text_[at_ - 1] == '/')) --at_;
    return text_.substr(from, at_ - from);
  }

  // Takes the longest name that exists: names may have a '-' or a '/' in them.
  void Quantity(std::string_view name) {
    auto found = names_.ValueOf(name);
    for (std::size_t sign = name.find_last_of("-/");
         std::holds_alternative<std::string>(found) && sign != std::string_view::npos && sign > 0;
         sign = name.find_last_of("-/", sign - 1)) {
      auto shorter = names_.ValueOf(name.substr(0, sign));
      if (std::holds_alternative<std::string>(shorter)) continue;
      at_ -= name.size() - sign;
      found = shorter;
    }
    if (const auto* sentence = std::get_if<std::string>(&found)) Fail(*sentence);
    Emit(Kind::kValue, 0, std::get<std::size_t>(found));
  }

  void Call(std::string_view function) {
    if (function == "norm" || function == "abs") {
      std::size_t count = 0;
      do {
        Sum();
        if (++count > kMostOfNorm) {
          Fail(fmt::format("norm has more than {} parts", kMostOfNorm));
        }
      } while (function == "norm" && Take(","));
      Close();
      Emit(Kind::kNorm, 0, count);
    } else if (function == "distance") {
      const std::array<std::size_t, 3> a = Place();
      if (!Take(",")) Unexpected("',' and the other place");
      const std::array<std::size_t, 3> b = Place();
      Close();
      for (std::size_t i = 0; i < 3; ++i) {
        Emit(Kind::kValue, 0, a[i]);
        Emit(Kind::kValue, 0, b[i]);
        Emit(Kind::kSubtract);
      }
      Emit(Kind::kNorm, 0, 3);
    } else {
      Fail(fmt::format("there is no function '{}'; there are norm, distance and abs", function));
    }
  }

  std::array<std::size_t, 3> Place() {
    if (AtEnd() || !BeginsName(text_[at_])) Unexpected("the name of a body");
    auto found = names_.PlaceOf(Name());
    if (auto* sentence = std::get_if<std::string>(&found)) Fail(std::move(*sentence));
    return std::get<std::array<std::size_t, 3>>(found);
  }

  std::string_view text_;
  ExpressionNames& names_;
  Expression made_;
  std::size_t at_ = 0, kept_ = 0;
  int depth_ = 0;
};

std::variant<Expression, std::string> ParseExpression(std::string_view text,
                                                      ExpressionNames& names) {
  return ExpressionParser(text, names).Parse(false);
}

std::variant<Expression, std::string> ParseCondition(std::string_view text,
                                                     ExpressionNames& names) {
  return ExpressionParser(text, names).Parse(true);
}

}  // namespace tcs
