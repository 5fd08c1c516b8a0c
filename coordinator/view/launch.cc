#include "coordinator/view/launch.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/os/pipe.h"
#include "coordinator/os/shared_memory.h"
#include "coordinator/port/pidfds.h"

namespace tcs {

namespace {

// The server's descriptors: of the page that it shares with the run, and of the pipe on which it
// answers.
constexpr int kPageFd = 3, kReadyFd = 4;

[[noreturn]] void Become(const std::vector<char*>& argv, int page, int ready, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  setpgid(0, 0);  // ^C is for the run, whose end the page is to show
  for (const int ignored : {SIGINT, SIGHUP, SIGPIPE, SIGTTOU}) signal(ignored, SIG_IGN);
  // The present number of a descriptor may be one that the descriptors are to get.
  const int copies[] = {fcntl(page, F_DUPFD, 10), fcntl(ready, F_DUPFD, 10)};
  const int null = open("/dev/null", O_RDWR);
  dup2(null, STDIN_FILENO);
  dup2(null, STDOUT_FILENO);
  dup2(copies[0], kPageFd);
  dup2(copies[1], kReadyFd);
  close_range(kReadyFd + 1, ~0u, 0);
  execv(argv[0], argv.data());
  const std::string why =
      fmt::format("!the server of the page, {}, cannot be started: {}; build tcs again", argv[0],
                  strerror(errno));
  const ssize_t n = write(kReadyFd, why.data(), why.size());
  _exit(n > 0 ? 127 : 126);
}

std::string ReadAll(int fd) {
  std::string text;
  char some[4096];
  for (ssize_t n = 0; (n = read(fd, some, sizeof some)) > 0 || (n < 0 && errno == EINTR);) {
    if (n > 0) text.append(some, static_cast<std::size_t>(n));
  }
  return text;
}

bool TakePort(std::string_view text, int* port) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_port =
      error == std::errc{} && end == text.data() + text.size() && number >= 0 && number <= 65535;
  if (is_port) *port = number;
  return is_port;
}

}  // namespace

std::string TakeViewAddress(const std::string& text, ViewRequest* request) {
  if (text.empty() || TakePort(text, &request->port)) return {};
  const std::string mistake =
      "'" + text +
      "' is not a place to listen at: give a port, an address or both, such as 8080, " +
      "192.0.2.7, 192.0.2.7:8080 or [::1]:8080";
  const std::string_view whole = text;
  const bool is_bracketed = whole.front() == '[';
  const std::size_t end = is_bracketed ? whole.find(']') : whole.find(':');
  if (is_bracketed && end == whole.npos) return mistake;
  const std::string_view address = whole.substr(is_bracketed, end - is_bracketed);
  const std::string_view rest =
      end == whole.npos ? std::string_view{} : whole.substr(end + is_bracketed);
  if (!rest.empty() && (rest[0] != ':' || !TakePort(rest.substr(1), &request->port))) {
    return mistake;
  }
  in6_addr any;
  request->address = address;
  const int family = is_bracketed ? AF_INET6 : AF_INET;
  return inet_pton(family, request->address.c_str(), &any) == 1 ? std::string() : mistake;
}

std::variant<std::unique_ptr<ViewLink>, std::string> StartView(const ViewRequest& request) {
  SharedMemory memory = MakeSharedMemory("tcs-view", sizeof(ControlPage));
  std::optional<Pipe> ready = Pipe::Make();
  if (!memory.fd || !ready) {
    return fmt::format("the server of the page cannot be started: {}", strerror(errno));
  }
  auto* page = new (memory.at) ControlPage{};
  std::vector<std::string> words{request.server,          request.folder,
                                 request.address,         std::to_string(request.port),
                                 std::to_string(kPageFd), std::to_string(kReadyFd)};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid(), server = fork();
  if (server == 0) Become(argv, memory.fd.get(), ready->write_end.get(), parent);
  if (server < 0) {
    return fmt::format("the server of the page cannot be started: {}", strerror(errno));
  }
  ready->write_end.Reset();
  // The server says where it listens, or after an exclamation mark why it does not.
  const std::string said = ReadAll(ready->read_end.get());
  if (said.empty() || said[0] == '!') {
    waitpid(server, nullptr, 0);
    return said.empty()
               ? "the server of the page has died; this is a fault of tcsim, please report it"
               : said.substr(1);
  }
  return std::make_unique<ViewLink>(page, UniqueFd(OpenPidfd(server)), said);
}

}  // namespace tcs
