// tcs_fuzz scenarios|results|models|robots COUNT SEED: 0 if all damaged inputs were taken or
// refused in order.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/unit/fuzz/attempt.h"
#include "tests/unit/fuzz/fuzz.h"

namespace tcs::fuzz {

std::optional<std::string> Tally::Count(const std::function<std::string(bool* refused)>& attempt) {
  constexpr char kRefused[] = "refused";
  const std::string outcome = Outcome([&] {
    bool is_refused = false;
    const std::string what = attempt(&is_refused);
    return what.empty() && is_refused ? std::string(kRefused) : what;
  });
  if (outcome.empty()) {
    ++taken;
  } else if (outcome == kRefused) {
    ++refused;
  } else {
    ++wrong;
    return outcome;
  }
  return std::nullopt;
}

std::string TextOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void SayWrong(const std::string& what, int number, const std::string& wrong,
              const std::string& input) {
  const std::string path = "/tmp/tcs_fuzz_" + what + "_" + std::to_string(number);
  std::ofstream(path, std::ios::binary) << input;
  std::fprintf(stderr, "%s %d: %s; the input is in %s\n", what.c_str(), number, wrong.c_str(),
               path.c_str());
}

}  // namespace tcs::fuzz

int main(int argc, char** argv) {
  using tcs::fuzz::Tally;
  const std::map<std::string, Tally (*)(int, std::uint64_t)> kinds = {
      {"scenarios", &tcs::fuzz::FuzzScenarios},
      {"results", &tcs::fuzz::FuzzResults},
      {"models", &tcs::fuzz::FuzzModels},
      {"robots", &tcs::fuzz::FuzzRobots}};
  const auto kind = kinds.find(argc > 1 ? argv[1] : "");
  if (kind == kinds.end()) {
    std::fprintf(stderr, "usage: tcs_fuzz scenarios|results|models|robots COUNT SEED\n");
    return 2;
  }
  const int count = argc > 2 ? atoi(argv[2]) : 300;
  const std::uint64_t seed = argc > 3 ? strtoull(argv[3], nullptr, 10) : 1;
  const Tally tally = kind->second(count, seed);
  std::printf("%d taken, %d refused, %d wrong\n", tally.taken, tally.refused, tally.wrong);
  // Damage that never, or always, is noticed would show that this does not do what it says.
  return tally.wrong == 0 && tally.taken > 0 && tally.refused > 0 ? 0 : 1;
}
