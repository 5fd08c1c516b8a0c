// The coordinator's end of the page that it shares with the server of a live page: what people ask
// of the run, and what the run tells them of how it goes. To see that nobody has asked for anything
// costs a load from memory.
//
// For the coordinator's thread only. The server is another process, and the run goes on whatever
// the server does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/port/unique_fd.h"
#include "coordinator/view/control_page.h"

namespace tcs {

class ViewLink {
 public:
  struct ControlRequests {
    double pace = 0;
    bool stands = false;
    std::int64_t step_ns = 0;  // since the last Take(); 0: none
  };
  struct Status {
    RunStage stage = RunStage::kGoesOn;
    std::int64_t now_ns = 0, end_ns = 0;      // virtual
    std::int64_t real_ns = 0, behind_ns = 0;  // real
  };

  // `page` is mapped for as long as this lives; `server` is a pidfd. `url` is where people look.
  ViewLink(ControlPage* page, UniqueFd server, std::string url);
  ~ViewLink();
  ViewLink(const ViewLink&) = delete;
  ViewLink& operator=(const ViewLink&) = delete;

  const std::string& url() const { return url_; }

  // Sets how the run begins. Call it before anybody is told the address: it would undo what people
  // ask for.
  void Begin(double pace, bool stands);
  // The requests as they stand now; none where nothing was asked for since the last call.
  std::optional<ControlRequests> Take();
  void Tell(const Status& status);
  // True once the server has ended. Makes a system call.
  bool IsGone() const;

  // Tells that the run has ended, at virtual `now_ns`, and waits, in real time, until those who
  // watch it know, a second at most.
  void Conclude(std::int64_t now_ns);

 private:
  ControlPage* page_;
  UniqueFd server_;
  std::string url_;
  std::uint32_t asked_ = 0;
  std::int64_t stepped_ns_ = 0;
};

}  // namespace tcs
