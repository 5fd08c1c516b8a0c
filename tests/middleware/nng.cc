// nng: a pipeline. WHERE is a URL: the receiver listens there, the sender dials it.
#include <nng/nng.h>
#include <nng/protocol/pipeline0/pull.h>
#include <nng/protocol/pipeline0/push.h>

#include "tests/middleware/talk.h"

namespace {

void Expect(int result, const char* what) {
  if (result != 0) talk::Fail(what, nng_strerror(result));
}

}  // namespace

void talk::Send(const std::string& where, const Next& next) {
  nng_socket socket;
  Expect(nng_push0_open(&socket), "nng_push0_open");
  // As often as it takes until the receiver is there.
  Expect(nng_dial(socket, where.c_str(), nullptr, NNG_FLAG_NONBLOCK), "nng_dial");
  for (Message message; next(&message);) {
    Expect(nng_send(socket, &message, sizeof message, 0), "nng_send");
  }
  nng_close(socket);
}

void talk::Receive(const std::string& where, const Take& take) {
  nng_socket socket;
  Expect(nng_pull0_open(&socket), "nng_pull0_open");
  Expect(nng_listen(socket, where.c_str(), nullptr, 0), "nng_listen");
  for (bool more = true; more;) {
    Message message;
    std::size_t size = sizeof message;
    Expect(nng_recv(socket, &message, &size, 0), "nng_recv");
    more = take(message);
  }
  nng_close(socket);
}
