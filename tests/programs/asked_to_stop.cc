// Ends well when it is asked to by SIGINT, as rclpy's nodes do: the handler, in whichever thread,
// lets one thread go on, and that one wakes the main thread.
#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>

namespace {

sem_t g_asked;
pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_cond_t g_changed = PTHREAD_COND_INITIALIZER;
bool g_over = false;

void* AwaitSignal(void* argument) {
  while (sem_wait(&g_asked) != 0 && errno == EINTR) {
  }
  pthread_mutex_lock(&g_mutex);
  g_over = true;
  pthread_cond_broadcast(&g_changed);
  pthread_mutex_unlock(&g_mutex);
  return argument;
}

}  // namespace

int main() {
  sem_init(&g_asked, 0, 0);
  struct sigaction action {};
  action.sa_handler = [](int) { sem_post(&g_asked); };
  sigaction(SIGINT, &action, nullptr);
  pthread_t thread;
  pthread_create(&thread, nullptr, AwaitSignal, nullptr);
  pthread_mutex_lock(&g_mutex);
  while (!g_over) pthread_cond_wait(&g_changed, &g_mutex);
  pthread_mutex_unlock(&g_mutex);
  pthread_join(thread, nullptr);
  puts("ended well");
}
