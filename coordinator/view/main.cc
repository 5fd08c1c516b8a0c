// tcsim-view: the server of a run's page, which tcsim starts.
//
//   tcsim-view FOLDER ADDRESS PORT            shows what is in a folder, until it is ended
//   tcsim-view FOLDER ADDRESS PORT PAGE READY the same of a run that goes on: PAGE is the
//                                             descriptor of the page that run and server share; at
//                                             READY the server says where it listens
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "coordinator/os/say.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/view/server.h"

namespace {

constexpr rlim_t kMostMemory = rlim_t{2} << 30;

// Requests, whatever somebody sends, must not use up the machine's memory.
void LimitMemory() {
#ifndef __SANITIZE_ADDRESS__
  const rlimit limit{kMostMemory, kMostMemory};
  setrlimit(RLIMIT_DATA, &limit);
#endif
}

int ServeRun(const std::string& folder, const std::string& address, int port, int page_fd,
             tcs::UniqueFd ready) {
  const auto say = [&ready](const std::string& text) {
    const ssize_t n = write(ready.get(), text.data(), text.size());
    static_cast<void>(n);  // if this fails, no reader is left
  };
  void* at =
      mmap(nullptr, sizeof(tcs::ControlPage), PROT_READ | PROT_WRITE, MAP_SHARED, page_fd, 0);
  auto* page = static_cast<tcs::ControlPage*>(at);
  if (at == MAP_FAILED || page->magic != tcs::ControlPage::kMagic ||
      page->version != tcs::ControlPage::kVersion) {
    say("!tcsim-view has another version than tcsim; build tcs again");
    return 2;
  }
  tcs::ViewServer server(folder, page);
  if (const std::string error = server.Bind(address, port); !error.empty()) {
    say("!" + error);
    return 2;
  }
  say(server.url());
  ready.Reset();
  server.Serve();
  return 0;
}

int ServeFolder(const std::string& folder, const std::string& address, int port) {
  tcs::ViewServer server(folder, nullptr);
  if (const std::string error = server.Bind(address, port); !error.empty()) {
    tcs::Say(error);
    return 2;
  }
  tcs::Say("look at " + folder + " at " + server.url() + "; Ctrl-C ends this");
  server.Serve();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 6) {
    tcs::Say("only tcsim starts tcsim-view: call `tcsim run --view` or `tcsim view`");
    return 2;
  }
  LimitMemory();
  const std::string folder = argv[1], address = argv[2];
  const int port = std::atoi(argv[3]);
  if (argc == 4) return ServeFolder(folder, address, port);
  prctl(PR_SET_NAME, "tcsim-view");
  return ServeRun(folder, address, port, std::atoi(argv[4]), tcs::UniqueFd(std::atoi(argv[5])));
}
