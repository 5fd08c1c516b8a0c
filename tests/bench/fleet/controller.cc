// controller SENSOR_PORT [COMMAND_PORT]: holds a drone at a height. For each reading that comes it
// sends a command; without a port for commands it reads nothing. It knows nothing of tcs.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr double kWeight = 2 * 9.81;
constexpr double kHeight = 2;

using Vector = std::array<double, 3>;

sockaddr_in LocalPort(const char* port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

// The list that follows "KEY":[ in the text.
bool Read(const char* text, const char* key, Vector* vector) {
  const char* at = std::strstr(text, key);
  if (at == nullptr) return false;
  at += std::strlen(key);
  for (double& component : *vector) {
    char* end = nullptr;
    component = std::strtod(at, &end);
    if (end == at) return false;
    at = end + 1;
  }
  return true;
}

int Complain() {
  std::perror("controller");
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  const int sensors = socket(AF_INET, SOCK_DGRAM, 0), commands = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in from = LocalPort(argv[1]);
  if (bind(sensors, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0) return Complain();
  for (; argc == 2;) pause();
  const sockaddr_in to = LocalPort(argv[2]);
  if (connect(commands, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) return Complain();
  for (;;) {
    char text[4096], command[256];
    const ssize_t size = recv(sensors, text, sizeof text - 1, 0);
    if (size < 0) return 1;
    text[size] = 0;
    Vector p, v;
    if (!Read(text, "\"position\":[", &p) || !Read(text, "\"linear_velocity\":[", &v)) return 1;
    const int length =
        std::snprintf(command, sizeof command, "{\"force\": [%.9g, %.9g, %.9g]}", -2 * v[0],
                      -4 * p[1] - 4 * v[1], kWeight - 8 * (p[2] - kHeight) - 6 * v[2]);
    if (send(commands, command, static_cast<std::size_t>(length), 0) != length) return 1;
  }
}
