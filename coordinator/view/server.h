// The server of a run's page: gives the page and what is new of the run, and notes what people want
// of the run. The server reads what it shows from the run's folder, so that the run does not know
// of the server.
//
// A refused request is answered by a status alone. Requests are small; the server gives up one that
// is sent slowly after two seconds. Thread-safe where not said otherwise.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "coordinator/report/live_run.h"
#include "coordinator/view/auth.h"
#include "coordinator/view/control_page.h"

namespace httplib {
class Server;
struct Request;
struct Response;
}  // namespace httplib

namespace tcs {

class ViewServer {
 public:
  // `control` outlives this. It is null where the run does not look at what people want.
  ViewServer(std::string folder, ControlPage* control);
  ~ViewServer();

  // Listens at a number; port 0: any that is free. Empty on success, else one sentence.
  [[nodiscard]] std::string Bind(const std::string& address, int port);
  // The address to open in a browser. Valid once the server listens.
  const std::string& url() const { return url_; }
  // Answers until the process ends; tells the run when all who watch know of the run's end.
  void Serve();

 private:
  using Clock = std::chrono::steady_clock;

  void Route();
  void GivePage(httplib::Response& answer);
  void GiveNews(const httplib::Request& request, httplib::Response& answer);
  void TakeControlRequest(const httplib::Request& request, httplib::Response& answer);
  void LookAtRun();
  bool HasEnded() const;
  nlohmann::ordered_json Status() const;
  std::string WholeReport() const;

  const std::string folder_;
  ControlPage* const control_;
  const std::unique_ptr<httplib::Server> http_;
  std::unique_ptr<Auth> auth_;
  std::string url_;
  const Clock::time_point begun_ = Clock::now();

  std::mutex mutex_;  // guards all below
  report::LiveRun run_;
  Clock::time_point looked_{};
  bool looked_at_end_ = false;
  std::atomic<Clock::time_point> asked_{Clock::time_point{}}, told_{Clock::time_point{}};
};

}  // namespace tcs
