// Other names of functions that the shim replaces, as older programs and other libraries call them:
// each goes on to the plain one, whatever its arguments.
#define TCS_TWIN(twin, name)               \
  __asm__(                                 \
      ".pushsection .text\n"               \
      ".globl " #twin                      \
      "\n"                                 \
      ".type " #twin ", @function\n" #twin \
      ":\n"                                \
      "\tendbr64\n"                        \
      "\tjmp " #name                       \
      "@PLT\n"                             \
      ".size " #twin ", . - " #twin        \
      "\n"                                 \
      ".popsection\n")

TCS_TWIN(_IO_popen, popen);
TCS_TWIN(__adjtimex, adjtimex);
TCS_TWIN(__close, close);
TCS_TWIN(__connect, connect);
TCS_TWIN(__dup2, dup2);
TCS_TWIN(__fork, fork);
TCS_TWIN(__poll, poll);
TCS_TWIN(__read, read);
TCS_TWIN(__sched_getparam, sched_getparam);
TCS_TWIN(__sched_getscheduler, sched_getscheduler);
TCS_TWIN(__sched_setscheduler, sched_setscheduler);
TCS_TWIN(__sched_yield, sched_yield);
TCS_TWIN(__send, send);
TCS_TWIN(__sigaction, sigaction);
TCS_TWIN(__sigsuspend, sigsuspend);
TCS_TWIN(__sysconf, sysconf);
TCS_TWIN(__sysv_signal, sysv_signal);
TCS_TWIN(__vfork, vfork);
TCS_TWIN(__wait, wait);
TCS_TWIN(__waitpid, waitpid);
TCS_TWIN(__write, write);
TCS_TWIN(bsd_signal, signal);
TCS_TWIN(pthread_yield, sched_yield);
TCS_TWIN(ssignal, signal);
TCS_TWIN(thrd_yield, sched_yield);
