// Two threads that lock two mutexes the other way round, with some time between: a deadlock. With
// the argument "pi" the mutexes lend priority.
#include <pthread.h>
#include <unistd.h>

#include <cstring>

namespace {

pthread_mutex_t g_first, g_second;

void LockBoth(pthread_mutex_t* one, pthread_mutex_t* other) {
  pthread_mutex_lock(one);
  usleep(100'000);
  pthread_mutex_lock(other);
}

void* Other(void*) {
  LockBoth(&g_second, &g_first);
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  if (argc > 1 && strcmp(argv[1], "pi") == 0)
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(&g_first, &attributes);
  pthread_mutex_init(&g_second, &attributes);
  pthread_t other;
  if (pthread_create(&other, nullptr, Other, nullptr) != 0) return 1;
  LockBoth(&g_first, &g_second);
  return 0;
}
