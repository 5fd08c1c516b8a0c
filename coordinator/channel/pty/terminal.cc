#include "coordinator/channel/pty/terminal.h"

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace tcs {
namespace {

// The most looks, a pause apart: where the terminal may swallow some of the bytes, and where all
// bytes are sure to come.
constexpr int kMostLooks = 200, kMostSureLooks = 40'000;
constexpr long kPauseNs = 50'000;
constexpr int kRoom = 4095;  // of the line discipline

// As the C library's cfmakeraw, with a rate that need not be one of the constants.
void MakeRaw(int fd, int baud) {
  struct Rate {
    int baud;
    unsigned flag;
  };
  constexpr std::array<Rate, 19> kRates = {{{1200, B1200},
                                            {2400, B2400},
                                            {4800, B4800},
                                            {9600, B9600},
                                            {19200, B19200},
                                            {38400, B38400},
                                            {57600, B57600},
                                            {115200, B115200},
                                            {230400, B230400},
                                            {460800, B460800},
                                            {500000, B500000},
                                            {576000, B576000},
                                            {921600, B921600},
                                            {1000000, B1000000},
                                            {300, B300},
                                            {600, B600},
                                            {1500000, B1500000},
                                            {2000000, B2000000},
                                            {3000000, B3000000}}};
  unsigned flag = BOTHER;
  for (const Rate& rate : kRates) {
    if (rate.baud == baud) flag = rate.flag;
  }
  termios2 settings{};
  ioctl(fd, TCGETS2, &settings);
  settings.c_iflag &= ~(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
  settings.c_oflag &= ~OPOST;
  settings.c_lflag &= ~(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  settings.c_cflag &= ~(CSIZE | PARENB | CBAUD);
  settings.c_cflag |= CS8 | CREAD | CLOCAL | flag;
  settings.c_ispeed = settings.c_ospeed = static_cast<unsigned>(baud);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  ioctl(fd, TCSETS2, &settings);
}

// True if each byte is there to be read: no byte is a signal, stops the flow or ends a line.
bool KeepsAll(const termios2& settings) {
  return (settings.c_lflag & (ICANON | ISIG)) == 0 &&
         (settings.c_iflag & (IXON | IGNCR | PARMRK)) == 0;
}

int Unread(int fd) {
  int bytes = 0;
  return ioctl(fd, FIONREAD, &bytes) == 0 ? bytes : 0;
}

}  // namespace

std::variant<Terminal, std::string> Terminal::Open(int baud) {
  UniqueFd far(open("/dev/ptmx", O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  int locked = 0, number = 0;
  if (!far || ioctl(far.get(), TIOCSPTLCK, &locked) != 0 ||
      ioctl(far.get(), TIOCGPTN, &number) != 0) {
    return std::string(strerror(errno));
  }
  std::string path = "/dev/pts/" + std::to_string(number);
  UniqueFd near(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!near) return path + ": " + strerror(errno);
  MakeRaw(near.get(), baud);
  return Terminal(std::move(far), std::move(near), std::move(path));
}

// A poll waits for the kernel's worker, but only where nothing is there to be read yet. Where older
// bytes are still unread, the new bytes are counted until they are all there; where programs read
// whole lines, bytes are counted by lines. On a busy host the worker may take long.
void Terminal::Write(std::string_view bytes) const {
  termios2 settings{};
  ioctl(near_.get(), TCGETS2, &settings);
  const bool by_lines = (settings.c_lflag & ICANON) != 0;
  const int before = Unread(near_.get());
  // The kernel would keep more bytes elsewhere, where no process sees them.
  if (before + static_cast<int>(bytes.size()) > kRoom) return;
  const ssize_t written = write(far_.get(), bytes.data(), bytes.size());
  if (written <= 0) return;
  const bool ends_line = bytes.find('\n') != std::string_view::npos;
  const int more = by_lines ? (ends_line ? 1 : 0) : static_cast<int>(written);
  const int expected = before + more;
  const int most_looks = KeepsAll(settings) ? kMostSureLooks : kMostLooks;
  pollfd probe{near_.get(), POLLIN, 0};
  for (int look = 0;; ++look) {
    poll(&probe, 1, 0);
    if (Unread(near_.get()) >= expected || look == most_looks) return;
    const timespec pause{0, kPauseNs};
    nanosleep(&pause, nullptr);
  }
}

// A read that finds nothing waits for the kernel's worker and looks again.
std::string Terminal::Read() const {
  std::string all;
  std::array<char, 4096> some;
  for (;;) {
    const ssize_t n = read(far_.get(), some.data(), some.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return all;
    all.append(some.data(), static_cast<std::size_t>(n));
  }
}

int Terminal::Baud() const {
  termios2 settings{};
  ioctl(near_.get(), TCGETS2, &settings);
  return static_cast<int>(settings.c_ospeed);
}

bool Terminal::IsOpen() const {
  namespace fs = std::filesystem;
  std::error_code error;
  const std::string own = std::to_string(getpid());
  for (const fs::directory_entry& process : fs::directory_iterator("/proc", error)) {
    const std::string pid = process.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos || pid == own) continue;
    std::error_code gone;
    for (fs::directory_iterator fd(process.path() / "fd", gone), end; !gone && fd != end;
         fd.increment(gone)) {
      std::error_code closed;
      if (fs::read_symlink(fd->path(), closed) == path_) return true;
    }
  }
  return false;
}

}  // namespace tcs
