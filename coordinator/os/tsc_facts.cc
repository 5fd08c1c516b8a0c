#include "coordinator/os/tsc_facts.h"

#include <fstream>
#include <string>

namespace tcs {

namespace {

// The bytes that are read of /proc/cpuinfo: on a machine with many processors the rest takes the
// kernel a while.
constexpr std::size_t kFirstProcessor = 8192;

bool HasFlag(std::string_view flags, std::string_view flag) {
  return flags.find(" " + std::string(flag) + " ") != std::string_view::npos;
}

// The flags of the first processor, a space around each; empty: the text does not say.
std::string FlagsOf(std::string_view cpuinfo) {
  constexpr std::string_view kName = "flags";
  const std::size_t line = cpuinfo.starts_with(kName) ? 0 : cpuinfo.find("\n" + std::string(kName));
  const std::size_t begin = line == std::string_view::npos ? line : cpuinfo.find(':', line);
  if (begin == std::string_view::npos) return {};
  const std::size_t end = cpuinfo.find('\n', begin);
  return std::string(cpuinfo.substr(begin + 1, end - begin - 1)) + " ";
}

}  // namespace

TscKind KindOfTsc(std::string_view cpuinfo) {
  const std::string flags = FlagsOf(cpuinfo);
  if (!HasFlag(flags, "constant_tsc")) return TscKind::kNoClock;
  if (HasFlag(flags, "nonstop_tsc")) return TscKind::kClock;
  return HasFlag(flags, "hypervisor") ? TscKind::kOfGuest : TscKind::kNoClock;
}

TscKind KindOfHostsTsc() {
  std::ifstream file("/proc/cpuinfo");
  std::string text(kFirstProcessor, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return FlagsOf(text).empty() ? TscKind::kClock : KindOfTsc(text);
}

}  // namespace tcs
