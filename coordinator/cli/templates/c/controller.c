/* Holds the drone one metre above the ground: reads its state on one UDP port, and answers with a
 * force on another. An ordinary program: nothing here knows of tcs. */
#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

static const double kMass = 1.0, kGravity = 9.81;     /* kg, m/s^2 */
static const double kStiffness = 9.0, kDamping = 6.0; /* N/m, N*s/m */
static const double kGoal[3] = {0.0, 0.0, 1.0};       /* m */

static struct sockaddr_in Local(unsigned short port) {
  struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(port)};
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/* The three numbers of "key":[x,y,z]; 0 where it is not there. */
static int Read3(const char* message, const char* key, double v[3]) {
  const char* at = strstr(message, key);
  at = at ? strchr(at, '[') : NULL;
  return at && sscanf(at, "[%lf,%lf,%lf]", &v[0], &v[1], &v[2]) == 3;
}

int main(void) {
  const int sensors = socket(AF_INET, SOCK_DGRAM, 0), thrust = socket(AF_INET, SOCK_DGRAM, 0);
  const struct sockaddr_in listens = Local(21010), to = Local(21011);
  if (bind(sensors, (const struct sockaddr*)&listens, sizeof listens) != 0) {
    perror("bind to port 21010");
    return 1;
  }
  for (;;) {
    char message[65536];
    const ssize_t size = recv(sensors, message, sizeof message - 1, 0);
    if (size < 0) return 1;
    message[size] = '\0';
    double x[3], v[3], force[3];
    if (!Read3(message, "\"position\"", x) || !Read3(message, "\"linear_velocity\"", v)) continue;
    for (int i = 0; i < 3; ++i) force[i] = kStiffness * (kGoal[i] - x[i]) - kDamping * v[i];
    force[2] += kMass * kGravity;
    char answer[200];
    const int length = snprintf(answer, sizeof answer, "{\"force\": [%.9g, %.9g, %.9g]}", force[0],
                                force[1], force[2]);
    sendto(thrust, answer, (size_t)length, 0, (const struct sockaddr*)&to, sizeof to);
  }
}
