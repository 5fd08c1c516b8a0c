// Files that are made to do harm end in a sentence, soon, and within bounded memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>

#include <functional>
#include <ostream>
#include <random>
#include <string>

#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;

std::string Repeat(int count, const std::function<std::string(int)>& piece) {
  std::string text;
  for (int i = 0; i < count; ++i) text += piece(i);
  return text;
}

std::string Always(int count, std::string_view piece) {
  return Repeat(count, [piece](int) { return std::string(piece); });
}

std::string Named(std::string_view before, int i, std::string_view after) {
  return std::string(before) + std::to_string(i) + std::string(after);
}

struct Attack {
  std::string_view name;
  std::function<std::string()> text;
  std::string_view words;
};

void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

constexpr double kSoonS = 40;  // it takes some, and four times as many on a slow and busy host

double ProcessorSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

long MostMemoryKb() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

class HostileUrdfTest : public testing::TestWithParam<Attack> {};

TEST_P(HostileUrdfTest, EndsInASentenceSoon) {
  const ModelFolder folder;
  const std::string text = GetParam().text();
  const double before_s = ProcessorSeconds();
  const long before_kb = MostMemoryKb();
  const Loaded loaded = LoadText(folder, text, {true});
  EXPECT_THAT(loaded.mistake, HasSubstr(std::string(GetParam().words)));
  EXPECT_LT(loaded.mistake.size(), 1000u);
  EXPECT_LE(loaded.warnings.size(), 60u);
  EXPECT_LT(ProcessorSeconds() - before_s, kSoonS);
#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed
  EXPECT_LT(MostMemoryKb() - before_kb, 400'000);
#else
  static_cast<void>(before_kb);
#endif
}

std::string AttackLabel(const testing::TestParamInfo<Attack>& info) {
  return std::string(info.param.name);
}

const Attack kAttacks[] = {
    {"EntityBomb",
     [] {
       return "<!DOCTYPE robot [<!ENTITY a0 \"<link name='x'/>\">" +
              Repeat(9,
                     [](int i) {
                       return Named("<!ENTITY a", i + 1, " \"") + Always(10, Named("&a", i, ";")) +
                              "\">";
                     }) +
              "]><robot name='r'>&a9;</robot>";
     },
     "whose entities are not expanded"},
    {"ExternalEntity",
     [] {
       return std::string(
           "<!DOCTYPE robot [<!ENTITY e SYSTEM \"file:///etc/passwd\">]><robot name='r'><link "
           "name='a'/></robot>");
     },
     "document type"},
    {"DeepNesting", [] { return "<robot name='r'>" + Always(500'000, "<link>"); },
     "more than a hundred deep"},
    {"ManyLinks",
     [] {
       return "<robot name='r'>" +
              Repeat(100'000, [](int i) { return Named("<link name='l", i, "'/>"); }) + "</robot>";
     },
     "number 4097 of the links, more than tcs takes"},
    {"ManyBytes", [] { return "<robot name='r'>" + std::string(5'000'000, ' ') + "</robot>"; },
     "more than the 4 MiB"},
    {"ManyEmptyElements", [] { return "<robot name='r'>" + Always(900'000, "<a/>") + "</robot>"; },
     "has no <link>"},
    {"ManyKindsOfElements",
     [] {
       return "<robot name='r'>" + Repeat(300'000, [](int i) { return Named("<a", i, "/>"); }) +
              "</robot>";
     },
     "has no <link>"},
    {"LongNames",
     [] { return "<robot name='r'><link name='" + std::string(3'000'000, 'x') + "'/></robot>"; },
     "must be a name of 1 to 256 bytes"},
    {"LongElement", [] { return "<" + std::string(3'000'000, 'x') + "/>"; },
     "the first element is"},
    {"LongUnknownElement",
     [] { return "<robot name='r'><" + std::string(3'000'000, 'x') + "/></robot>"; },
     "has no <link>"},
    {"NewlineInTheNameOfAMesh",
     [] {
       return std::string(
           "<robot name='r'><link name='a'><collision><geometry><mesh filename='a&#10;b.obj'/>"
           "</geometry></collision></link></robot>");
     },
     "a\\nb.obj: cannot be read"},
    {"LongRing",
     [] {
       return "<robot name='r'>" +
              Repeat(4000, [](int i) { return Named("<link name='l", i, "'/>"); }) +
              Repeat(4000,
                     [](int i) {
                       return Named("<joint name='j", i, "' type='fixed'>") +
                              Named("<parent link='l", i, "'/>") +
                              Named("<child link='l", (i + 1) % 4000, "'/></joint>");
                     }) +
              "</robot>";
     },
     "loop"},
    {"RingBesideARoot",
     [] {
       return std::string(
           "<robot name='r'><link name='root'/><link name='a'/><link name='b'/>"
           "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
           "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>");
     },
     "loop"},
    {"NulBytes", [] { return std::string("<robot name='r'>\0</robot>", 25); }, "NUL bytes"},
    {"Utf16", [] { return std::string("\xff\xfe<\0r\0", 6); }, "NUL bytes"},
    {"ManyNumbers",
     [] {
       return "<robot name='r'><link name='l'><inertial><origin xyz='" + Always(1'000'000, "1 ") +
              "'/></inertial></link></robot>";
     },
     "three numbers"},
};

INSTANTIATE_TEST_SUITE_P(All, HostileUrdfTest, testing::ValuesIn(kAttacks), AttackLabel);

TEST(HostileUrdf, TheLongestChainIsTakenSoon) {
  const ModelFolder folder;
  const std::string text = "<robot name='r'>" +
                           Repeat(4096, [](int i) { return Named("<link name='l", i, "'/>"); }) +
                           Repeat(4095,
                                  [](int i) {
                                    return Named("<joint name='j", i, "' type='fixed'>") +
                                           Named("<parent link='l", i, "'/>") +
                                           Named("<child link='l", i + 1, "'/></joint>");
                                  }) +
                           "</robot>";
  const double before_s = ProcessorSeconds();
  const Loaded loaded = LoadText(folder, text, {true});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_EQ(loaded.model.links.size(), 4096u);
  EXPECT_LT(ProcessorSeconds() - before_s, kSoonS);
}

TEST(HostileUrdf, APipeIsNotWaitedFor) {
  const ModelFolder folder;
  ASSERT_EQ(mkfifo(folder.Path("robot.urdf").c_str(), 0600), 0);
  EXPECT_THAT(LoadFile(folder.Path("robot.urdf")).mistake, HasSubstr("is not a regular file"));
  EXPECT_THAT(LoadFile("/dev/zero").mistake, HasSubstr("is not a regular file"));
}

TEST(HostileUrdf, WhatIsCutOffIsASentence) {
  const ModelFolder folder;
  const std::string text = TextOfZoo("rover.urdf");
  for (std::size_t size = 0; size + 10 < text.size(); size += 13) {
    EXPECT_NE(LoadText(folder, text.substr(0, size), {true}).mistake, "") << size;
  }
}

// Either taken or refused with a place, and never anything else.
TEST(HostileUrdf, DamageIsNoticedOrHarmless) {
  const ModelFolder folder;
  const std::string good = TextOfZoo("rover.urdf");
  std::mt19937_64 random(1);
  int taken = 0, refused = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string text = good;
    for (std::size_t i = 1 + random() % 4; i > 0; --i) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, 1 + random() % 40);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), 1 + random() % 80));
          break;
        default:
          text.insert(at, "-");
      }
    }
    const Loaded loaded = LoadText(folder, text, {random() % 2 == 0});
    ++(loaded.mistake.empty() ? taken : refused);
    if (loaded.mistake.empty()) continue;
    EXPECT_THAT(loaded.mistake, testing::StartsWith("robot.urdf:"));
  }
  EXPECT_GT(taken, 30);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace tcs
