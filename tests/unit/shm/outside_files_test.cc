#include "shm/outside_files.h"

#include <gtest/gtest.h>

#include <set>

namespace tcs::shm {
namespace {

struct stat FileOf(mode_t mode, dev_t device, ino_t number) {
  struct stat status {};
  status.st_mode = mode;
  status.st_dev = status.st_rdev = device;
  status.st_ino = number;
  return status;
}

TEST(OutsideFilesTest, FilesBesideEachOtherAreNotTakenForOneAnother) {
  std::set<std::uint64_t> keys;
  for (dev_t device = 0; device < 4; ++device) {
    for (ino_t number = 0; number < 1000; ++number) {
      keys.insert(OutsideKeyOf(FileOf(S_IFIFO, device, number)));
    }
  }
  EXPECT_EQ(keys.size(), 4'000u);
  EXPECT_EQ(keys.count(0), 0u);
}

TEST(OutsideFilesTest, AFileIsNeitherASocketNorADevice) {
  const std::uint64_t file = OutsideKeyOf(FileOf(S_IFREG, 5, 17));
  EXPECT_NE(file, OutsideKeyOf(FileOf(S_IFSOCK, 5, 17)));
  EXPECT_NE(file, OutsideKeyOf(FileOf(S_IFCHR, 5, 17)));
}

}  // namespace
}  // namespace tcs::shm
