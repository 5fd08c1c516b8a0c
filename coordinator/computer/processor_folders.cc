#include "coordinator/computer/processor_folders.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "coordinator/computer/computer_text.h"
#include "coordinator/os/guardian.h"

namespace tcs {

namespace fs = std::filesystem;

namespace {

const fs::path kHost = "/sys/devices/system/cpu";

std::optional<std::string> TextOf(const fs::path& path) {
  std::ifstream file(path);
  if (!file.is_open()) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

void Put(const fs::path& path, const std::string& text) { std::ofstream(path) << text << "\n"; }

// Copies what can be read of one of the host's files, if the file is there.
void Copy(const fs::path& from, const fs::path& to) {
  if (const auto text = TextOf(from)) std::ofstream(to) << *text;
}

void CopyFiles(const fs::path& from, const fs::path& to) {
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(from, missing)) {
    if (!entry.is_regular_file(missing)) continue;
    fs::create_directories(to, missing);
    Copy(entry.path(), to / entry.path().filename());
  }
}

// The folder is in memory if that is allowed: programs wait for it. Empty: nowhere.
std::string NewFolder() {
  std::error_code missing;
  for (const fs::path& in : {fs::path("/dev/shm"), fs::temp_directory_path(missing)}) {
    std::string path = (in / "tcs-computer-XXXXXX").string();
    if (mkdtemp(path.data()) != nullptr) return path;
  }
  return {};
}

// The number of the host's core that this core is like.
std::size_t LikeHosts(std::size_t core) {
  std::error_code missing;
  std::size_t count = 1;
  while (fs::exists(kHost / fmt::format("cpu{}", count) / "topology", missing)) ++count;
  return core % count;
}

}  // namespace

ProcessorFolders::~ProcessorFolders() {
  if (!path_.empty()) RemoveNow(path_);
}

void ProcessorFolders::MakeCore(std::size_t core) const {
  const fs::path to = fs::path(path_) / fmt::format("cpu/cpu{}", core);
  const fs::path from = kHost / fmt::format("cpu{}", LikeHosts(core));
  const std::uint64_t own = std::uint64_t{1} << core, all = AllCores(cores_);
  const auto put_set = [this](const fs::path& name, std::uint64_t set) {
    Put(name, CoreMask(set, cores_));
    Put(name.string() + "_list", CoreList(set));
  };
  std::error_code missing;
  fs::create_directories(to / "topology", missing);
  for (const char* of_core : {"core_cpus", "thread_siblings"})
    put_set(to / "topology" / of_core, own);
  for (const char* of_all : {"core_siblings", "package_cpus", "die_cpus"}) {
    put_set(to / "topology" / of_all, all);
  }
  Put(to / "topology/core_id", std::to_string(core));
  Put(to / "topology/physical_package_id", "0");
  Put(to / "topology/die_id", "0");
  Copy(from / "cpu_capacity", to / "cpu_capacity");
  if (core > 0) Put(to / "online", "1");
  CopyFiles(from / "cpufreq", to / "cpufreq");
  if (fs::exists(to / "cpufreq", missing)) {
    for (const char* set : {"affected_cpus", "related_cpus"}) {
      Put(to / "cpufreq" / set, std::to_string(core));
    }
  }
  for (int index = 0; fs::exists(from / fmt::format("cache/index{}", index), missing); ++index) {
    const std::string name = fmt::format("cache/index{}", index);
    CopyFiles(from / name, to / name);
    const bool is_last = TextOf(from / name / "level").value_or("1") >= "3";
    Put(to / name / "shared_cpu_map", CoreMask(is_last ? all : own, cores_));
    Put(to / name / "shared_cpu_list", CoreList(is_last ? all : own));
    if (fs::exists(to / name / "id", missing)) {
      Put(to / name / "id", std::to_string(is_last ? 0 : core));
    }
  }
}

void ProcessorFolders::MakeProcessors() const {
  const fs::path to = fs::path(path_) / "cpu";
  std::error_code missing;
  fs::create_directories(to, missing);
  for (const char* set : {"online", "possible", "present", "enabled"}) {
    Put(to / set, CoreList(AllCores(cores_)));
  }
  for (const char* none : {"offline", "isolated"}) Put(to / none, "");
  for (const char* same : {"kernel_max", "modalias", "microcode"}) Copy(kHost / same, to / same);
  CopyFiles(kHost / "vulnerabilities", to / "vulnerabilities");
  fs::create_directories(to / "smt", missing);
  Put(to / "smt/active", "0");
  Put(to / "smt/control", "notsupported");
  for (std::size_t core = 0; core < cores_; ++core) MakeCore(core);
}

void ProcessorFolders::MakeNodes() const {
  const fs::path to = fs::path(path_) / "node";
  std::error_code missing;
  fs::create_directories(to / "node0", missing);
  for (const char* set : {"online", "possible", "has_cpu", "has_memory", "has_normal_memory"}) {
    Put(to / set, "0");
  }
  Put(to / "node0/cpulist", CoreList(AllCores(cores_)));
  Put(to / "node0/cpumap", CoreMask(AllCores(cores_), cores_));
  Put(to / "node0/distance", "10");
  // The host's memory, all of it: as /proc/meminfo has it, each line behind the node's name.
  std::ifstream memory("/proc/meminfo");
  std::ofstream of_node(to / "node0/meminfo");
  for (std::string line; std::getline(memory, line);) of_node << "Node 0 " << line << "\n";
}

bool ProcessorFolders::Make() {
  if (tried_) return !path_.empty();
  tried_ = true;
  path_ = NewFolder();
  if (path_.empty()) return false;
  RemoveIfKilled(path_);
  MakeProcessors();
  MakeNodes();
  return true;
}

UniqueFd ProcessorFolders::Open(Which which, const std::string& name, int flags) {
  if (!Make()) {
    errno = ENOSYS;
    return UniqueFd();
  }
  constexpr int kKept = O_DIRECTORY | O_NOFOLLOW | O_NONBLOCK;
  std::string path = path_ + (which == Which::kProcessors ? "/cpu" : "/node");
  if (!name.empty()) path += "/" + name;
  return UniqueFd(open(path.c_str(), O_RDONLY | O_CLOEXEC | (flags & kKept)));
}

}  // namespace tcs
