#include "libtcs_preload/dds/own_news.h"

#include <algorithm>
#include <mutex>

#include "libtcs_preload/dds/guid.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

struct KeptNews {
  std::mutex mutex;
  std::vector<OwnNews> news;
};

KeptNews& TheKeptNews() {
  static auto* state = new KeptNews;
  return *state;
}

}  // namespace

void NoteOwnNews(const shm::DdsMessage& message, const Payload& payload) {
  const bool is_participant = message.kind == shm::DdsKind::kParticipant;
  if (!is_participant && message.kind != shm::DdsKind::kEndpoint &&
      message.kind != shm::DdsKind::kTopic) {
    return;
  }
  const Guid subject = GuidAt(message.subject);
  KeptNews& state = TheKeptNews();
  const std::lock_guard lock(state.mutex);
  if ((message.flags & shm::kDdsGone) != 0) {
    // A participant takes its endpoints along.
    std::erase_if(state.news, [&](const OwnNews& news) {
      return GuidAt(news.message.subject) == subject ||
             (is_participant && GuidAt(news.message.other) == subject);
    });
    return;
  }
  const auto before = std::ranges::find_if(state.news, [&subject](const OwnNews& news) {
    return GuidAt(news.message.subject) == subject;
  });
  OwnNews& news = before != state.news.end() ? *before : state.news.emplace_back();
  news = {message, payload};
  news.message.from = OwnProcess();
  news.message.payload_size = static_cast<std::uint32_t>(payload.size());
  news.message.size = shm::DdsMessageSize(news.message.payload_size);
}

void NoteToldItself(const shm::DdsMessage& message, bool is_told) {
  const Guid subject = GuidAt(message.subject);
  KeptNews& state = TheKeptNews();
  const std::lock_guard lock(state.mutex);
  for (OwnNews& news : state.news) {
    if (GuidAt(news.message.subject) != subject) continue;
    news.message.flags &= static_cast<std::uint16_t>(~shm::kDdsToSender);
    if (is_told) news.message.flags |= shm::kDdsToSender;
  }
}

std::vector<OwnNews> NewsOf(const ddsi_domaingv& gv) {
  KeptNews& state = TheKeptNews();
  const std::lock_guard lock(state.mutex);
  std::vector<OwnNews> all;
  std::ranges::copy_if(state.news, std::back_inserter(all), [&gv](const OwnNews& news) {
    const bool is_participant = news.message.kind == shm::DdsKind::kParticipant;
    return IsParticipant(&gv, GuidAt(is_participant ? news.message.subject : news.message.other));
  });
  return all;
}

std::vector<OwnNews> NewsForItself() {
  KeptNews& state = TheKeptNews();
  const std::lock_guard lock(state.mutex);
  std::vector<OwnNews> all;
  std::ranges::copy_if(state.news, std::back_inserter(all), [](const OwnNews& news) {
    return (news.message.flags & shm::kDdsToSender) == 0 && MeetsItself(news.message.domain);
  });
  return all;
}

}  // namespace tcs::dds
