// LCM: datagrams by multicast. WHERE is LCM's own URL, the same for both.
#include <lcm/lcm.h>
#include <string.h>

#include "tests/middleware/talk.h"

namespace {

constexpr char kChannel[] = "NUMBERS";

lcm_t* Made(const std::string& where) {
  lcm_t* lcm = lcm_create(where.c_str());
  if (lcm == nullptr) talk::Fail("lcm_create", where.c_str());
  return lcm;
}

struct Receiver {
  const talk::Take& take;
  bool more = true;
};

void Handle(const lcm_recv_buf_t* received, const char*, void* data) {
  auto* receiver = static_cast<Receiver*>(data);
  talk::Message message;
  if (received->data_size != sizeof message) talk::Fail("a message", "of another size");
  memcpy(&message, received->data, sizeof message);
  receiver->more = receiver->take(message);
}

}  // namespace

void talk::Send(const std::string& where, const Next& next) {
  lcm_t* lcm = Made(where);
  for (Message message; next(&message);) {
    if (lcm_publish(lcm, kChannel, &message, sizeof message) != 0) Fail("lcm_publish", "failed");
  }
  lcm_destroy(lcm);
}

void talk::Receive(const std::string& where, const Take& take) {
  lcm_t* lcm = Made(where);
  Receiver receiver{take};
  lcm_subscribe(lcm, kChannel, Handle, &receiver);
  while (receiver.more) {
    if (lcm_handle(lcm) != 0) Fail("lcm_handle", "failed");
  }
  lcm_destroy(lcm);
}
