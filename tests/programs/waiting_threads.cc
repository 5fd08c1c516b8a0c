// A program that hangs, each of its threads in another way: one waits for a mutex that the first
// one has, one sleeps, one reads from a socket to which nobody sends, one computes.
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <thread>

namespace {

std::mutex held;
std::atomic<bool> never{false};

template <class Body>
std::thread Named(const char* name, Body body) {
  return std::thread([name, body] {
    pthread_setname_np(pthread_self(), name);
    body();
  });
}

}  // namespace

int main() {
  const std::lock_guard lock(held);
  std::thread locker = Named("locker", [] { const std::lock_guard again(held); });
  std::thread sleeper = Named("sleeper", [] { sleep(3'000'000); });
  std::thread reader = Named("reader", [] {
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in anywhere{};
    anywhere.sin_family = AF_INET;
    bind(fd, reinterpret_cast<sockaddr*>(&anywhere), sizeof anywhere);
    char byte;
    recv(fd, &byte, 1, 0);
  });
  std::thread worker = Named("worker", [] {
    while (!never.load(std::memory_order_relaxed)) {
    }
  });
  worker.join();
}
