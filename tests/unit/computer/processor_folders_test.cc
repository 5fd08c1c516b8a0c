#include "coordinator/computer/processor_folders.h"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>

namespace tcs {
namespace {

using Which = ProcessorFolders::Which;

std::string TextOf(ProcessorFolders& folders, Which which, const char* name) {
  const UniqueFd file = folders.Open(which, name, O_RDONLY);
  char text[256];
  const ssize_t size = file ? read(file.get(), text, sizeof text) : 0;
  return std::string(text, static_cast<std::size_t>(size < 0 ? 0 : size));
}

std::filesystem::path FolderBehind(const UniqueFd& folder) {
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(folder.get()));
}

TEST(ProcessorFolders, HaveOneProcessorOfSoManyCores) {
  ProcessorFolders folders(5);
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "online"), "0-4\n");
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "offline"), "\n");
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "cpu4/topology/core_id"), "4\n");
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "cpu4/topology/physical_package_id"), "0\n");
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "cpu4/topology/thread_siblings_list"), "4\n");
  EXPECT_EQ(TextOf(folders, Which::kProcessors, "cpu4/topology/core_siblings"), "1f\n");
  EXPECT_EQ(TextOf(folders, Which::kNodes, "online"), "0\n");
  EXPECT_EQ(TextOf(folders, Which::kNodes, "node0/cpumap"), "1f\n");
  std::set<std::string> cores;
  const auto all = FolderBehind(folders.Open(Which::kProcessors, "", O_RDONLY | O_DIRECTORY));
  for (const auto& entry : std::filesystem::directory_iterator(all)) {
    const std::string name = entry.path().filename();
    if (name.rfind("cpu", 0) == 0) cores.insert(name);
  }
  EXPECT_EQ(cores, (std::set<std::string>{"cpu0", "cpu1", "cpu2", "cpu3", "cpu4"}));
}

TEST(ProcessorFolders, SayWhatIsNotThere) {
  ProcessorFolders folders(2);
  EXPECT_FALSE(folders.Open(Which::kProcessors, "cpu2", O_RDONLY));
  EXPECT_EQ(errno, ENOENT);
  EXPECT_FALSE(folders.Open(Which::kProcessors, "online", O_RDONLY | O_DIRECTORY));
  EXPECT_EQ(errno, ENOTDIR);
}

TEST(ProcessorFolders, AreGoneWithTheirObject) {
  std::filesystem::path place;
  {
    ProcessorFolders folders(1);
    place = FolderBehind(folders.Open(Which::kNodes, "", O_RDONLY));
    EXPECT_TRUE(std::filesystem::exists(place));
  }
  EXPECT_FALSE(std::filesystem::exists(place.parent_path()));
}

}  // namespace
}  // namespace tcs
