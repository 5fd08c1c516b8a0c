/* Eight threads of the least stack that there is wait in turn by select, poll, nanosleep and a
 * child: 8 s. */
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/select.h>
#include <time.h>
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static void* Wait(void* none) {
  struct timeval timeout = {0, 250000};
  const struct timespec pause = {0, 250000000};
  pthread_mutex_lock(&mutex);
  select(0, NULL, NULL, NULL, &timeout);
  poll(NULL, 0, 250);
  nanosleep(&pause, NULL);
  if (system("sleep 0.25") != 0) puts("system");
  pthread_mutex_unlock(&mutex);
  return none;
}
int main(void) {
  struct timespec start, end;
  pthread_attr_t attributes;
  pthread_t threads[8];
  clock_gettime(CLOCK_MONOTONIC, &start);
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, PTHREAD_STACK_MIN);
  for (int i = 0; i < 8; ++i) pthread_create(&threads[i], &attributes, Wait, NULL);
  for (int i = 0; i < 8; ++i) pthread_join(threads[i], NULL);
  clock_gettime(CLOCK_MONOTONIC, &end);
  printf("%lld\n", (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec);
}
