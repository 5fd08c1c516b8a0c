#include "coordinator/view/server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include "coordinator/report/live_page.h"
#include "coordinator/report/page.h"
#include "coordinator/report/read_results.h"
#include "coordinator/report/text.h"
#include "coordinator/text/csv.h"
#include "coordinator/view/control_request.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

constexpr std::size_t kMostBody = 256, kThreads = 24;
constexpr auto kLookEvery = 60ms, kPatience = 2000ms, kWatches = 1500ms, kForOthers = 250ms;
constexpr int kRefused = 403, kUnknown = 404, kNotUnderstood = 400, kConflict = 409;
// An answer is not for other pages, is not kept, and is nothing but what it is said to be.
const httplib::Headers kHeaders{
    {"Content-Security-Policy",
     "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src "
     "'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"X-Content-Type-Options", "nosniff"},
    {"Cache-Control", "no-store"}};

// Sends the text uncompressed: to compress what stays on this machine is a waste.
void Give(httplib::Response& answer, std::string text, const char* type) {
  const auto shared = std::make_shared<const std::string>(std::move(text));
  answer.set_content_provider(
      shared->size(), type,
      [shared](std::size_t offset, std::size_t length, httplib::DataSink& to) {
        return to.write(shared->data() + offset, std::min(length, shared->size() - offset));
      });
}

std::size_t NumberOf(const httplib::Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? number : 0;
}

const char* NameOf(RunStage stage) {
  switch (stage) {
    case RunStage::kStarting:
      return "starting";
    case RunStage::kStands:
      return "stands";
    case RunStage::kEnded:
      return "ended";
    case RunStage::kGoesOn:
      break;
  }
  return "goes on";
}

}  // namespace

ViewServer::ViewServer(std::string folder, ControlPage* control)
    : folder_(std::move(folder)),
      control_(control),
      http_(std::make_unique<httplib::Server>()),
      run_(folder_) {}

ViewServer::~ViewServer() = default;

std::string ViewServer::Bind(const std::string& address, int port) {
  // The port is to be ours alone.
  http_->set_socket_options([](int socket) {
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  });
  errno = 0;
  const int bound = port == 0                            ? http_->bind_to_any_port(address)
                    : http_->bind_to_port(address, port) ? port
                                                         : -1;
  if (bound <= 0) {
    return fmt::format(
        "the page cannot be shown at {}, port {}: {}; choose another one with --view=PORT", address,
        port, errno != 0 ? strerror(errno) : "it cannot listen there");
  }
  std::string token = MakeToken();
  if (token.empty())
    return "the kernel has no random numbers to give, so the page would have no secret address";
  auth_ = std::make_unique<Auth>(std::move(token), address, bound);
  url_ = auth_->url();
  Route();
  return {};
}

void ViewServer::Route() {
  http_->new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http_->set_default_headers(kHeaders);
  http_->set_payload_max_length(kMostBody);
  http_->set_read_timeout(kPatience);
  http_->set_write_timeout(kPatience);
  http_->set_keep_alive_timeout(2);
  http_->set_keep_alive_max_count(1'000'000);
  http_->set_tcp_nodelay(true);
  // This handler knows all that there is: it decides before anything of a request's body is read,
  // and tells nothing to a client that is not to know what is there.
  http_->set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& answer) {
        const bool names_one_host = request.get_header_value_count("Host") == 1;
        const auto rest = auth_->Authorize({.path = request.path,
                                            .host = request.get_header_value("Host"),
                                            .origin = request.get_header_value("Origin")});
        if (!names_one_host || !rest) {
          answer.status = kRefused;
          return httplib::Server::HandlerResponse::Handled;
        }
        if (request.method == "POST" && *rest == "control")
          return httplib::Server::HandlerResponse::Unhandled;
        if (request.method == "GET" && *rest == "") {
          GivePage(answer);
        } else if (request.method == "GET" && *rest == "news") {
          GiveNews(request, answer);
        } else {
          answer.status = kUnknown;
        }
        return httplib::Server::HandlerResponse::Handled;
      });
  http_->Post("/.*", [this](const httplib::Request& request, httplib::Response& answer) {
    TakeControlRequest(request, answer);
  });
}

