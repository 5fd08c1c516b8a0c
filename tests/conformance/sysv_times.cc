// System V objects tell when they were made, changed and used: by the clock that the program reads.
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

void Must(bool holds, const char* what) { EXPECT(holds, "%s: %s", what, strerror(errno)); }

time_t Seconds() { return time(nullptr); }
void LetTimePass() { usleep(g_mode == Mode::kNative ? 1'100'000 : 500'000'000); }

void ExpectAt(time_t told, time_t from, time_t to, const char* what) {
  EXPECT(from <= told && told <= to, "%s at %lld, not from %lld to %lld", what, (long long)told,
         (long long)from, (long long)to);
}

template <class F>
void InAChild(F f) {
  const pid_t pid = fork();
  if (pid == 0) {
    f();
    _exit(0);
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "a child: %#x", status);
}

void Messages() {
  struct {
    long type = 1;
    char text[8] = "text";
  } message;
  const time_t made = Seconds();
  const int id = msgget(IPC_PRIVATE, 0600);
  Must(id >= 0, "msgget");
  msqid_ds status;
  Must(msgctl(id, IPC_STAT, &status) == 0, "msgctl");
  ExpectAt(status.msg_ctime, made, Seconds(), "made");
  EXPECT(status.msg_stime == 0 && status.msg_rtime == 0, "used before it was");
  LetTimePass();
  const time_t sent = Seconds();
  InAChild([&] { Must(msgsnd(id, &message, sizeof message.text, 0) == 0, "msgsnd"); });
  const time_t was_sent = Seconds();
  LetTimePass();
  const time_t got = Seconds();
  Must(msgrcv(id, &message, sizeof message.text, 0, 0) >= 0, "msgrcv");
  Must(msgctl(id, IPC_STAT, &status) == 0, "msgctl");
  ExpectAt(status.msg_ctime, made, made + 1, "made");
  ExpectAt(status.msg_stime, sent, was_sent, "sent");
  ExpectAt(status.msg_rtime, got, Seconds(), "received");
  LetTimePass();
  const time_t set = Seconds();
  Must(msgctl(id, IPC_SET, &status) == 0, "IPC_SET");
  Must(msgctl(id, IPC_STAT, &status) == 0, "msgctl");
  ExpectAt(status.msg_ctime, set, Seconds(), "changed");
  Must(msgctl(id, IPC_RMID, nullptr) == 0, "IPC_RMID");
}

void Semaphores() {
  const time_t made = Seconds();
  const int id = semget(IPC_PRIVATE, 1, 0600);
  Must(id >= 0, "semget");
  semid_ds status;
  Must(semctl(id, 0, IPC_STAT, &status) == 0, "semctl");
  ExpectAt(status.sem_ctime, made, Seconds(), "made");
  EXPECT(status.sem_otime == 0, "used before it was");
  LetTimePass();
  const time_t used = Seconds();
  InAChild([&] {
    sembuf up{0, 1, 0};
    Must(semop(id, &up, 1) == 0, "semop");
  });
  const time_t was_used = Seconds();
  LetTimePass();
  Must(semctl(id, 0, IPC_STAT, &status) == 0, "semctl");
  ExpectAt(status.sem_otime, used, was_used, "used");
  const time_t set = Seconds();
  Must(semctl(id, 0, SETVAL, 3) == 0, "SETVAL");
  Must(semctl(id, 0, IPC_STAT, &status) == 0, "semctl");
  ExpectAt(status.sem_ctime, set, Seconds(), "changed");
  Must(semctl(id, 0, IPC_RMID) == 0, "IPC_RMID");
}

void Memory() {
  const time_t made = Seconds();
  const int id = shmget(IPC_PRIVATE, 4096, 0600);
  Must(id >= 0, "shmget");
  LetTimePass();
  const time_t attached = Seconds();
  void* at = shmat(id, nullptr, 0);
  Must(at != reinterpret_cast<void*>(-1), "shmat");
  shmid_ds status;
  Must(shmctl(id, IPC_STAT, &status) == 0, "shmctl");
  ExpectAt(status.shm_ctime, made, made + 1, "made");
  ExpectAt(status.shm_atime, attached, Seconds(), "attached");
  EXPECT(status.shm_dtime == 0, "detached before it was");
  LetTimePass();
  const time_t detached = Seconds();
  Must(shmdt(at) == 0, "shmdt");
  const time_t was_detached = Seconds();
  LetTimePass();
  Must(shmctl(id, IPC_STAT, &status) == 0, "shmctl");
  ExpectAt(status.shm_dtime, detached, was_detached, "detached");
  Must(shmctl(id, IPC_RMID, nullptr) == 0, "IPC_RMID");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ForEachAtOnceNatively(std::initializer_list<void (*)()>{Messages, Semaphores, Memory},
                        [](void (*part)()) { part(); });
}
