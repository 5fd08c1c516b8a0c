#include "coordinator/os/shared_memory.h"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <string>

namespace tcs {
namespace {

constexpr std::size_t kSize = 8192;

// As whoever is given the descriptor could open the file anew.
int OpenedAnew(int fd, int flags) {
  return open(("/proc/self/fd/" + std::to_string(fd)).c_str(), flags | O_CLOEXEC);
}

TEST(SharedMemory, IsTheSameForWhoeverHasTheDescriptor) {
  const SharedMemory memory = MakeSharedMemory("tcs-test", kSize);
  ASSERT_TRUE(memory.fd);
  void* other = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, memory.fd.get(), 0);
  ASSERT_NE(other, MAP_FAILED);
  strcpy(static_cast<char*>(other), "written there");
  EXPECT_STREQ(static_cast<char*>(memory.at), "written there");
}

TEST(SharedMemory, NobodyChangesItsSizeOrForbidsWriting) {
  const SharedMemory memory = MakeSharedMemory("tcs-test", kSize);
  EXPECT_EQ(ftruncate(memory.fd.get(), 0), -1);
  EXPECT_EQ(ftruncate(memory.fd.get(), 2 * kSize), -1);
  EXPECT_EQ(fcntl(memory.fd.get(), F_ADD_SEALS, F_SEAL_WRITE), -1);
  struct stat status {};
  fstat(memory.fd.get(), &status);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(PublishedMemory, IsWrittenByItsMakerAlone) {
  const SharedMemory memory = MakePublishedMemory("tcs-test", kSize);
  ASSERT_TRUE(memory.fd);
  strcpy(static_cast<char*>(memory.at), "for all");
  void* seen = mmap(nullptr, kSize, PROT_READ, MAP_SHARED, memory.fd.get(), 0);
  ASSERT_NE(seen, MAP_FAILED);
  EXPECT_STREQ(static_cast<char*>(seen), "for all");
  strcpy(static_cast<char*>(memory.at), "anew");
  EXPECT_STREQ(static_cast<char*>(seen), "anew");
  EXPECT_EQ(mprotect(seen, kSize, PROT_READ | PROT_WRITE), -1);
  for (const int fd : {memory.fd.get(), OpenedAnew(memory.fd.get(), O_RDWR)}) {
    EXPECT_EQ(mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0), MAP_FAILED);
    EXPECT_EQ(write(fd, "x", 1), -1);
    EXPECT_EQ(fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kSize), -1);
    EXPECT_EQ(ftruncate(fd, 0), -1);
  }
  EXPECT_STREQ(static_cast<char*>(memory.at), "anew");
}

}  // namespace
}  // namespace tcs
