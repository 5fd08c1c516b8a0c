// The way around DDS by which the two processes of a scenario agree on how far they are: a socket
// between them. What is said here arrives before or after what DDS carries; a scenario must not
// count on either.
#pragma once

#include <cstddef>

namespace dds_test {

class Peer {
 public:
  explicit Peer(int socket) : socket_(socket) {}

  // Says that `step` is reached; waits until the other process says so.
  void Reached(const char* step);
  void Await(const char* step);
  // Both processes are here.
  void Meet(const char* step) {
    Reached(step);
    Await(step);
  }

  template <class T>
  void Send(const T& value) {
    Write(&value, sizeof value);
  }
  template <class T>
  T Receive() {
    T value;
    Read(&value, sizeof value);
    return value;
  }

 private:
  void Write(const void* bytes, std::size_t size);
  void Read(void* bytes, std::size_t size);

  int socket_;
};

}  // namespace dds_test
