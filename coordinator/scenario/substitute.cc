#include "coordinator/scenario/substitute.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

namespace tcs {
namespace {

std::string Lookup(const YamlValue& value, const std::string& name, const Variables& variables) {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  if (name.empty() || name.find_first_not_of(kAllowed) != std::string::npos) {
    value.Fail("contains '${" + name + "}', which names no variable; write $${ for a literal ${");
  }
  if (name == "seed") return std::to_string(variables.seed);
  if (name == "scenario_dir") return variables.scenario_directory;
  if (name == "result_dir") return variables.result_directory;
  if (name == "run") return RunName(variables.run);
  if (name == "loopback") return LoopbackAddressOf(variables.run);
  const char* found = std::getenv(name.c_str());
  if (found == nullptr) {
    value.Fail("uses ${" + name + "}, which is not set; set that environment variable, or write " +
               "$${ for a literal ${");
  }
  return found;
}

}  // namespace

std::string RunName(std::uint32_t run) { return fmt::format("{:08x}", run); }

// The address has as many digits whatever the run: a program's memory shows how long its arguments
// are.
std::string LoopbackAddressOf(std::uint32_t run) {
  constexpr std::uint32_t kFirst = 100, kCount = 156;
  const auto part = [&run] {
    const std::uint32_t value = kFirst + run % kCount;
    run /= kCount;
    return value;
  };
  const std::uint32_t last = part(), middle = part(), first = part();
  return fmt::format("127.{}.{}.{}", first, middle, last);
}

std::string Substitute(const YamlValue& value, const Variables& variables) {
  const std::string text = value.AsText();
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 3, "$${") == 0) {
      result += "${";
      i += 3;
    } else if (text.compare(i, 2, "${") == 0) {
      const std::size_t end = text.find('}', i);
      if (end == std::string::npos) {
        value.Fail("contains '${' without '}'; close it, or write $${ for a literal ${");
      }
      result += Lookup(value, text.substr(i + 2, end - i - 2), variables);
      i = end + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

}  // namespace tcs
