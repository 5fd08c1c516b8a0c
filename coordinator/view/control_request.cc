#include "coordinator/view/control_request.h"

#include <charconv>
#include <system_error>

namespace tcs {

namespace {

constexpr std::int64_t kLongestStepNs = 3'600'000'000'000;
constexpr double kLeastPace = 1e-3, kMostPace = 1e3;

template <class Number>
std::optional<Number> NumberAfter(std::string_view word, std::string_view words) {
  if (!words.starts_with(word)) return {};
  words.remove_prefix(word.size());
  Number number{};
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), number);
  if (error != std::errc{} || end != words.data() + words.size()) return {};
  return number;
}

}  // namespace

std::optional<ControlRequest> ParseControlRequest(std::string_view words) {
  if (words == "stand") return ControlRequest{.kind = ControlRequest::Kind::kStand};
  if (words == "go") return ControlRequest{.kind = ControlRequest::Kind::kGo};
  if (const auto ns = NumberAfter<std::int64_t>("step ", words);
      ns && *ns >= 1 && *ns <= kLongestStepNs) {
    return ControlRequest{.kind = ControlRequest::Kind::kStep, .step_ns = *ns};
  }
  if (const auto pace = NumberAfter<double>("pace ", words);
      pace && (*pace == 0 || (*pace >= kLeastPace && *pace <= kMostPace))) {
    return ControlRequest{.kind = ControlRequest::Kind::kPace, .pace = *pace};
  }
  return {};
}

void Ask(const ControlRequest& asked, ControlPage* page) {
  if (asked.kind == ControlRequest::Kind::kPace) {
    page->pace.store(asked.pace);
  } else {
    page->stands.store(asked.kind == ControlRequest::Kind::kGo ? 0 : 1);
  }
  if (asked.kind == ControlRequest::Kind::kStep) page->stepped_ns.fetch_add(asked.step_ns);
  page->asked.fetch_add(1, std::memory_order_release);
}

}  // namespace tcs
