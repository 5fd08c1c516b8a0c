// Other names of functions that the shim replaces, as older programs and other libraries call them:
// each alias goes on to the plain function, whatever its arguments.
#define TCS_ALIAS(alias, name)               \
  __asm__(                                   \
      ".pushsection .text\n"                 \
      ".globl " #alias                       \
      "\n"                                   \
      ".type " #alias ", @function\n" #alias \
      ":\n"                                  \
      "\tendbr64\n"                          \
      "\tjmp " #name                         \
      "@PLT\n"                               \
      ".size " #alias ", . - " #alias        \
      "\n"                                   \
      ".popsection\n")

TCS_ALIAS(_IO_popen, popen);
TCS_ALIAS(__adjtimex, adjtimex);
TCS_ALIAS(__close, close);
TCS_ALIAS(__connect, connect);
TCS_ALIAS(__dup2, dup2);
TCS_ALIAS(__fork, fork);
TCS_ALIAS(__poll, poll);
TCS_ALIAS(__read, read);
TCS_ALIAS(__sched_getparam, sched_getparam);
TCS_ALIAS(__sched_getscheduler, sched_getscheduler);
TCS_ALIAS(__sched_setscheduler, sched_setscheduler);
TCS_ALIAS(__sched_yield, sched_yield);
TCS_ALIAS(__send, send);
TCS_ALIAS(__sigaction, sigaction);
TCS_ALIAS(__sigsuspend, sigsuspend);
TCS_ALIAS(__sysconf, sysconf);
TCS_ALIAS(__sysv_signal, sysv_signal);
TCS_ALIAS(__vfork, vfork);
TCS_ALIAS(__wait, wait);
TCS_ALIAS(__waitpid, waitpid);
TCS_ALIAS(__write, write);
TCS_ALIAS(bsd_signal, signal);
TCS_ALIAS(gsignal, raise);
TCS_ALIAS(pthread_yield, sched_yield);
TCS_ALIAS(ssignal, signal);
TCS_ALIAS(thrd_yield, sched_yield);
