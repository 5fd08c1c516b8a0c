/* A loop that waits for nothing, and says itself where its ten activations begin. */
#include <tcs/tcs.h>

int main(void) {
  for (int i = 0; i < 10; ++i) {
    tcs_mark();
    const int64_t until = tcs_now() + 2000000;
    while (tcs_now() < until) {
    }
  }
  return tcs_is_running() ? 0 : 3;
}
