#include "coordinator/channel/pty/terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <string>
#include <variant>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

class TerminalTest : public testing::Test {
 protected:
  std::string ReadNow(std::size_t most = 8192) const {
    std::string text(most, 0);
    const ssize_t n = read(program_.get(), text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }
  termios Settings() const {
    termios settings{};
    tcgetattr(program_.get(), &settings);
    return settings;
  }

  static speed_t SpeedOf(const termios& settings) { return cfgetospeed(&settings); }

  Terminal terminal_ = std::get<Terminal>(Terminal::Open(57'600));
  UniqueFd program_{open(terminal_.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)};
};

TEST_F(TerminalTest, WhatIsWrittenIsThereAtOnce) {
  for (int i = 0; i < 500; ++i) {
    terminal_.Write("ab");
    ASSERT_EQ(ReadNow(), "ab") << i;
  }
}

// Where something is unread already the kernel's worker takes its time.
TEST_F(TerminalTest, AlsoBesideWhatNobodyHasReadYet) {
  for (int i = 1; i < 1000; ++i) {
    terminal_.Write("abc");
    int unread = 0;
    ioctl(program_.get(), FIONREAD, &unread);
    ASSERT_EQ(unread, 3 * i);
  }
}

TEST_F(TerminalTest, ByLinesWholeLinesAreThereAtOnce) {
  termios settings = Settings();
  settings.c_lflag |= ICANON;
  tcsetattr(program_.get(), TCSANOW, &settings);
  for (int i = 0; i < 200; ++i) {
    terminal_.Write("ab");
    ASSERT_EQ(ReadNow(), "");
    terminal_.Write("c\n");
    ASSERT_EQ(ReadNow(), "abc\n");
  }
}

TEST_F(TerminalTest, WhatNobodyReadsIsLostAfterAFewKilobytes) {
  for (int i = 0; i < 100; ++i) terminal_.Write(std::string(100, 'x'));
  EXPECT_EQ(ReadNow(1 << 16).size(), 4000u);
  EXPECT_EQ(ReadNow(1 << 16), "");
}

TEST_F(TerminalTest, WhatAProgramWritesIsReadWhole) {
  EXPECT_EQ(terminal_.Read(), "");
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(write(program_.get(), "to it\n", 6), 6);
    ASSERT_EQ(terminal_.Read(), "to it\n");
  }
}

TEST_F(TerminalTest, BeginsRawAtItsRate) {
  EXPECT_EQ(SpeedOf(Settings()), speed_t{B57600});
  EXPECT_EQ(terminal_.Baud(), 57'600);
  EXPECT_EQ(Settings().c_lflag & (ECHO | ICANON | ISIG), 0u);
  termios settings = Settings();
  cfsetspeed(&settings, B9600);
  tcsetattr(program_.get(), TCSANOW, &settings);
  EXPECT_EQ(terminal_.Baud(), 9600);
}

TEST(Terminal, HasAnyRate) {
  EXPECT_EQ(std::get<Terminal>(Terminal::Open(123'456)).Baud(), 123'456);
}

TEST(Terminal, IsNotOpenWhileNobodyElseHasIt) {
  EXPECT_FALSE(std::get<Terminal>(Terminal::Open(9600)).IsOpen());
}

}  // namespace
}  // namespace tcs
