#include "coordinator/os/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace tcs {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FilesTest : public ::testing::Test {
 protected:
  FilesTest() {
    std::string made = ::testing::TempDir() + "files.XXXXXX";
    folder_ = mkdtemp(made.data());
  }
  ~FilesTest() override { fs::remove_all(folder_); }
  static std::string TextOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  std::string folder_;
};

TEST_F(FilesTest, TheLastLineOfALogIsTheLastThatSaysSomething) {
  const std::string path = folder_ + "/log";
  EXPECT_EQ(LastLine(path), "");
  std::ofstream(path) << "";
  EXPECT_EQ(LastLine(path), "");
  std::ofstream(path) << "first\n  the\tlast \n\n \n";
  EXPECT_EQ(LastLine(path), "the last");
  std::ofstream(path) << std::string(100'000, 'x') << "\nwithout a line end";
  EXPECT_EQ(LastLine(path), "without a line end");
  std::ofstream(path) << std::string(100'000, 'x');
  EXPECT_LT(LastLine(path).size(), 210u);
}

TEST_F(FilesTest, AWholeFileTakesThePlaceOfTheOldOne) {
  const std::string path = folder_ + "/file";
  EXPECT_EQ(WriteWhole(path, "a long first text"), "");
  // Who has it open goes on reading what it was.
  std::ifstream old(path);
  EXPECT_EQ(WriteWhole(path, "second"), "");
  std::ostringstream read;
  read << old.rdbuf();
  EXPECT_EQ(read.str(), "a long first text");
  EXPECT_EQ(TextOf(path), "second");
  EXPECT_FALSE(fs::exists(path + ".new"));
}

TEST_F(FilesTest, WhatCannotBeWrittenIsNamed) {
  EXPECT_THAT(WriteWhole(folder_ + "/none/file", "x"), HasSubstr("/none/file cannot be written"));
}

TEST_F(FilesTest, AFileInTheWayOfAFolderIsNamed) {
  EXPECT_EQ(MakeFolder(folder_ + "/a/b"), "");
  EXPECT_EQ(MakeFolder(folder_ + "/a/b"), "");
  ASSERT_EQ(WriteWhole(folder_ + "/file", ""), "");
  EXPECT_THAT(MakeFolder(folder_ + "/file"), HasSubstr("--out"));
}

TEST_F(FilesTest, AFolderIsHeldByOneUntilItLetsGo) {
  FolderLock first(folder_);
  EXPECT_TRUE(first.IsOurs());
  EXPECT_FALSE(FolderLock(folder_).IsOurs());
  const FolderLock moved = std::move(first);
  EXPECT_FALSE(FolderLock(folder_).IsOurs());
  first = FolderLock(folder_ + "/none");
  EXPECT_TRUE(moved.IsOurs());
}

TEST_F(FilesTest, AFolderThatWasLetGoIsFree) {
  { const FolderLock first(folder_); }
  EXPECT_TRUE(FolderLock(folder_).IsOurs());
}

TEST_F(FilesTest, ACopyHasWhatAFolderHas) {
  fs::create_directories(folder_ + "/from/deep/empty");
  std::ofstream(folder_ + "/from/deep/file") << "text";
  fs::permissions(folder_ + "/from/deep/file", fs::perms(0750));
  fs::create_symlink("deep/file", folder_ + "/from/link");
  fs::create_symlink("nowhere", folder_ + "/from/broken");
  ASSERT_EQ(mkfifo((folder_ + "/from/pipe").c_str(), 0600), 0);
  fs::create_directory(folder_ + "/to");
  ASSERT_EQ(CopyFolder(folder_ + "/from", folder_ + "/to"), "");
  EXPECT_EQ(TextOf(folder_ + "/to/link"), "text");
  EXPECT_TRUE(fs::is_symlink(folder_ + "/to/link"));
  EXPECT_EQ(fs::read_symlink(folder_ + "/to/broken"), "nowhere");
  EXPECT_EQ(fs::status(folder_ + "/to/deep/file").permissions(), fs::perms(0750));
  EXPECT_TRUE(fs::is_directory(folder_ + "/to/deep/empty"));
  EXPECT_FALSE(fs::exists(folder_ + "/to/pipe"));
  EXPECT_THAT(CopyFolder(folder_ + "/none", folder_ + "/to"), HasSubstr("/none cannot be copied"));
}

TEST(AbsolutePath, HasNoDotsAndNoSlashAtItsEnd) {
  EXPECT_EQ(AbsolutePathOf("/a/./b/../c/"), "/a/c");
  EXPECT_EQ(AbsolutePathOf("x"), fs::current_path().string() + "/x");
}

}  // namespace
}  // namespace tcs
