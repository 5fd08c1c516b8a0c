/* Four threads that allocate and free for a second; then memory is left to be purged for a minute:
 * 61 s. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
static void* Work(void* none) {
  const struct timespec pause = {0, 10000000};
  for (int i = 0; i < 100; ++i) {
    char* blocks[64];
    for (int k = 0; k < 64; ++k) memset(blocks[k] = malloc(4096 * (k % 7 + 1)), 1, 4096);
    for (int k = 0; k < 64; ++k) free(blocks[k]);
    nanosleep(&pause, NULL);
  }
  return none;
}
int main(void) {
  struct timespec start, end;
  const struct timespec minute = {60, 0};
  pthread_t threads[4];
  clock_gettime(CLOCK_MONOTONIC, &start);
  for (int i = 0; i < 4; ++i) pthread_create(&threads[i], NULL, Work, NULL);
  for (int i = 0; i < 4; ++i) pthread_join(threads[i], NULL);
  nanosleep(&minute, NULL);
  clock_gettime(CLOCK_MONOTONIC, &end);
  printf("%lld\n", (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec);
}
