#include "libtcs_preload/dds/outgoing.h"

#include <sys/uio.h>

#include <mutex>

#include "libtcs_preload/dds/muting.h"
#include "libtcs_preload/dds/own_news.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"

namespace tcs::dds {
namespace {

const Link* g_link;
std::uint32_t g_process;

std::mutex& OutboxMutex() {
  static auto* mutex = new std::mutex;
  return *mutex;
}

bool SendParts(shm::DdsMessage& message, const void* payload, std::size_t size) {
  static constexpr std::byte kZeros[8] = {};
  if (size > shm::kDdsMostPayload) return false;
  message.payload_size = static_cast<std::uint32_t>(size);
  message.size = shm::DdsMessageSize(message.payload_size);
  const iovec parts[] = {{&message, sizeof(message)},
                         {const_cast<void*>(payload), size},
                         {const_cast<std::byte*>(kZeros), message.size - sizeof(message) - size}};
  const std::lock_guard lock(OutboxMutex());
  return g_link->send(parts, 3);
}

}  // namespace

bool Join(const Link& link) {
  g_link = &link;
  g_process = link.join();
  return g_process != 0;
}

const Link& TheLink() { return *g_link; }
std::uint32_t OwnProcess() { return g_process; }

shm::DdsMessage MessageOf(shm::DdsKind kind, std::uint32_t domain, const Guid& subject) {
  shm::DdsMessage message{};
  message.kind = kind;
  message.to = shm::kDdsEverybody;
  message.lease_ns = INT64_MAX;
  message.domain = domain;
  PutGuid(subject, message.subject);
  return message;
}

void Send(const ddsi_domaingv& gv, shm::DdsMessage& message, const Payload& payload) {
  if (message.to == shm::kDdsEverybody) NoteOwnNews(message, payload);
  if (!HoldsBack(gv, message, payload.data(), payload.size())) {
    SendHeld(message, payload);
  } else if (message.to == shm::kDdsEverybody) {
    NoteToldItself(message, true);  // the message will come, if the program meets itself then
  }
}

void SendHeld(shm::DdsMessage& message, const Payload& payload) {
  if (message.to == shm::kDdsEverybody) {
    const bool is_told = MeetsItself(message.domain);
    message.flags &= static_cast<std::uint16_t>(~shm::kDdsToSender);
    if (is_told) message.flags |= shm::kDdsToSender;
    NoteToldItself(message, is_told);
  }
  if (!SendParts(message, payload.data(), payload.size())) {
    Say("the QoS of a DDS entity is too large to be announced (%zu bytes), so other programs will "
        "not find it",
        payload.size());
  }
}

void SendSample(const ddsi_domaingv& gv, shm::DdsMessage& message, const ddsi_serdata& sample,
                std::string_view topic) {
  const std::size_t size = (ddsi_serdata_size(&sample) + std::size_t{3}) & ~std::size_t{3};
  ddsrt_iovec_t bytes{};
  ddsi_serdata* held = ddsi_serdata_to_ser_ref(&sample, 0, size, &bytes);
  const bool sent =
      HoldsBack(gv, message, bytes.iov_base, size) || SendParts(message, bytes.iov_base, size);
  ddsi_serdata_to_ser_unref(held, &bytes);
  if (sent) return;
  static std::uint64_t lost;
  if (const std::uint64_t before = __atomic_fetch_add(&lost, 1, __ATOMIC_RELAXED);
      before == 0 || (before + 1) % 1000 == 0) {
    Say("a sample of DDS topic %.*s has %zu bytes and was not sent: %u is the most (%llu lost so "
        "far)",
        static_cast<int>(topic.size()), topic.data(), size, shm::kDdsMostPayload,
        static_cast<unsigned long long>(before + 1));
  }
}

void SendNudge() {
  shm::DdsMessage message = MessageOf(shm::DdsKind::kHistoryEnd, 0, Guid{});
  message.to = g_process;
  SendParts(message, nullptr, 0);
}

}  // namespace tcs::dds
