// ZeroMQ: a pipeline. WHERE is a URL: the receiver binds it, the sender connects to it.
#include <zmq.h>

#include "tests/middleware/talk.h"

namespace {

int Expect(int result, const char* what) {
  if (result < 0) talk::Fail(what, zmq_strerror(zmq_errno()));
  return result;
}

}  // namespace

void talk::Send(const std::string& where, const Next& next) {
  void* context = zmq_ctx_new();
  void* socket = zmq_socket(context, ZMQ_PUSH);
  Expect(zmq_connect(socket, where.c_str()), "zmq_connect");
  for (Message message; next(&message);) {
    Expect(zmq_send(socket, &message, sizeof message, 0), "zmq_send");
  }
  zmq_close(socket);
  zmq_ctx_term(context);
}

void talk::Receive(const std::string& where, const Take& take) {
  void* context = zmq_ctx_new();
  void* socket = zmq_socket(context, ZMQ_PULL);
  Expect(zmq_bind(socket, where.c_str()), "zmq_bind");
  for (bool more = true; more;) {
    Message message;
    Expect(zmq_recv(socket, &message, sizeof message, 0), "zmq_recv");
    more = take(message);
  }
  zmq_close(socket);
  zmq_ctx_term(context);
}
