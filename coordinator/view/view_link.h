// The coordinator's end of the page that it shares with the server of a live page: what people ask
// of the run, and what they are told of how it goes. It costs a load from memory to see that nobody
// has asked for anything.
//
// For the coordinator's thread only. The server is another process, and whatever it does the run
// goes on.
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
    std::int64_t step_ns = 0;  // since the last time; 0: none
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

  // How the run begins. Before anybody is told the address: it would undo what they ask for.
  void Begin(double pace, bool stands);
  // What is wanted now; none where nothing was asked for since the last time.
  std::optional<ControlRequests> Take();
  void Tell(const Status& status);
  // True once the server has ended. A system call.
  bool IsGone() const;

  // The run has ended, at virtual `now_ns`: waits, in real time, until those who watch it know, a
  // second at most.
  void Conclude(std::int64_t now_ns);

 private:
  ControlPage* page_;
  UniqueFd server_;
  std::string url_;
  std::uint32_t asked_ = 0;
  std::int64_t stepped_ns_ = 0;
};

}  // namespace tcs
