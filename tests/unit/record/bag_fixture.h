// What the tests of a bag in either storage share: a bag of odometry in a folder that goes with the
// test, also of a writer that is killed, or that has no room on its disk.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/dds/robot_topics.h"
#include "coordinator/record/bag.h"

namespace tcs::record {

inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kPeriod = 10'000'000;

inline std::vector<std::byte> Sample(int number) {
  BodyState state;
  state.position_m = {static_cast<double>(number), 0.1, 0};
  return dds::ToCdr(dds::ToOdometry(kStart + number * kPeriod, "hunter", state));
}

class BagFixture : public testing::Test {
 protected:
  // `file_name` of the one file beside metadata.yaml.
  BagFixture(StorageKind storage, std::string file_name)
      : storage_(storage), file_name_(std::move(file_name)) {
    std::string name = (std::filesystem::temp_directory_path() / "tcs_bag_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    root_ = name;
  }
  ~BagFixture() override { std::filesystem::remove_all(root_); }

  std::string Folder() const { return root_ + "/flight"; }
  std::string File() const { return Folder() + "/" + file_name_; }
  YAML::Node Metadata() const {
    return YAML::LoadFile(Folder() + "/metadata.yaml")["rosbag2_bagfile_information"];
  }
  Bag NewBag() const { return Bag(dds::RosRelease::kIron, storage_); }

  // `count` odometry samples, 100 in a second.
  void Record(int count) const {
    Bag bag = NewBag();
    ASSERT_EQ(bag.Open(Folder()), "");
    WriteSamples(&bag, count);
    EXPECT_EQ(bag.Close(), "");
  }

  // The same by a process that is killed before it closes the bag.
  void RecordUntilKilled(int count) const {
    const int status = InChild([&] {
      Bag bag = NewBag();
      if (!bag.Open(Folder()).empty()) return;
      WriteSamples(&bag, count);
      kill(getpid(), SIGKILL);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  // Of 1000 samples, where no file grows beyond `bytes`, as on a disk without more room.
  void ExpectSaysWhatIsMissingBeyond(rlim_t bytes) const {
    const int status = InChild([&] {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{bytes, bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
      Bag bag = NewBag();
      std::string error = bag.Open(Folder());
      if (error.empty()) {
        WriteSamples(&bag, 1000);
        error = bag.Close();
      }
      const bool is_one_sentence =
          error.find(file_name_ + " is incomplete: ") != std::string::npos &&
          error.find(" of 1000 samples are missing") != std::string::npos &&
          error.find('\n') == std::string::npos;
      if (!is_one_sentence) fputs((error + "\n").c_str(), stderr);
      _exit(is_one_sentence ? 0 : 1);
    });
    EXPECT_EQ(status, 0);
  }

  std::string root_;

 private:
  static void WriteSamples(Bag* bag, int count) {
    const int odom = bag->AddTopic("/odom", "nav_msgs/msg/Odometry");
    bag->AddOffer(odom, {});
    for (int i = 0; i < count; ++i) bag->Write(odom, kStart + i * kPeriod, Sample(i));
  }

  // The wait status of a process of its own that does it. It fails if it returns.
  template <class Do>
  static int InChild(const Do& what) {
    const pid_t child = fork();
    if (child == 0) {
      what();
      _exit(1);
    }
    int status = -1;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return status;
  }

  StorageKind storage_;
  std::string file_name_;
};

}  // namespace tcs::record
