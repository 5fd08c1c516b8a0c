// ZeroMQ's timeouts. It looks at the clock only where the cycle counter has gone on.
#include <zmq.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void* Socket(void* context, int type, const char* name, bool binds) {
  void* socket = zmq_socket(context, type);
  EXPECT(socket != nullptr, "zmq_socket: %s", zmq_strerror(zmq_errno()));
  const int result = binds ? zmq_bind(socket, name) : zmq_connect(socket, name);
  EXPECT(result == 0, "%s: %s", name, zmq_strerror(zmq_errno()));
  return socket;
}

void Set(void* socket, int option, int value) {
  EXPECT(zmq_setsockopt(socket, option, &value, sizeof value) == 0, "option %d", option);
}

// It counts in milliseconds. Where it is measured, what it computes itself is the host's.
void ExpectTook(std::int64_t start, std::int64_t wanted_ns, const char* what) {
  const std::int64_t passed = Now() - start;
  const std::int64_t own = g_mode == Mode::kMeasured ? 5 * kMs : kMs;
  const std::int64_t most = g_mode == Mode::kNative ? kSecond : own + wanted_ns / 100;
  EXPECT(passed > wanted_ns - kMs && passed < wanted_ns + most, "%s of %lld ms took %lld ns", what,
         (long long)(wanted_ns / kMs), (long long)passed);
}

void PollsEndInTime(void* context) {
  void* socket = Socket(context, ZMQ_PULL, "inproc://polled", true);
  zmq_pollitem_t item{socket, 0, ZMQ_POLLIN, 0};
  for (const int ms : {1, 20, 100}) {
    const std::int64_t start = Now();
    EXPECT(zmq_poll(&item, 1, ms) == 0, "zmq_poll");
    ExpectTook(start, ms * kMs, "zmq_poll");
  }
  zmq_close(socket);
}

void ReceivesEndInTime(void* context) {
  void* socket = Socket(context, ZMQ_ROUTER, "inproc://received", true);
  Set(socket, ZMQ_RCVTIMEO, 50);
  char byte;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t start = Now();
    EXPECT(zmq_recv(socket, &byte, 1, 0) == -1 && zmq_errno() == EAGAIN, "zmq_recv");
    ExpectTook(start, 50 * kMs, "zmq_recv");
  }
  zmq_close(socket);
}

// A request to a ROUTER and its answer, over TCP.
void RoutersAnswerAtOnce(void* context) {
  void* router = Socket(context, ZMQ_ROUTER, "tcp://127.0.0.1:*", true);
  char where[64];
  std::size_t size = sizeof where;
  EXPECT(zmq_getsockopt(router, ZMQ_LAST_ENDPOINT, where, &size) == 0, "ZMQ_LAST_ENDPOINT");
  void* dealer = Socket(context, ZMQ_DEALER, where, false);
  for (void* socket : {router, dealer}) Set(socket, ZMQ_RCVTIMEO, 10'000);
  const std::int64_t start = Now();
  for (int i = 0; i < 20; ++i) {
    char identity[256], body[8];
    EXPECT(zmq_send(dealer, "ask", 3, 0) == 3, "zmq_send");
    const int identity_size = zmq_recv(router, identity, sizeof identity, 0);
    EXPECT(identity_size > 0 && zmq_recv(router, body, sizeof body, 0) == 3, "the router");
    zmq_send(router, identity, static_cast<std::size_t>(identity_size), ZMQ_SNDMORE);
    EXPECT(zmq_send(router, "say", 3, 0) == 3, "zmq_send");
    EXPECT(zmq_recv(dealer, body, sizeof body, 0) == 3, "the dealer");
  }
  const std::int64_t passed = Now() - start;
  // Less than the 40 ms for which the kernel keeps an acknowledgement back, each time.
  const std::int64_t most = (g_mode == Mode::kMeasured ? 500 : 50) * kMs;
  EXPECT(passed < (g_mode == Mode::kNative ? 5 * kSecond : most), "20 answers took %lld ns",
         (long long)passed);
  zmq_close(dealer);
  zmq_close(router);
}

// One that subscribes waits for 20 ms each time that nothing has come yet.
void SubscribersWaitInTime(void* context) {
  void* publisher = Socket(context, ZMQ_PUB, "inproc://published", true);
  void* subscriber = Socket(context, ZMQ_SUB, "inproc://published", false);
  EXPECT(zmq_setsockopt(subscriber, ZMQ_SUBSCRIBE, "", 0) == 0, "ZMQ_SUBSCRIBE");
  Set(subscriber, ZMQ_RCVTIMEO, 20);
  char byte;
  std::int64_t start = Now();
  while (zmq_send(publisher, "x", 1, 0) == 1 && zmq_recv(subscriber, &byte, 1, 0) != 1) continue;
  EXPECT(Now() - start < kSecond, "it never came");
  start = Now();
  EXPECT(zmq_recv(subscriber, &byte, 1, 0) == -1, "it came twice");
  ExpectTook(start, 20 * kMs, "a subscriber's wait");
  zmq_close(subscriber);
  zmq_close(publisher);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  void* context = zmq_ctx_new();
  PollsEndInTime(context);
  ReceivesEndInTime(context);
  RoutersAnswerAtOnce(context);
  SubscribersWaitInTime(context);
  zmq_ctx_term(context);
}
