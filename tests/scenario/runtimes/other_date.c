/* Under libfaketime, which shows another date: four threads sleep, and the program waits by poll
 * and select: 1.5 s. */
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <sys/select.h>
#include <time.h>
static void* Sleep(void* none) {
  const struct timespec half = {0, 500000000};
  nanosleep(&half, NULL);
  return none;
}
int main(void) {
  struct timespec start, end;
  struct timeval half = {0, 500000};
  pthread_t threads[4];
  clock_gettime(CLOCK_MONOTONIC, &start);
  for (int i = 0; i < 4; ++i) pthread_create(&threads[i], NULL, Sleep, NULL);
  for (int i = 0; i < 4; ++i) pthread_join(threads[i], NULL);
  poll(NULL, 0, 500);
  select(0, NULL, NULL, NULL, &half);
  clock_gettime(CLOCK_MONOTONIC, &end);
  const time_t now = time(NULL);
  fprintf(stderr, "%d\n", 1900 + gmtime(&now)->tm_year);
  printf("%lld\n", (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec);
}