bool ViewServer::HasEnded() const {
  if (control_ != nullptr) return control_->stage.load() == RunStage::kEnded;
  return IsFile(folder_ + "/summary.json") || IsFile(folder_ + "/unfinished.json");
}

void ViewServer::LookAtRun() {
  // While the run starts, it has yet to remove what an earlier run has left in the folder.
  if (control_ != nullptr && control_->stage.load() == RunStage::kStarting) return;
  const bool is_end = HasEnded() && !std::exchange(looked_at_end_, HasEnded());
  if (!is_end && Clock::now() - looked_ < kLookEvery) return;
  looked_ = Clock::now();
  run_.Look();
  if (is_end) run_.Look();  // the run has ended: nothing more comes
}

Json ViewServer::Status() const {
  using std::chrono::nanoseconds;
  if (control_ == nullptr) {
    return {{"stage", HasEnded() ? "ended" : "goes on"},
            {"now", std::llround(run_.LastS() * 1e9)},
            {"real", nanoseconds(Clock::now() - begun_).count()},
            {"end", 0},
            {"behind", 0},
            {"pace", 0},
            {"wantsStand", false},
            {"reports", true}};
  }
  return {{"stage", NameOf(control_->stage.load())},
          {"now", control_->now_ns.load()},
          {"real", control_->real_ns.load()},
          {"end", control_->end_ns.load()},
          {"behind", control_->behind_ns.load()},
          {"pace", control_->pace.load()},
          {"wantsStand", control_->stands.load() != 0},
          {"asked", control_->asked.load()},
          {"taken", control_->taken.load()},
          {"reports", false}};
}

std::string ViewServer::WholeReport() const {
  const auto read = report::ReadResults({folder_}, {}, report::Distance::kLeftOut);
  if (const auto* error = std::get_if<LoadError>(&read)) {
    return fmt::format("<!DOCTYPE html><meta charset=\"utf-8\"><title>tcsim</title><p>{}</p>",
                       report::Escaped(error->message));
  }
  return report::MakePage(std::get<report::Results>(read), {}).html;
}

void ViewServer::GivePage(httplib::Response& answer) {
  constexpr const char* kType = "text/html; charset=utf-8";
  if (control_ == nullptr && HasEnded()) return Give(answer, WholeReport(), kType);
  const std::scoped_lock lock(mutex_);
  LookAtRun();
  const report::LivePageOptions options{.title = std::filesystem::path(folder_).filename().string(),
                                        .may_control = control_ != nullptr};
  Give(answer, report::LivePage(options, run_.NewsSince({})), kType);
}

void ViewServer::GiveNews(const httplib::Request& request, httplib::Response& answer) {
  const std::scoped_lock lock(mutex_);
  // HasEnded() comes before the look, so that nothing is missing that came before the end.
  const bool has_ended = HasEnded();
  Json status = Status();
  LookAtRun();
  Json news = run_.NewsSince({.generation = NumberOf(request, "generation"),
                              .moments = NumberOf(request, "moments"),
                              .said = NumberOf(request, "said"),
                              .slices = NumberOf(request, "slices")});
  news["status"] = std::move(status);
  Give(answer, news.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json");
  asked_ = Clock::now();
  if (has_ended && told_.load() == Clock::time_point{}) told_ = Clock::now();
}

void ViewServer::TakeControlRequest(const httplib::Request& request, httplib::Response& answer) {
  if (control_ == nullptr || HasEnded()) {
    answer.status = kConflict;
    return;
  }
  const auto asked = ParseControlRequest(request.body);
  if (!asked) {
    answer.status = kNotUnderstood;
    return;
  }
  const std::scoped_lock lock(mutex_);
  Ask(*asked, control_);
  Give(answer, Status().dump(), "application/json");
}

void ViewServer::Serve() {
  std::thread([this] { http_->listen_after_bind(); }).detach();
  for (;;) {
    std::this_thread::sleep_for(20ms);
    if (control_ == nullptr || !HasEnded()) continue;
    const auto now = Clock::now(), told = told_.load();
    const bool nobody_watches = now - asked_.load() > kWatches;
    const bool has_told = told != Clock::time_point{} && now - told > kForOthers;
    if (nobody_watches || has_told) control_->has_told.store(1);
  }
}

}  // namespace tcs
