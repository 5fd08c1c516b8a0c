// nanomsg: a pipeline. WHERE is a URL: the receiver binds it, the sender connects to it.
#include <nanomsg/nn.h>
#include <nanomsg/pipeline.h>

#include "tests/middleware/talk.h"

namespace {

int Expect(int result, const char* what) {
  if (result < 0) talk::Fail(what, nn_strerror(nn_errno()));
  return result;
}

}  // namespace

void talk::Send(const std::string& where, const Next& next) {
  const int socket = Expect(nn_socket(AF_SP, NN_PUSH), "nn_socket");
  Expect(nn_connect(socket, where.c_str()), "nn_connect");
  for (Message message; next(&message);) {
    Expect(nn_send(socket, &message, sizeof message, 0), "nn_send");
  }
  nn_close(socket);
}

void talk::Receive(const std::string& where, const Take& take) {
  const int socket = Expect(nn_socket(AF_SP, NN_PULL), "nn_socket");
  Expect(nn_bind(socket, where.c_str()), "nn_bind");
  for (bool more = true; more;) {
    Message message;
    Expect(nn_recv(socket, &message, sizeof message, 0), "nn_recv");
    more = take(message);
  }
  nn_close(socket);
}
