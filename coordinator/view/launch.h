// Starts the server of a live page, tcsim-view, a process of its own at ordinary priority.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "coordinator/view/view_link.h"

namespace tcs {

struct ViewRequest {
  std::string server;                 // the server's program
  std::string folder;                 // absolute; the run writes to it; it may not be there yet
  std::string address = "127.0.0.1";  // at which the server listens
  int port = 0;                       // 0: any that is free
};

// "8080", "127.0.0.1", "192.0.2.7:8080", "[::1]:8080", "[::1]"; empty: the defaults. Empty on
// success, else one sentence.
[[nodiscard]] std::string TakeViewAddress(const std::string& text, ViewRequest* request);

// Waits until the server can be reached; or says in a sentence what is in the way. The server ends
// with the thread that calls this; call it before there are threads.
[[nodiscard]] std::variant<std::unique_ptr<ViewLink>, std::string> StartView(
    const ViewRequest& request);

}  // namespace tcs
